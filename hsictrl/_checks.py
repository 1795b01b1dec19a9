"""Checks of what comes in: every refusal says the rule, the value and the remedy."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Direction = Literal["vertical", "lateral"]
DIRECTIONS: tuple[Direction, ...] = get_args(Direction)
PERCENT = "give a fraction, not percent"


def number(
    name: str, value: Any, *, above: float | None = None, least: float | None = None,
    below: float | None = None, most: float | None = None, remedy: str,
) -> float:
    """Return `value` as a float that is finite and lies within the bounds; refuse anything else."""
    array = _real(name, value, remedy)
    if array.ndim:
        raise ValueError(f"{name} must be one number, got an array of shape {array.shape}; {remedy}")
    _bound(name, array, above, least, below, most, remedy)
    return float(array)


def numbers(
    name: str, values: Any, *, above: float | None = None, least: float | None = None,
    below: float | None = None, most: float | None = None, remedy: str, ndim: int | None = None, count: int = 0,
) -> Array:
    """Return `values`, at least `count`, as a read-only float array, finite and within the bounds; refuse others."""
    array = _real(name, values, remedy).copy()
    if ndim is not None and array.ndim != ndim:
        raise ValueError(f"{name} must have {ndim} dimension(s), got shape {array.shape}; {remedy}")
    if array.size < count:
        raise ValueError(f"{name} must hold at least {count} number(s), got {array.size}; {remedy}")
    _bound(name, array, above, least, below, most, remedy)
    array.flags.writeable = False
    return array


def laplace(x: Any) -> NDArray[np.complex128]:
    """Return `x` as one row of complex numbers; refuse a table of them."""
    s = np.atleast_1d(np.asarray(x, dtype=complex))
    if s.ndim > 1:
        raise ValueError(f"x must be one number or one row, got shape {s.shape}; ravel it")
    return s


def increasing(name: str, values: Any, *, remedy: str) -> Array:
    """Return `values` as at least two numbers that increase; refuse anything else."""
    array = numbers(name, values, ndim=1, count=2, remedy=remedy)
    falls = np.flatnonzero(np.diff(array) <= 0)
    if falls.size:
        first = falls[0]
        raise ValueError(f"{name} must increase, got {array[first]:g} and then {array[first + 1]:g}; {remedy}")
    return array


def known(name: str, values: Any, *, remedy: str) -> np.ma.MaskedArray:
    """Return `values` as finite numbers, masked where they are nan; refuse anything else."""
    array = _real(name, values, remedy)
    unknown = np.isnan(array)
    return np.ma.array(numbers(name, np.where(unknown, 0.0, array), remedy=remedy), mask=unknown)


def band(values: Any) -> tuple[float, float]:
    """Return `values` as two frequencies above 0 [Hz]; refuse anything else."""
    pair = numbers("band", values, above=0, ndim=1, remedy="give (low, high) in Hz")
    if len(pair) != 2:
        raise ValueError(f"band must hold two frequencies, got {len(pair)}; give (low, high) in Hz")
    return float(pair[0]), float(pair[1])


def even_times(name: str, values: Any) -> Array:
    """Return `values` as at least two times that increase evenly [s]; refuse anything else."""
    times = numbers(name, values, ndim=1, remedy="give an evenly spaced array of seconds")
    if len(times) < 2:
        raise ValueError(f"{name} must hold at least two times, got {len(times)}; give an array")
    steps = np.diff(times)
    if steps[0] <= 0 or np.ptp(steps) > 1e-6 * steps[0]:
        raise ValueError(f"{name} must increase evenly, got steps from {steps.min():g} to {steps.max():g} s; "
                         "use numpy.linspace")
    return times


def whole(name: str, value: Any, *, least: int, remedy: str) -> int:
    """Return `value` as an int of at least `least`; refuse anything else."""
    if isinstance(value, bool) or not isinstance(value, int | np.integer):
        raise TypeError(f"{name} must be a whole number, got {value!r}; {remedy}")
    if value < least:
        raise ValueError(f"{name} must be at least {least}, got {value}; {remedy}")
    return int(value)


def choice(name: str, value: Any, options: Sequence[str]) -> str:
    """Return `value` if it is one of the options; refuse anything else."""
    if value not in options:
        raise ValueError(f"{name} must be one of {', '.join(map(repr, options))}, got {value!r}; choose one of these")
    return str(value)


def instance(name: str, value: Any, kind: type | tuple[type, ...], remedy: str) -> Any:
    """Return `value` if it is an instance of `kind`; refuse anything else."""
    if not isinstance(value, kind):
        kinds = kind if isinstance(kind, tuple) else (kind,)
        names = " or ".join(dict.fromkeys(k.__name__ for k in kinds))    # bool is that of Python and of NumPy
        raise TypeError(f"{name} must be of type {names}, got {type(value).__name__}; {remedy}")
    return value


def entries(name: str, given: Any, what: str, remedy: str) -> Mapping[str, Any]:
    """Return `given` if it is a mapping that holds something; refuse anything else."""
    if not instance(name, given, Mapping, remedy):
        raise ValueError(f"{name} must hold at least one {what}, got none; {remedy}")
    return given


def several(name: str, given: Any) -> tuple[Any, ...]:
    """Return the members of a list or tuple that holds something; refuse anything else."""
    listed = tuple(instance(name, given, (list, tuple), "give a list"))
    if not listed:
        raise ValueError(f"{name} must hold at least one, got none; give a list of some")
    return listed


def store(thing: Any, **values: Any) -> None:
    """Set attributes of a frozen instance, while it is being made."""
    for name, value in values.items():
        object.__setattr__(thing, name, value)


def freeze(*values: Any) -> None:
    """Make arrays read-only; what is no array can't be changed anyway."""
    for value in values:
        if isinstance(value, np.ndarray):
            value.flags.writeable = False


