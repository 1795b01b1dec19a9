"""Truth here: a HiVoSS calculation by hand, and the constants of the guides' own tables and figures."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hsictrl.comfort import (
    comfort_class,
    comfort_verdict,
    design_acceleration,
    en1990_limit,
    equivalent_pedestrians,
    iso10137_limit,
    load_reduction,
)

HAND = {  # HiVoSS by hand: 50 m x 3 m, 2500 kg/m, half-sine shape, TC3
    "frequency": 1.7992, "damping": 0.015, "modal_mass": 62_500.0, "loaded_area": 2 / np.pi * 150.0,
    "density": 0.5, "area": 150.0, "crowd_modal_mass": 2625.0,
}


def test_hand_calculation_of_hivoss() -> None:
    design = design_acceleration(**HAND)
    assert design.equivalent_pedestrians == pytest.approx(0.076368, abs=5e-7)
    assert design.acceleration == pytest.approx(1.0890, abs=5e-5)
    assert (design.reduction, design.frequency, design.modal_mass) == (1.0, 1.7992, 62_500.0)


def test_second_harmonic_of_setra_is_70_newtons() -> None:
    first = design_acceleration(**HAND | {"frequency": 1.9, "guide": "setra"})
    second = design_acceleration(**HAND | {"frequency": 3.8, "guide": "setra"})
    assert second.acceleration / first.acceleration == pytest.approx(70 / 280)


def test_no_walker_reaches_a_stiff_footbridge() -> None:
    assert design_acceleration(**HAND | {"frequency": 6.0}).acceleration == 0.0


def test_guide_reaches_the_load() -> None:
    by_hivoss = design_acceleration(**HAND | {"frequency": 2.4})
    by_setra = design_acceleration(**HAND | {"frequency": 2.4, "guide": "setra"})
    assert (by_hivoss.reduction, by_setra.reduction) == (0.0, pytest.approx(0.4))


def test_crowd_of_five_percent_is_left_out() -> None:
    design = design_acceleration(**HAND | {"crowd_modal_mass": 3125.0})
    assert (design.frequency, design.modal_mass) == (1.7992, 62_500.0)


def test_crowd_above_five_percent_counts() -> None:
    design = design_acceleration(**HAND | {"crowd_modal_mass": 3125.1})
    assert design.modal_mass == 65_625.1
    assert design.frequency == pytest.approx(1.7992 * math.sqrt(62_500 / 65_625.1), rel=1e-14)


def test_crowd_changes_the_load_through_the_lower_frequency() -> None:
    design = design_acceleration(**HAND | {"frequency": 2.2, "crowd_modal_mass": 6250.0})
    lowered = 2.2 / math.sqrt(1.1)
    assert design.reduction == pytest.approx(min(1.0, (2.3 - lowered) / 0.2))
    by_hand = 280 * design.reduction * 0.0763675 * 300 / np.pi / (0.03 * 68_750)
    assert design.acceleration == pytest.approx(by_hand, rel=1e-5)


@pytest.mark.parametrize(
    ("density", "expected"),
    [(0.5, 10.8 * math.sqrt(0.02 * 50) / 100), (0.999, 10.8 * math.sqrt(0.02 * 99.9) / 100),
     (1.0, 1.85 * 10 / 100), (1.5, 1.85 * math.sqrt(150) / 100)],
)
def test_equivalent_pedestrians_of_sparse_and_dense_streams(density: float, expected: float) -> None:
    assert equivalent_pedestrians(density, area=100.0, damping=0.02) == pytest.approx(expected, rel=1e-14)


TRAPEZOIDS = [
    ("hivoss", "vertical", 1, (1.25, 1.7, 2.1, 2.3), 1.0),
    ("hivoss", "vertical", 2, (2.5, 3.4, 4.2, 4.6), 0.25),
    ("hivoss", "lateral", 1, (0.5, 0.7, 1.0, 1.2), 1.0),
    ("setra", "vertical", 1, (1.0, 1.7, 2.1, 2.6), 1.0),
    ("setra", "vertical", 2, (2.6, 3.4, 4.2, 5.0), 0.25),
]


@pytest.mark.parametrize(("guide", "direction", "harmonic", "corners", "top"), TRAPEZOIDS)
def test_load_reduction_at_and_beside_every_corner(
    guide: str, direction: str, harmonic: int, corners: tuple[float, ...], top: float,
) -> None:
    def psi(frequency: float) -> float:
        return load_reduction(frequency, guide, harmonic=harmonic, direction=direction)

    a, b, c, d = corners
    assert [psi(f) for f in (a - 0.1, *corners, d + 0.1)] == [0, 0, top, top, 0, 0]
    assert [psi((a + b) / 2), psi((b + c) / 2), psi((c + d) / 2)] == pytest.approx([top / 2, top, top / 2])


@pytest.mark.parametrize("guide", ["hivoss", "setra"])
@pytest.mark.parametrize("harmonic", [1, 2])
@given(frequency=st.floats(0.5, 6.0))
def test_load_reduction_is_continuous(guide: str, harmonic: int, frequency: float) -> None:
    near = load_reduction(frequency + 1e-6, guide, harmonic=harmonic)
    assert near == pytest.approx(load_reduction(frequency, guide, harmonic=harmonic), abs=1e-5)


@pytest.mark.parametrize(
    ("direction", "acceleration", "expected"),
    [("vertical", a, c) for a, c in [(0, "CL1"), (0.499, "CL1"), (0.5, "CL2"), (0.999, "CL2"), (1.0, "CL3"),
                                     (2.5, "CL3"), (2.501, "CL4")]]
    + [("lateral", a, c) for a, c in [(0, "CL1"), (0.099, "CL1"), (0.1, "CL2"), (0.299, "CL2"), (0.3, "CL3"),
                                      (0.8, "CL3"), (0.801, "CL4")]],
)
def test_comfort_class_at_every_bound(direction: str, acceleration: float, expected: str) -> None:
    assert comfort_class(acceleration, direction) == expected


@pytest.mark.parametrize(("goal", "interval", "expected"), [
    ("CL1", (0.3, 0.49), "met"), ("CL1", (0.49, 0.5), "undecided"), ("CL1", (0.5, 0.6), "not met"),
    ("CL2", (0.3, 0.999), "met"), ("CL2", (0.999, 1.0), "undecided"), ("CL2", (1.0, 3.0), "not met"),
    ("CL3", (0.3, 2.5), "met"), ("CL3", (2.5, 2.501), "undecided"), ("CL3", (2.501, 3.0), "not met"),
    ("CL3", (math.nan, 0.1), "undecided"), ("CL3", (3.0, math.nan), "undecided"),
])
def test_verdict_on_both_sides_of_every_bound(goal: str, interval: tuple[float, float], expected: str) -> None:
    assert comfort_verdict(interval, goal) == expected


def test_verdict_of_a_lateral_acceleration() -> None:
    assert [comfort_verdict((0.05, end), "CL1", "lateral") for end in (0.09, 0.11)] == ["met", "undecided"]


def test_lateral_load_of_hivoss_is_35_newtons() -> None:
    """Half of the trapezoid at 0.6 Hz."""
    design = design_acceleration(**HAND | {"frequency": 0.6, "direction": "lateral"})
    assert design.acceleration == pytest.approx(1.0890 * 35 / 280 / 2, rel=5e-5)
    assert (design.reduction, design.comfort_class) == (pytest.approx(0.5), "CL1")
    assert design_acceleration(**HAND | {"frequency": 0.7, "direction": "lateral"}).comfort_class == "CL2"


def test_limits_of_en1990() -> None:
    limits = [en1990_limit(), en1990_limit("lateral"), en1990_limit("lateral", crowd="exceptional")]
    assert limits == [0.7, 0.2, 0.4]
    assert en1990_limit("vertical", crowd="exceptional") == 0.7


@pytest.mark.parametrize(("frequency", "base"), [(1, 0.010), (2, 0.0070711), (4, 0.005), (8, 0.005)])
def test_iso10137_is_its_base_curve_times_the_multiplier(frequency: float, base: float) -> None:
    assert iso10137_limit(frequency) == pytest.approx(60 * base, rel=1e-5)
    assert iso10137_limit(frequency, multiplier=30) == pytest.approx(30 * base, rel=1e-5)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: comfort_class(-0.1), r"acceleration must be at least 0, got -0.1; .*absolute value"),
        (lambda: comfort_class(float("nan")), r"acceleration must be at least 0, got nan"),
        (lambda: comfort_class(0.1, "sideways"), r"direction must be one of .*got 'sideways'; choose"),
        (lambda: comfort_verdict((0.1, 0.2), "CL4"), r"goal must be one of 'CL1', 'CL2', 'CL3', got 'CL4'; choose"),
        (lambda: comfort_verdict((0.1, 0.2, 0.3), "CL1"), r"interval must hold two ends, got shape \(3,\); give"),
        (lambda: comfort_verdict((-0.1, 0.2), "CL1"), r"acceleration must be at least 0, got -0.1"),
        (lambda: design_acceleration(**HAND | {"guide": "setra", "direction": "lateral"}),
         r"direction must be one whose load setra gives, got 'lateral'; choose another guide"),
        (lambda: en1990_limit("lateral", crowd="jumping"), r"crowd must be one of 'normal', 'exceptional'"),
        (lambda: en1990_limit("longitudinal"), r"direction must be one of .*got 'longitudinal'"),
        (lambda: iso10137_limit(0.9), r"frequency must lie in \[1, 8\], got 0.9; .*standard's own curve"),
        (lambda: iso10137_limit(8.1), r"frequency must lie in \[1, 8\], got 8.1"),
        (lambda: iso10137_limit(2.0, multiplier=0), r"multiplier must be above 0, got 0; 60 is usual"),
        (lambda: load_reduction(2.0, "iso"), r"guide must be one of 'hivoss', 'setra', got 'iso'"),
        (lambda: load_reduction(2.0, harmonic=3), r"harmonic must be 1 or 2 for the vertical load of hivoss, got 3;"),
        (lambda: load_reduction(1.0, harmonic=2, direction="lateral"),
         r"harmonic must be 1 for the lateral load of hivoss, got 2; give one that the guide has"),
        (lambda: load_reduction(1.0, "setra", direction="lateral"),
         r"direction must be one whose load setra gives, got 'lateral'; choose another guide"),
        (lambda: load_reduction(0.0), r"frequency must be above 0, got 0"),
        (lambda: equivalent_pedestrians(0, area=150, damping=0.01), r"density must lie in \(0, 1.5\], got"),
        (lambda: equivalent_pedestrians(2, area=150, damping=0.01), r"got 2; beyond 1.5 persons/m² walking"),
        (lambda: equivalent_pedestrians(1, area=0, damping=0.01), r"area must be above 0, got 0"),
        (lambda: design_acceleration(**HAND | {"damping": 1.5}), r"damping must .*got 1.5; .*not percent"),
        (lambda: design_acceleration(**HAND | {"modal_mass": 0}), r"modal_mass must be above 0, got 0"),
        (lambda: design_acceleration(**HAND | {"crowd_modal_mass": -1}), r"crowd_modal_mass must be at"),
        (lambda: design_acceleration(**HAND | {"loaded_area": 0}), r"loaded_area must be above 0, got 0"),
    ],
)
def test_refusals_say_rule_value_and_remedy(call, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        call()
