"""State-space systems that answer by another road than their matrices."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Self

import control as ct

from hsictrl._checks import Array


class FrozenSystem(ct.StateSpace):
    """A system whose `horner` does not look at its matrices, which therefore can't be changed.

    It is copied and pickled by being made anew, of what it was made of.

    Parameters
    ----------
    made_of : mapping
        Arguments of the constructor of its class, but for the name.
    matrices : (array, array, array, array)
        A, B, C and D.
    name : str
        Name of the system.
    inputs, outputs, states : sequence of str
        Names of its signals.
    """

    def __init__(
        self, made_of: Mapping[str, Any], matrices: tuple[Array, Array, Array, Array], *,
        name: str, inputs: Sequence[str], outputs: Sequence[str], states: Sequence[str],
    ) -> None:
        self._made_of = dict(made_of)
        super().__init__(*matrices, 0, name=name, inputs=inputs, outputs=outputs, states=states)
        for matrix in (self.A, self.B, self.C, self.D):
            matrix.flags.writeable = False

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        make, given = self.__reduce__()
        return make(*given)

    def __reduce__(self) -> tuple[Any, tuple[Any, ...]]:
        names = {"inputs": self.input_labels, "outputs": self.output_labels, "states": self.state_labels}
        return _made_anew, (type(self), {**self._made_of, "name": self.name}, names)

    def _repr_eval_(self) -> str:
        return (f"<{type(self).__name__} {self.name}: {self.input_labels} -> {self.output_labels}, "
                f"{self.nstates} states>")


def _made_anew(kind: type[FrozenSystem], made_of: dict[str, Any], names: dict[str, list[str]]) -> FrozenSystem:
    system = kind(**made_of)
    system.update_names(**names)
    return system
