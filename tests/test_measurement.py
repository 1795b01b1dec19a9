"""Truth here: integrals over the host's frequency responses, the stepper's own records, and what was asked for."""

from __future__ import annotations

from typing import Any

import control as ct
import numpy as np
import pytest

import hsictrl as hsi

SENSORS = [12.5, 25.0, 37.5]
OCCUPIED = hsi.couple(hsi.reference_bridge(damping=0.02), hsi.Pedestrian(), [20.0, 30.0], force_at=[10.0, 25.0])
WALKER = hsi.Walker(force=hsi.HarmonicForce([0.43]), step_frequency=2.0, speed=1.25)
CROWD = hsi.moving_crowd(hsi.reference_bridge(), hsi.Traffic([WALKER]))


def rng(seed: int = 1) -> np.random.Generator:
    return np.random.default_rng(seed)


# people who stand

@pytest.mark.parametrize("duration", [1.0, 200.0])
def test_ambient_vibration_has_the_variance_of_its_spectrum_from_the_first_sample_on(duration: float) -> None:
    """σ² = Σ ∫ |H|² 2F²/f_s df up to half the sampling frequency, H by the host from state space: no start-up.

    From rest the first second would hold a fifth of it.
    """
    frequency = np.linspace(0.0, 10.0, 100_001)
    system = ct.ss(OCCUPIED.A, OCCUPIED.B, OCCUPIED.C, OCCUPIED.D)
    accelerance = ct.frequency_response(system, 2 * np.pi * frequency).frdata[0]
    exact = np.trapezoid(np.sum(np.abs(accelerance)**2, axis=0) * 2 * 50.0**2 / 20.0, frequency)
    records = [hsi.virtual_measurement(OCCUPIED, duration=duration, sampling_frequency=20.0, force=50.0, noise=0.0,
                                       rng=rng(seed)).outputs for seed in range(150 if duration == 1 else 12)]
    assert np.mean(np.square(records)) == pytest.approx(exact, rel=0.25 if duration == 1 else 0.12)


def test_forces_at_different_places_know_nothing_of_each_other() -> None:
    """The cross-spectrum of two sensors is Σ H_a H̄_b over the forces, not (Σ H_a)(Σ H̄_b)."""
    bridge = hsi.Footbridge.simply_supported(length=50.0, width=3.0, mass=50e3, frequency=2.0, damping=0.05, n_modes=2)
    both = hsi.couple(bridge, force_at=[12.5, 37.5], sense_at=[25.0, 12.5])     # modes 1 and 2, alone and together
    records = [hsi.virtual_measurement(both, duration=300.0, noise=0.0, rng=rng(seed)).outputs for seed in range(10)]
    symmetric, quarter = np.concatenate(records, axis=1)
    second = quarter - np.sqrt(0.5) * symmetric
    assert abs(np.corrcoef(symmetric, second)[0, 1]) < 0.05


def test_sensors_add_noise_of_the_size_that_is_given() -> None:
    record = hsi.virtual_measurement(OCCUPIED, force=1e-6, noise=0.3, sense_at=SENSORS, rng=rng())
    assert record.outputs.std(axis=1) == pytest.approx([0.3] * 3, rel=0.02)
    assert np.abs(np.corrcoef(record.outputs) - np.eye(3)).max() < 0.03


def test_sensors_are_where_they_are_put() -> None:
    """One mode: what is measured is the shape times one signal."""
    record = hsi.virtual_measurement(OCCUPIED, sense_at=SENSORS, noise=0.0, rng=rng())
    middle = hsi.virtual_measurement(OCCUPIED, noise=0.0, rng=rng())
    assert record.outputs == pytest.approx(np.outer(np.sin(np.pi * np.array(SENSORS) / 50), middle.outputs), abs=1e-12)
    assert (record.output_labels, middle.issiso) == (["a[0]", "a[1]", "a[2]"], True)
    assert (len(record.time), record.time[1]) == (30_000, pytest.approx(0.02))


