"""Where the crowd helps, and where it amplifies."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.coupling import OccupiedBridge
from hsictrl.loop.gain import REMEDY, LoopGain
from hsictrl.loop.sensitivity import Sensitivity


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class AmplifiedBands:
    """Bands in which the crowd amplifies a mode's response, and in which it reduces it.

    Parameters
    ----------
    amplified : array, shape (k, 2)
        Ends of the bands with a sensitivity above one [Hz].
    reduced : array, shape (l, 2)
        Ends of the bands with a sensitivity below one [Hz].
    largest : float
        Largest sensitivity ``|S_jj|`` [-].
    largest_at : float
        Frequency of the largest sensitivity [Hz].

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.coupling import couple
    >>> from hsictrl.pedestrian import Pedestrian
    >>> x = (np.arange(15) + 0.5) * 50 / 15
    >>> print(amplified_bands(couple(reference_bridge(frequency=2.0), Pedestrian(), x), band=(1.0, 4.0)))
    the crowd amplifies at 1–1.983 Hz, up to 2.28 times at 1.964 Hz, and reduces at 1.983–4 Hz
    """

    amplified: Array
    reduced: Array
    largest: float
    largest_at: float

    def __post_init__(self) -> None:
        check.freeze(self.amplified, self.reduced)

    def __str__(self) -> str:
        does = []
        if len(self.amplified):
            does = [f"amplifies at {_told(self.amplified)}, up to {self.largest:.3g} times at {self.largest_at:.4g} Hz"]
        if len(self.reduced):
            does.append(f"reduces at {_told(self.reduced)}")
        return f"the crowd {', and '.join(does) or 'changes nothing'}"


def _told(bands: Array) -> str:
    return ", ".join(f"{low:.4g}–{high:.4g} Hz" for low, high in bands)


def amplified_bands(
    occupied: OccupiedBridge, *, mode: int = 0, band: tuple[float, float] | None = None,
) -> AmplifiedBands:
    """Bands in which the crowd amplifies the response on a mode's own coordinate, and in which it reduces it.

    The sign of ``|S_jj| − 1`` is read on a grid, and its zeros are refined. Every crowd does both: over periods
    the two areas are equal, ``∫ ln|S| dω/ω² = 0``, since at low frequencies a crowd is nothing but mass.
    Absorbers of the bridge count as bodies of the crowd.

    Parameters
    ----------
    occupied : OccupiedBridge
        The bridge with its crowd.
    mode : int
        Which mode of the bridge, from 0 [-].
    band : (float, float), optional
        Where to look; from a tenth of the lowest frequency of bridge and bodies to ten times the highest if
        not given [Hz].

    Returns
    -------
    AmplifiedBands

    Raises
    ------
    ValueError
        If the bridge has no such mode, or the band is empty.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.coupling import couple
    >>> from hsictrl.pedestrian import Pedestrian
    >>> rigid = Pedestrian(sprung_ratio=1e-9)                # all mass: ω_B/√(1 + μ/2), μ = 70/25000
    >>> bands = amplified_bands(couple(reference_bridge(frequency=2.0), rigid, [25.0]))
    >>> print(bands.amplified[-1, 1].round(6), round(2 / (1 + 70 / 50e3)**0.5, 6))
    1.998601 1.998601
    """
    check.instance("occupied", occupied, OccupiedBridge, REMEDY)
    occupied.bridge.mode(mode)
    left = Sensitivity(LoopGain(occupied))

    def excess(omega: Any) -> Any:
        return np.abs(left.horner(1j * np.atleast_1d(omega), warn_infinite=False)[mode, mode]) - 1

    grid = 2 * np.pi * left.gain.frequencies(band)
    above = excess(grid)
    turns = np.flatnonzero((above[:-1] > 0) != (above[1:] > 0))
    edges = [brentq(lambda omega: float(excess(omega)[0]), *grid[i:i + 2], xtol=1e-14 * grid[i]) for i in turns]
    ends = np.array([grid[0], *edges, grid[-1]]) / (2 * np.pi)
    bands = np.column_stack([ends[:-1], ends[1:]])
    within = excess(2 * np.pi * bands.mean(axis=1))
    rises = above[1:] > above[:-1]
    tops = np.flatnonzero(np.append(True, rises) & np.append(~rises, True))
    top, at = max(_largest(excess, grid, i) for i in tops)      # between grid points another one may be higher
    return AmplifiedBands(amplified=bands[within > 0], reduced=bands[within < 0], largest=top, largest_at=at)


def _largest(excess: Any, grid: Array, top: Any) -> tuple[float, float]:
    """Largest sensitivity about a grid point, and its frequency [Hz]; 1/|S| is smooth where |S| peaks."""
    ends = grid[max(top - 1, 0)], grid[min(top + 1, len(grid) - 1)]
    found = minimize_scalar(lambda omega: 1 / (1 + excess(omega)[0]), bounds=ends, method="bounded",
                            options={"xatol": 1e-10 * grid[top]})
    omega = max(float(found.x), grid[top], key=lambda one: float(excess(one)[0]))
    return 1 + float(excess(omega)[0]), omega / (2 * np.pi)
