"""Bodies of many people, as arrays."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, final

import control as ct
import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl._names import labels
from hsictrl.pedestrian.body import RULES, Body, Pedestrian, SprungBody, block_matrices, checked_ports

if TYPE_CHECKING:
    from hsictrl.pedestrian.reduced import ModalBridge, ReducedCrowd


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Crowd(SprungBody):
    """Bodies of n people as arrays. Crowds add up: ``people + others``.

    Parameters
    ----------
    mass, frequency, damping, sprung_ratio : array_like, shape (n,)
        As in `Pedestrian`, one value per body; a scalar serves all [kg, Hz, -, -].
    direction : str or array_like of str, shape (n,)
        Direction in which each body moves, "vertical" or "lateral".

    Examples
    --------
    >>> people = Crowd(mass=[70.0, 80.0], frequency=3.25, damping=0.3)
    >>> len(people), people[1].mass, float(people.mass.sum())
    (2, 80.0, 150.0)
    """

    mass: Array
    frequency: Array
    damping: Array
    sprung_ratio: Array = 0.95  # type: ignore[assignment]
    direction: NDArray[np.str_] = "vertical"  # type: ignore[assignment]

    def __post_init__(self) -> None:
        values: list[NDArray[Any]] = [check.numbers(name, getattr(self, name), **rule) for name, rule in RULES.items()]
        values.append(check.directions(self.direction))
        check.store(self, **dict(zip(self.__slots__, _same_length(values), strict=True)))

    @classmethod
    def of(cls, bodies: Sequence[Body]) -> Crowd:
        """Gather single bodies.

        Parameters
        ----------
        bodies : sequence of Pedestrian or Absorber
            The bodies, in order.

        Returns
        -------
        Crowd

        Examples
        --------
        >>> len(Crowd.of([Pedestrian(), Pedestrian(mass=80.0)]))
        2
        """
        remedy = "give a sequence of Pedestrian or Absorber"
        for body in check.instance("bodies", bodies, Sequence, remedy):
            check.instance("bodies", body, Body, remedy)
        values: dict[str, Any] = {name: [getattr(body, name) for body in bodies] for name in cls.__slots__}
        return cls(**values)

    def __len__(self) -> int:
        return len(self.mass)

    def __getitem__(self, index: int) -> Pedestrian:
        if not isinstance(index, int | np.integer):
            raise TypeError(f"index must be a whole number, got {index!r}; take several bodies with part()")
        one = {name: getattr(self, name)[index].item() for name in self.__slots__}
        return Pedestrian(**one)

    def __iter__(self) -> Iterator[Pedestrian]:
        return (self[i] for i in range(len(self)))

    def __add__(self, others: Crowd) -> Crowd:
        """These bodies and then the others."""
        if not isinstance(others, Crowd):
            return NotImplemented
        return Crowd(**{name: np.concatenate([getattr(self, name), getattr(others, name)]) for name in self.__slots__})

    def __str__(self) -> str:
        if not len(self):
            return "nobody"
        low, high = self.frequency.min(), self.frequency.max()
        return (f"{len(self)} bodies, {self.mass.sum():.0f} kg, {low:.2f}–{high:.2f} Hz, "
                f"{100 * self.damping.min():.0f}–{100 * self.damping.max():.0f} %")

    def part(self, which: Any) -> Crowd:
        """Some of the bodies.

        Parameters
        ----------
        which : slice, index array or mask
            What numpy takes to choose from an array of n.

        Returns
        -------
        Crowd

        Examples
        --------
        >>> len(Crowd(mass=[70.0] * 5, frequency=3.25, damping=0.3).part(slice(2)))
        2
        """
        return Crowd(**{name: getattr(self, name)[which] for name in self.__slots__})

    def reduced(self, *, order: int, bridge: ModalBridge, positions: Any) -> ReducedCrowd:
        """A few bodies that the modes of a bridge feel as they feel all of these.

        Bodies that move alike are merged, which is exact. If too many are left, bodies in some of their
        places are fitted to the apparent mass of all, from a third of the lowest frequency to twice the
        highest. On a single mode the static and the unsprung apparent mass are kept exactly, and order 2 is
        the equivalent single oscillator of two-degree-of-freedom models (Sachse, Pavic & Reynolds, 2004)
        with a fitted frequency and damping.

        Parameters
        ----------
        order : int
            Number of states at most, two for each body; for n_m modes at least n_m(n_m + 1) [-].
        bridge : Footbridge
            The bridge, for its mode shapes and lowest damping ratio; its natural frequencies do not matter.
        positions : array_like, shape (n,) or (n, 2)
            Where the bodies stand on its deck [m].

        Returns
        -------
        ReducedCrowd
            With `people` and `positions` for `couple`, and a `bound` on the error.

        Raises
        ------
        ValueError
            If the order is odd, too low or too high, or a body has no damping.

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> from hsictrl.pedestrian import Population
        >>> rng, bridge = np.random.default_rng(1), reference_bridge(frequency=2.0, damping=0.005)
        >>> people, places = Population.walking().sample(225, rng), rng.uniform(0, 50, 225)
        >>> small = people.reduced(order=8, bridge=bridge, positions=places)
        >>> len(small.people), small.positions.shape
        (4, (4, 2))
        """
        from hsictrl.pedestrian.reduced import reduced  # only now: it is made of crowds

        return reduced(self, order, bridge, positions)

    def ss(self, *, ports: Sequence[str] = ("y", "v", "a"), name: str = "crowd") -> ct.StateSpace:
        """Give all bodies as one block: motion of the deck under each in, force on the deck there out (eq. 4).

        Signals are ordered as those of `Footbridge.ss`, so that the loop closes with
        ``control.feedback(bridge.ss(at=positions), people.ss(), sign=+1)``. Every body moves in its own
        direction: only those of one direction belong to one deck.

        Parameters
        ----------
        ports : ("y", "v", "a") or ("y", "v")
            As in `Pedestrian.ss`; bodies without unsprung mass need no acceleration.
        name : str
            Name of the block.

        Returns
        -------
        control.StateSpace
            Inputs y[0], v[0], a[0], y[1], … [m, m/s, m/s²]; outputs F[0], F[1], … [N]; states u[0], du[0],
            u[1], … of the sprung masses [m, m/s].

        Examples
        --------
        >>> block = Crowd(mass=[70.0, 80.0], frequency=3.25, damping=0.3).ss()
        >>> block.input_labels, block.output_labels
        (['y[0]', 'v[0]', 'a[0]', 'y[1]', 'v[1]', 'a[1]'], ['F[0]', 'F[1]'])
        """
        columns = checked_ports(ports, self.unsprung_mass)
        if not len(self):
            raise ValueError("a block must hold at least one body, got none; leave an empty crowd out of the loop")
        A, B, C, D = zip(*map(block_matrices, self), strict=True)
        return ct.ss(block_diag(*A), block_diag(*(b[:, :columns] for b in B)), block_diag(*C),
                     block_diag(*(d[:, :columns] for d in D)), inputs=labels(list(ports), len(self)),
                     outputs=labels(["F"], len(self)), states=labels(["u", "du"], len(self)), name=name)


def _same_length(values: Sequence[Any]) -> tuple[NDArray[Any], ...]:
    try:
        arrays = np.broadcast_arrays(*map(np.atleast_1d, values))
    except ValueError:
        shapes = ", ".join(str(np.shape(v)) for v in values)
        raise ValueError("mass, frequency, damping, sprung_ratio and direction must have the same length, "
                         f"got shapes {shapes}; give one value per body, or a scalar for all") from None
    if arrays[0].ndim != 1:
        raise ValueError(f"a crowd must be one row of bodies, got shape {arrays[0].shape}; give arrays of shape (n,)")
    for array in arrays:
        array.flags.writeable = False
    return arrays
