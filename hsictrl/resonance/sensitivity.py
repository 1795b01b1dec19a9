"""How effective properties depend on every body, in closed form."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from hsictrl import _checks as check
from hsictrl._checks import Array
from hsictrl.coupling import OccupiedBridge
from hsictrl.pedestrian import Crowd
from hsictrl.resonance.curves import dynamic_stiffness_slope
from hsictrl.resonance.effective import effective

Complex = NDArray[np.complex128]


@final
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class EffectiveSensitivity:
    """Derivatives of effective frequency and damping with respect to every body's parameters.

    Parameters
    ----------
    frequency : array, shape (n, 4)
        ∂f_eff/∂p, a row per body [Hz per kg, per Hz, per 1, per 1].
    damping : array, shape (n, 4)
        ∂ξ_eff/∂p, a row per body [1 per kg, per Hz, per 1, per 1].

    Attributes
    ----------
    parameters : tuple of str
        Names of the four columns: "mass", "frequency", "damping", "sprung_ratio".

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.coupling import couple
    >>> from hsictrl.pedestrian import Pedestrian
    >>> slopes = effective_sensitivity(couple(reference_bridge(frequency=2.0), Pedestrian(), [25.0]))
    >>> slopes.parameters[0], bool(slopes.frequency[0, 0] < 0)     # heavier bodies lower the frequency
    ('mass', True)
    """

    parameters: ClassVar[tuple[str, ...]] = ("mass", "frequency", "damping", "sprung_ratio")
    frequency: Array
    damping: Array


def effective_sensitivity(occupied: OccupiedBridge, *, mode: int = 0) -> EffectiveSensitivity:
    """Sensitivity of effective frequency and damping (eq. 17) to every parameter of every body.

    With L = ln H on the mode's coordinate, the peak satisfies Re(i L_s) = 0, so that
    ∂ω/∂p = Re(i L_sp)/Re(L_ss), and ∂ξ_eff/∂p = −ξ_eff Re(L_p).

    Parameters
    ----------
    occupied : OccupiedBridge
        The bridge with its crowd.
    mode : int
        Which mode of the bridge, from 0 [-].

    Returns
    -------
    EffectiveSensitivity

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> from hsictrl.coupling import couple
    >>> from hsictrl.pedestrian import Pedestrian
    >>> slopes = effective_sensitivity(couple(reference_bridge(frequency=2.0), Pedestrian(), [20.0, 25.0]))
    >>> slopes.frequency.shape
    (2, 4)
    """
    check.instance("occupied", occupied, OccupiedBridge, "make one with couple(bridge, people, positions)")
    here = effective(occupied, mode=mode)
    first, mixed, curvature = _log_derivatives(occupied, mode, 2j * np.pi * here.frequency)
    frequency = (1j * mixed).real / curvature.real / (2 * np.pi)
    return EffectiveSensitivity(frequency=frequency.T, damping=-here.damping * first.real.T)


def _log_derivatives(occupied: OccupiedBridge, mode: int, s: complex) -> tuple[Complex, Complex, complex]:
    """L_p and L_sp, shape (4, n), and L_ss of L = ln(s²[D⁻¹]_jj), by D's derivatives."""
    rows, people = occupied.condensed.rows, occupied.people
    flexibility = np.linalg.inv(occupied.dynamic_stiffness(s)[0])
    slope, bend = dynamic_stiffness_slope(occupied, s), _dynamic_stiffness_bend(occupied, s)
    x, own = flexibility[:, mode], flexibility[mode, mode]
    moved = -flexibility @ slope @ x                       # dx/ds
    own_s = -x @ slope @ x
    own_ss = -2 * (x @ slope @ moved) - x @ bend @ x
    q, q_s = rows @ x, rows @ moved
    grown, grown_s = _apparent_mass_derivatives(people, s)
    own_p = -s**2 * grown * q**2
    own_ps = -(2 * s * grown + s**2 * grown_s) * q**2 - 2 * s**2 * grown * q * q_s
    first = own_p / own
    return first, own_ps / own - first * own_s / own, -2 / s**2 + own_ss / own - (own_s / own)**2


def _dynamic_stiffness_bend(occupied: OccupiedBridge, s: complex) -> Complex:
    """d²D/ds² of the condensed dynamic stiffness, shape (n_m, n_m) [-]."""
    crowd = occupied.condensed
    mass = np.eye(occupied.bridge.n_modes) + crowd.apparent_mass(s)[0]
    bent = crowd.rows.T * _apparent_mass_bend(crowd.people, s) @ crowd.rows
    return np.asarray(2 * mass + 4 * s * crowd.apparent_mass_slope(s) + s**2 * bent)


def _apparent_mass_bend(people: Crowd, s: complex) -> Complex:
    """d²α/ds² per body, α = m − m₁s²/Δ with Δ = s² + 2ξω s + ω² [kg s²]."""
    delta, delta_s = _denominator(people, s)
    bent = (2 * delta - 2 * s**2) / delta**2 - 2 * (2 * s * delta - s**2 * delta_s) * delta_s / delta**3
    return np.asarray(-people.sprung_mass * bent)


def _apparent_mass_derivatives(people: Crowd, s: complex) -> tuple[Complex, Complex]:
    """∂α/∂p and ∂²α/∂p∂s for mass, frequency [Hz], damping and sprung ratio, each of shape (4, n)."""
    m, m1, mu, omega, xi = people.mass, people.sprung_mass, people.sprung_ratio, people.omega, people.damping
    delta, delta_s = _denominator(people, s)
    ratio, ratio_s = s**2 / delta, (2 * s * delta - s**2 * delta_s) / delta**2
    to_omega = m1 * s**2 * (2 * xi * s + 2 * omega) / delta**2
    to_omega_s = m1 * ((6 * xi * s**2 + 4 * omega * s) * delta
                       - 2 * s**2 * (2 * xi * s + 2 * omega) * delta_s) / delta**3
    to_xi = m1 * 2 * omega * s**3 / delta**2
    to_xi_s = m1 * (6 * omega * s**2 * delta - 4 * omega * s**3 * delta_s) / delta**3
    return (np.array([1 - mu * ratio, 2 * np.pi * to_omega, to_xi, -m * ratio]),
            np.array([-mu * ratio_s, 2 * np.pi * to_omega_s, to_xi_s, -m * ratio_s]))


def _denominator(people: Crowd, s: complex) -> tuple[Any, Any]:
    """Δ = s² + 2ξω s + ω² and dΔ/ds per body."""
    damping = 2 * people.damping * people.omega
    return s**2 + damping * s + people.omega**2, 2 * s + damping