def test_absorbers_of_the_bridge_are_there_once_wherever_sensors_are() -> None:
    damped = hsi.reference_bridge().with_absorbers(hsi.Absorber(mass=500.0, frequency=1.96, damping=0.09), at=[25.0])
    there, elsewhere = (hsi.couple(damped, hsi.Pedestrian(), [20.0], sense_at=[x]) for x in (25.0, 10.0))
    expected = hsi.virtual_measurement(there, duration=20.0, rng=rng()).outputs
    moved = hsi.virtual_measurement(elsewhere, sense_at=[25.0], duration=20.0, rng=rng()).outputs
    assert moved == pytest.approx(expected, abs=1e-15)


def test_the_same_seed_gives_the_same_record() -> None:
    first, again, other = (hsi.virtual_measurement(OCCUPIED, duration=5.0, rng=rng(k)).outputs for k in (1, 1, 2))
    assert np.array_equal(first, again)
    assert not np.array_equal(first, other)


# people who walk

def test_a_walker_is_measured_as_the_stepper_sees_it() -> None:
    record = hsi.virtual_measurement(CROWD, sense_at=SENSORS, noise=0.0, rng=rng())
    exact = hsi.simulate(CROWD, record.time, sense_at=SENSORS).response
    assert np.array_equal(record.outputs, exact.outputs)
    assert (record.time[0], len(record.time)) == (0.0, 2000)        # one crossing of 40 s


def test_noise_comes_on_top_of_walking() -> None:
    quiet, noisy = (hsi.virtual_measurement(CROWD, noise=noise, rng=rng()).outputs for noise in (0.0, 0.2))
    assert np.std(noisy - quiet) == pytest.approx(0.2, rel=0.05)


def test_drawn_traffic_can_be_measured_as_long_as_it_lasts() -> None:
    bridge = hsi.reference_bridge()
    crowd = hsi.moving_crowd(bridge, hsi.CrowdFlow(persons=5).sample(bridge, rng=rng()))
    record = hsi.virtual_measurement(crowd, rng=rng())
    assert record.time[-1] <= crowd.traffic.observed(bridge)[1]
    with pytest.raises(ValueError, match=r"duration must be at most the 37.\d+ s for which this traffic was drawn, got "
                                         r"60; leave it out, or make the traffic by hand"):
        hsi.virtual_measurement(crowd, duration=60.0, rng=rng())


# refusals

@pytest.mark.parametrize(("given", "kind", "says"), [
    ({"rng": 1}, TypeError, r"rng must be of type Generator, got int; give numpy.random.default_rng\(seed\)"),
    ({"system": ct.tf([1], [1, 1])}, TypeError, "system must be of type OccupiedBridge or MovingCrowd, got Transfer"),
    ({"system": CROWD, "force": 10.0}, TypeError, "force must go with people who stand, got 10.0 N with a moving"),
    ({"noise": -1.0}, ValueError, "noise must be at least 0, got -1; give m/s², 0 for none"),
    ({"force": 0.0}, ValueError, "force must be above 0, got 0; give the standard deviation in N"),
    ({"sampling_frequency": 0}, ValueError, "sampling_frequency must be above 0, got 0; give samples a second"),
    ({"duration": 0.0}, ValueError, "duration must be above 0, got 0; give s"),
    ({"duration": 0.02}, ValueError, "duration must hold at least two samples, got 0.02 s at 50 Hz; measure longer"),
    ({"sense_at": [60.0]}, ValueError, "sense_at must lie on the deck"),
    ({"system": hsi.couple(hsi.reference_bridge(damping=0.0))}, ValueError,
     "every mode must have damping for ambient forces to end in a steady state, got 0 %; give the bridge"),
])
def test_refused(given: dict[str, Any], kind: type[Exception], says: str) -> None:
    with pytest.raises(kind, match=says):
        hsi.virtual_measurement(**{"system": OCCUPIED, "rng": rng(), **given})
