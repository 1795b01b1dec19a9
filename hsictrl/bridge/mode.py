"""One mode of vibration."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import control as ct
import numpy as np

from hsictrl import _checks as check
from hsictrl.bridge.shapes import Shape


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class Mode:
    """One mode of vibration of the empty bridge.

    Parameters
    ----------
    frequency : float
        Natural frequency f_B [Hz].
    damping : float
        Modal damping ratio ξ_B, in [0, 1) [-].
    modal_mass : float
        Modal mass m_B that belongs to the shape as it is scaled, one at its antinode [kg].
    shape : Shape
        Mode shape [-].

    Examples
    --------
    >>> from hsictrl.bridge.shapes import SineShape
    >>> mode = Mode(frequency=2.0, damping=0.005, modal_mass=25e3, shape=SineShape(50.0))
    >>> print(mode)
    2.000 Hz, 0.50 %, 25000 kg
    """

    frequency: float
    damping: float
    modal_mass: float
    shape: Shape

    def __post_init__(self) -> None:
        check.store(
            self, frequency=check.number("frequency", self.frequency, above=0, remedy="give Hz"),
            damping=check.number("damping", self.damping, least=0, below=1, remedy=check.PERCENT),
            modal_mass=check.number("modal_mass", self.modal_mass, above=0, remedy="give kg"))
        check.instance("shape", self.shape, Shape, "use SineShape, BeamShape or a Shape of your own")

    def __str__(self) -> str:
        return f"{self.frequency:.3f} Hz, {100 * self.damping:.2f} %, {self.modal_mass:.0f} kg"

    @property
    def omega(self) -> float:
        """Natural angular frequency ω_B [rad/s]."""
        return 2 * np.pi * self.frequency

    def ss(self, *, name: str = "mode") -> ct.StateSpace:
        """Give the mode as a block in mass-normalised coordinates (eq. 1).

        Parameters
        ----------
        name : str
            Name of the block.

        Returns
        -------
        control.StateSpace
            Input P, the modal force Φᵀp [N/√kg]; outputs z, dz, ddz [m √kg, and per s, per s²];
            states z and dz.

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> mode = reference_bridge(frequency=2.0).modes[0].ss()
        >>> mode.input_labels, mode.output_labels
        (['P'], ['z', 'dz', 'ddz'])
        """
        omega, gamma = self.omega, 2 * self.damping * self.omega
        return ct.ss([[0, 1], [-omega**2, -gamma]], [[0], [1]], [[1, 0], [0, 1], [-omega**2, -gamma]], [[0], [0], [1]],
                     inputs=["P"], outputs=["z", "dz", "ddz"], states=["z", "dz"], name=name)
