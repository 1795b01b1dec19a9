"""What each model assumes: the paper's Table 1, and the first columns of its Table 2."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class Assumptions:
    """A row of Table 1, with order and type from Table 2.

    Parameters
    ----------
    name : str
        Name of the model.
    fixed_driver : str
        What the forces on rigid ground do: stay or move.
    interaction : str
        What stands for human-structure interaction.
    order : str
        Order n_s of the system, from the numbers of modes n_m and of people n_H.
    time_variant : bool
        Whether the system changes with time.

    Examples
    --------
    >>> print(ASSUMPTIONS["PMC"])
    pseudo moving crowd model: moving forces, stationary human body models; order 2(n_m + n_H), time-invariant
    """

    name: str
    fixed_driver: str
    interaction: str
    order: str
    time_variant: bool

    def __str__(self) -> str:
        kind = "time-variant" if self.time_variant else "time-invariant"
        return f"{self.name}: {self.fixed_driver} forces, {self.interaction}; order {self.order}, {kind}"


ASSUMPTIONS = {
    "SF": Assumptions(name="stationary force model", fixed_driver="stationary", interaction="disregarded",
                      order="2 n_m", time_variant=False),
    "MF": Assumptions(name="moving force model", fixed_driver="moving", interaction="disregarded",
                      order="2 n_m", time_variant=False),
    "MFAM": Assumptions(name="moving force model with added mass", fixed_driver="moving",
                        interaction="uniformly distributed crowd mass", order="2 n_m", time_variant=False),
    "PMC": Assumptions(name="pseudo moving crowd model", fixed_driver="moving",
                       interaction="stationary human body models", order="2(n_m + n_H)", time_variant=False),
    "MC": Assumptions(name="moving crowd model", fixed_driver="moving",
                      interaction="moving human body models", order="2(n_m + n_H)", time_variant=True),
}
