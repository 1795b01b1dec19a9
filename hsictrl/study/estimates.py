"""Estimates over named axes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import final

import numpy as np

from hsictrl import _checks as check
from hsictrl._checks import Array

Value = int | float | str
Axes = dict[str, tuple[Value, ...]]


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Estimates:
    """Estimates and their intervals, an axis per name.

    Parameters
    ----------
    axes : dict
        The values of each axis by its name, in order.
    estimate, low, high : ndarray
        Estimates and ends of their intervals, one dimension per axis [unit of the estimates].

    Examples
    --------
    >>> import numpy as np
    >>> masses = np.array([70.0, 80.0])
    >>> found = Estimates(axes={"mass": (70, 80)}, estimate=masses, low=masses - 1, high=masses + 1)
    >>> float(found.at({"mass": 80}).low)
    79.0
    """

    axes: Axes
    estimate: Array
    low: Array
    high: Array

    def __post_init__(self) -> None:
        check.freeze(self.estimate, self.low, self.high)

    def at(self, point: Mapping[str, Value]) -> Estimates:
        """Pick one value of each of some axes.

        Parameters
        ----------
        point : mapping
            A value, exactly as it stands on the axis, by the name of its axis.

        Returns
        -------
        Estimates
            The same over the other axes [unit of the estimates].

        Examples
        --------
        >>> import numpy as np
        >>> lengths = np.array([20.0, 30.0])
        >>> found = Estimates(axes={"span": ("side", "main")}, estimate=lengths, low=lengths, high=lengths)
        >>> float(found.at({"span": "main"}).estimate)
        30.0
        """
        check.instance("point", point, Mapping, "give a dict of axes and one value of each")
        place: list[int | slice] = [slice(None)] * len(self.axes)
        for name, value in point.items():
            check.choice("axis", name, list(self.axes))
            place[list(self.axes).index(name)] = place_of(self.axes, name, value)
        axes = {name: values for name, values in self.axes.items() if name not in point}
        estimate, low, high = (array[tuple(place)] for array in (self.estimate, self.low, self.high))
        return Estimates(axes=axes, estimate=estimate, low=low, high=high)


def place_of(axes: Axes, name: str, value: Value) -> int:
    """Where a value stands on an axis; refuse one that doesn't."""
    remedy = "give one number or string"
    check.instance(name, value.item() if isinstance(value, np.generic) else value, (int, float, str), remedy)
    if value not in axes[name]:
        values = ", ".join(map(repr, axes[name]))
        raise ValueError(f"{name} must be one of {values}, got {value!r}; choose one of these")
    return axes[name].index(value)
