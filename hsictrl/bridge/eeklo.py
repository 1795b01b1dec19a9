"""The footbridge in Eeklo, Belgium, on which the paper measured (section 3.4)."""

from __future__ import annotations

from hsictrl.bridge.modal import Footbridge
from hsictrl.bridge.mode import Mode
from hsictrl.bridge.shapes import SineShape
from hsictrl.bridge.torsion import LateralTorsionShape

LENGTH, WIDTH, RATIO = 42.0, 3.0, 0.5


def eeklo_bridge() -> Footbridge:
    """The footbridge in Eeklo, Belgium: a lateral-torsional mode and one of vertical bending (section 3.4).

    Frequencies, damping ratios and modal masses are printed. The rest is not, and assumed: a main span of
    42 m × 3 m, half sines along it, each mode with its modal mass scaled to one at midspan, a lateral-torsional mode
    whose edge moves half as much up and down as the deck moves sideways, and a mass twice the modal mass of bending.

    Returns
    -------
    Footbridge

    Examples
    --------
    >>> print(eeklo_bridge())
    footbridge 42 m × 3 m, 44000 kg
      mode 0: 1.710 Hz, 2.30 %, 34000 kg
      mode 1: 2.990 Hz, 0.20 %, 22000 kg
    """
    sway = LateralTorsionShape(length=LENGTH, width=WIDTH, ratio=RATIO)
    modes = [Mode(frequency=1.71, damping=0.023, modal_mass=34e3, shape=sway),
             Mode(frequency=2.99, damping=0.002, modal_mass=22e3, shape=SineShape(LENGTH))]
    return Footbridge(modes=modes, length=LENGTH, width=WIDTH, mass=44e3)
