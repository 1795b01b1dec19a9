"""The load cases of the guides: every mode that walking can meet, by every guide that has a load for it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

from hsictrl._checks import Direction
from hsictrl.bridge import Extent, Footbridge
from hsictrl.comfort import GUIDE_LOADS, DesignResponse, design_acceleration
from hsictrl.crowd import CrowdFlow
from hsictrl.prediction.refusals import check_case

PERSON_MASS = 70.0       # kg, of the guides
LEAST_MOTION = 0.01      # of the antinode's; what moves less in a direction is not met by its load


@final
@dataclass(frozen=True, slots=True, kw_only=True)
class GuideCase:
    """One load case of one guide.

    Parameters
    ----------
    mode : int
        Which mode of the bridge, from 0 [-].
    response : DesignResponse
        The design acceleration and what it was computed from [m/s²].

    Examples
    --------
    >>> from hsictrl.bridge import reference_bridge
    >>> case, _ = guide_cases(reference_bridge(frequency=2.0), CrowdFlow(traffic_class="TC3"))
    >>> case.response.guide, case.response.comfort_class
    ('hivoss', 'CL4')
    """

    mode: int
    response: DesignResponse

    def to_dict(self) -> dict[str, Any]:
        """Export with the units in the keys.

        Returns
        -------
        dict
            Plain numbers and strings, ready for JSON, a CSV row or a data frame.

        Examples
        --------
        >>> from hsictrl.bridge import reference_bridge
        >>> case, _ = guide_cases(reference_bridge(frequency=2.0), CrowdFlow(traffic_class="TC3"))
        >>> case.to_dict()["class"]
        'CL4'
        """
        found = self.response
        return {"mode": self.mode, "direction": found.direction, "guide": found.guide, "frequency_hz": found.frequency,
                "modal_mass_kg": found.modal_mass, "equivalent_pedestrians_per_m2": found.equivalent_pedestrians,
                "reduction": found.reduction, "a_m_per_s2": found.acceleration, "class": found.comfort_class}


def guide_cases(bridge: Footbridge, flow: CrowdFlow) -> tuple[GuideCase, ...]:
    """Load cases of all guides on every critical mode, with the crowd's mass where that counts.

    A mode is critical for a guide if it moves in the direction of a load, by at least a hundredth of its antinode,
    and its frequency lies where that load is not zero.

    Parameters
    ----------
    bridge : Footbridge
        The empty bridge.
    flow : CrowdFlow
        The stream of people.

    Returns
    -------
    tuple of GuideCase
        Mode by mode; HiVoSS vertical and lateral, Sétra vertical.

    Examples
    --------
    >>> bridge = Footbridge.simply_supported(length=50.0, width=3.0, mass=125e3, frequency=1.0, damping=0.015,
    ...                                      n_modes=3)
    >>> for case in guide_cases(bridge, CrowdFlow(traffic_class="TC3")):
    ...     print(case.mode, case.response.guide, case.response.reduction, round(case.response.acceleration, 3))
    1 hivoss 0.25 0.272
    1 setra 0.25 0.272
    """
    check_case(bridge, flow)
    cases = (GuideCase(mode=j, response=guide_value(bridge, flow, guide=guide, mode=j, direction=direction))
             for j in range(bridge.n_modes) for guide, direction in GUIDE_LOADS
             if Extent.of(bridge, j, direction).largest >= LEAST_MOTION)
    return tuple(case for case in cases if case.response.reduction)


def guide_value(
    bridge: Footbridge, flow: CrowdFlow, *, guide: str = "hivoss", mode: int = 0, direction: Direction = "vertical",
) -> DesignResponse:
    """Design acceleration of the guides for one mode and the same density.

    The mode shape, whatever its form, is integrated over the deck, and scaled to one where it moves the most in the
    direction of the load; people's mass moves in all its directions.

    Parameters
    ----------
    bridge : Footbridge
        The empty bridge.
    flow : CrowdFlow
        The stream of people.
    guide : {"hivoss", "setra"}
        Which guide's load.
    mode : int
        Which mode of the bridge, from 0 [-].
    direction : {"vertical", "lateral"}
        Direction of the load; lateral for HiVoSS only.

    Returns
    -------
    DesignResponse

    Raises
    ------
    ValueError
        If the mode does not move in this direction, nothing damps it, or people are too many to walk.

    Examples
    --------
    HiVoSS by hand: 50 m by 3 m, 2500 kg/m, 1.5 %, 0.5 persons/m².

    >>> bridge = Footbridge.simply_supported(length=50.0, width=3.0, mass=125e3, frequency=1.7992, damping=0.015)
    >>> design = guide_value(bridge, CrowdFlow(traffic_class="TC3"))
    >>> round(design.equivalent_pedestrians, 6), round(design.acceleration, 4)
    (0.076368, 1.089)
    >>> from hsictrl.bridge import reference_bridge
    >>> round(guide_value(reference_bridge(frequency=2.0, damping=0.005), CrowdFlow(density=0.5)).acceleration, 3)
    4.268
    """
    check_case(bridge, flow)
    resonant, density, extent = bridge.mode(mode), flow.density_on(bridge), Extent.of(bridge, mode, direction)
    if not extent.largest:
        raise ValueError(f"mode must move in the direction of the load, got mode {mode}, which has no {direction} "
                         "motion; choose the other direction, or another mode")
    scale = extent.largest
    return design_acceleration(
        frequency=resonant.frequency, damping=resonant.damping, modal_mass=resonant.modal_mass / scale**2,
        density=density, area=bridge.area, loaded_area=bridge.area * extent.mean_absolute / scale,
        crowd_modal_mass=PERSON_MASS * density * bridge.area * extent.mean_square / scale**2, guide=guide,
        direction=direction)
