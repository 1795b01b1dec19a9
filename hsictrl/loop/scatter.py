"""How the pole of a mode scatters over the crowds that may stand on the bridge."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.bridge import Footbridge
from hsictrl.crowd import CrowdFlow
from hsictrl.loop.bare import bare
from hsictrl.loop.determinant import determinant
from hsictrl.loop.merged import own_poles
from hsictrl.pedestrian import Crowd

Complex = NDArray[np.complex128]
STEPS = 32              # of the bodies' masses, from nothing to all
ROUNDS = 40
SETTLED = 1e-12


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PoleScatter:
    """Poles of one mode, each under a crowd of its own.

    Parameters
    ----------
    poles : array, shape (trials,)
        Upper poles of the occupied bridge [rad/s].
    empty : complex
        Upper pole of the empty bridge [rad/s].
    persons : int
        Number of people in each crowd [-].

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> found = pole_scatter(reference_bridge(frequency=2.0), CrowdFlow(persons=15), rng=np.random.default_rng(1))
    >>> print(found)
    1000 crowds of 15: 1.971 Hz (1.960–1.981), 0.75 % (0.65–0.88), 2.5 % to 97.5 % in brackets
    """

    poles: Complex
    empty: complex
    persons: int

    def __post_init__(self) -> None:
        check.freeze(self.poles)

    def __str__(self) -> str:
        hertz, percent = (np.quantile(one, [0.5, 0.025, 0.975]) for one in (self.frequency, 100 * self.damping))
        return (f"{len(self.poles)} crowds of {self.persons}: {hertz[0]:.3f} Hz ({hertz[1]:.3f}–{hertz[2]:.3f}), "
                f"{percent[0]:.2f} % ({percent[1]:.2f}–{percent[2]:.2f}), 2.5 % to 97.5 % in brackets")

    @property
    def frequency(self) -> Array:
        """Natural frequencies ``|p|/2π`` [Hz]."""
        return np.abs(self.poles) / (2 * np.pi)

    @property
    def damping(self) -> Array:
        """Damping ratios ``−Re p/|p|`` [-]."""
        return -self.poles.real / np.abs(self.poles)

    @property
    def mean(self) -> complex:
        """Mean of the poles [rad/s]."""
        return complex(np.mean(self.poles))

    def region(self, share: float = 0.95) -> Complex:
        """Outline of the ellipse about the mean, of the poles' own covariance, that holds a share of them.

        Parameters
        ----------
        share : float
            Share of the poles inside, in (0, 1) [-].

        Returns
        -------
        array, shape (181,)
            Points of the outline, closed [rad/s].

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> found = pole_scatter(reference_bridge(), CrowdFlow(persons=15), trials=100, rng=np.random.default_rng(1))
        >>> found.region().shape
        (181,)
        """
        share = check.number("share", share, above=0, below=1, remedy=check.PERCENT)
        away = self.poles - self.mean
        points = np.stack([away.real, away.imag])
        sizes, axes = np.linalg.eigh(np.atleast_2d(np.cov(points)))
        root = axes * np.sqrt(np.maximum(sizes, 0))
        radius = np.quantile(np.linalg.norm(np.linalg.pinv(root) @ points, axis=0), share)
        angle = np.linspace(0, 2 * np.pi, 181)
        outline = radius * root @ np.stack([np.cos(angle), np.sin(angle)])
        return np.asarray(self.mean + outline[0] + 1j * outline[1])


def pole_scatter(
    bridge: Footbridge, flow: CrowdFlow, *, mode: int = 0, trials: int = 1000, rng: np.random.Generator,
) -> PoleScatter:
    """Pole of a mode under many crowds, drawn from a population and placed anywhere on the deck.

    Each pole is followed from that of the empty bridge while the bodies' masses grow from nothing, for all crowds
    at once. Where bodies are tuned to the bridge, the pole that begins as the bridge's may end as the bodies'.

    Parameters
    ----------
    bridge : Footbridge
        The empty bridge.
    flow : CrowdFlow
        Number or density of people, and the population from which their bodies come; see `CrowdFlow.crowd`.
    mode : int
        Which mode of the bridge, from 0 [-].
    trials : int
        Number of crowds [-].
    rng : numpy.random.Generator
        Source of randomness; it spawns one stream per crowd.

    Returns
    -------
    PoleScatter

    Raises
    ------
    ValueError
        If the bridge has absorbers, or no such mode.

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> found = pole_scatter(reference_bridge(), CrowdFlow(density=0.5), trials=200, rng=np.random.default_rng(1))
    >>> print(found.mean.real < found.empty.real)           # every crowd damps
    True
    """
    bare(bridge, "take poles from couple(bridge, *flow.crowd(bridge, rng))")
    check.instance("flow", flow, CrowdFlow, "use CrowdFlow(persons=...) or CrowdFlow(density=...)")
    check.instance("rng", rng, np.random.Generator, "give numpy.random.default_rng(seed)")
    check.whole("trials", trials, least=2, remedy="give the number of crowds to draw")
    own = bridge.mode(mode)
    start = complex(own_poles(own.omega, own.damping)[0])
    drawn = [flow.crowd(bridge, child) for child in rng.spawn(trials)]
    poles = _followed(bridge, [people for people, _ in drawn], [places for _, places in drawn], start)
    return PoleScatter(poles=poles, empty=start, persons=len(drawn[0][0]))


def _followed(bridge: Footbridge, people: list[Crowd], places: list[Array], start: complex) -> Complex:
    """The zero of det D(s) of each crowd that the bridge's pole becomes, by Newton's method on the way."""
    felt = _Felt(bridge, people, places)
    before = poles = np.full(len(people), start)
    for share in np.arange(1, STEPS + 1) / STEPS:
        before, poles = poles, 2 * poles - before
        for _ in range(2):
            poles = poles - felt.step(poles, share)
    for _ in range(ROUNDS):
        step = felt.step(poles, 1.0)
        poles = poles - step
        if np.all(np.abs(step) <= SETTLED * np.abs(poles)):
            return poles
    raise ArithmeticError(f"the poles of {len(people)} crowds must settle in {ROUNDS} rounds, got steps of up to "
                          f"{np.abs(step).max():.1e} rad/s; draw lighter bodies, or take poles from couple(...)")


class _Felt:
    """Many crowds as the modes of one bridge feel them; arrays of shape (trials, n)."""

    def __init__(self, bridge: Footbridge, people: list[Crowd], places: list[Array]) -> None:
        self.square, self.viscous = np.diag(bridge.omega**2), np.diag(2 * bridge.damping * bridge.omega)
        rows = np.array([bridge.participation(where, who.direction) for who, where in zip(people, places, strict=True)])
        self.pairs = (rows[..., :, None] * rows[..., None, :]).reshape(*rows.shape[:2], -1)
        self.unsprung, self.sprung, omega, damping = (np.array([getattr(who, name) for who in people]) for name in (
            "unsprung_mass", "sprung_mass", "omega", "damping"))
        self.spring, self.dashpot = omega**2, 2 * damping * omega

    def step(self, s: Complex, share: float) -> Complex:
        """Newton's step towards a zero of det D(s), with a share of all masses."""
        line = s[:, None] * self.dashpot + self.spring
        denominator = s[:, None]**2 + line
        mass = np.eye(len(self.square)) + share * self._summed(self.unsprung + self.sprung * line / denominator)
        slope = -share * self._summed(self.sprung * s[:, None] * (line + self.spring) / denominator**2)
        z = s[:, None, None]
        stiffness, grown = z**2 * mass + z * self.viscous + self.square, 2 * z * mass + z**2 * slope + self.viscous
        value, growth = determinant(stiffness, grown)
        return np.asarray(value / growth)

    def _summed(self, weights: Complex) -> Complex:
        n_m = len(self.square)
        return np.asarray(weights[:, None] @ self.pairs).reshape(-1, n_m, n_m)