def _real(name: str, value: Any, remedy: str) -> Array:
    try:
        array = np.asarray(value)
        if array.dtype.kind not in "iuf":
            raise TypeError
    except (TypeError, ValueError):
        raise TypeError(f"{name} must be real numbers, got {_short(value)}; {remedy}") from None
    return array.astype(np.float64)


def _bound(
    name: str, array: Array, above: float | None, least: float | None,
    below: float | None, most: float | None, remedy: str,
) -> None:
    wrong = ~np.isfinite(array)
    if above is not None:
        wrong |= array <= above
    if least is not None:
        wrong |= array < least
    if below is not None:
        wrong |= array >= below
    if most is not None:
        wrong |= array > most
    if np.any(wrong):
        first = np.argwhere(wrong)[0]
        place = f"[{', '.join(map(str, first))}]" if array.ndim else ""
        value = array[tuple(first)]
        rule = _rule(above, least, below, most) if not np.isinf(value) else "be finite"
        raise ValueError(f"{name}{place} must {rule}, got {value:g}; {remedy}")


def _rule(above: float | None, least: float | None, below: float | None, most: float | None) -> str:
    low = above if above is not None else least
    high = below if below is not None else most
    if low is not None and high is not None:
        return f"lie in {'(' if above is not None else '['}{low:g}, {high:g}{')' if below is not None else ']'}"
    if low is not None:
        return f"be above {low:g}" if above is not None else f"be at least {low:g}"
    if high is not None:
        return f"be below {high:g}" if below is not None else f"be at most {high:g}"
    return "be finite"


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."


def directions(values: Any) -> NDArray[np.str_]:
    """Return directions of motion, one or many, as an array of str; refuse any that is not known."""
    array = np.array(values, dtype=np.str_)
    for one in np.unique(array):
        choice("direction", str(one), DIRECTIONS)
    return array


def points(name: str, values: Any, *, least: int = 0) -> Array:
    """Return places on a deck as an (n, 2) array of x and y [m]; a plain list of x lies on the centre line."""
    remedy = "give x [m], or pairs (x, y) [m]"
    array = np.atleast_1d(numbers(name, values, remedy=remedy))
    if len(array) < least:
        raise ValueError(f"{name} must hold at least {least} place(s), got {len(array)}; {remedy}")
    if array.ndim == 1:
        array = np.column_stack([array, np.zeros_like(array)])
    if array.ndim != 2 or array.shape[1] != 2:
        raise ValueError(f"{name} must have shape (n,) or (n, 2), got {array.shape}; {remedy}")
    array.flags.writeable = False
    return array


def ports(values: Any) -> tuple[str, ...]:
    """Return the ports of a block, displacement and velocity with or without acceleration; refuse anything else."""
    given = tuple(values) if isinstance(values, Sequence) else values
    if given not in (("y", "v"), ("y", "v", "a")):
        raise ValueError(f"ports must be ('y', 'v', 'a') or ('y', 'v'), got {given!r}; choose one of these")
    return tuple(given)
