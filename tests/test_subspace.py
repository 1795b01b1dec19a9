"""Truth here: autoregressive series of known poles, the least error that any estimator has, and poles of bridges."""

from __future__ import annotations

import json
import logging
import sys
from typing import Any

import control as ct
import numpy as np
import pytest
from scipy.signal import lfilter

import hsictrl as hsi
from hsictrl._checks import Array

RATE, DURATION = 10.0, 600.0
SHAPE = np.array([1.0, 0.5, -0.8])
TIME = np.arange(0.0, DURATION, 1 / RATE)


def vibration(frequency: float, damping: float, rng: np.random.Generator, count: int = len(TIME)) -> Array:
    """An autoregressive series of order two whose pole is exp(λ/RATE), λ = ω(-ξ + i√(1 - ξ²)); unit variance."""
    pole = np.exp(2 * np.pi * frequency / RATE * (-damping + 1j * np.sqrt(1 - damping**2)))
    series = lfilter([1.0], [1.0, -2 * pole.real, abs(pole)**2], rng.standard_normal(count + 5000))[5000:]
    return series / series.std()


def signals(seed: int, *modes: tuple[float, float], shapes: Array = SHAPE[None], noise: float = 0.05) -> Array:
    """Sum of vibrations at three sensors, with noise of a twentieth."""
    rng = np.random.default_rng(seed)
    each = [np.outer(shape, vibration(*mode, rng)) for mode, shape in zip(modes, shapes, strict=True)]
    return sum(each) + noise * rng.standard_normal((3, len(TIME)))


def identified(record: Array, **how: Any) -> hsi.SubspaceIdentification:
    return hsi.subspace_identification(record, timepts=TIME, **{"highest": 3.0, **how})


# one mode

@pytest.mark.parametrize(("frequency", "damping"), [(2.0, 0.005), (1.0, 0.02), (2.7, 0.01)])
def test_errors_are_the_least_that_any_estimator_has(frequency: float, damping: float) -> None:
    """Gersch (1974): (σ_ξ/ξ)² = 1/(2π ξ f T) and σ_f/f = σ_ξ, for a mode under white noise of length T."""
    least = np.sqrt(damping / (2 * np.pi * frequency * DURATION))
    found = [identified(signals(seed, (frequency, damping)), highest=1.2 * frequency).nearest(frequency)
             for seed in range(5)]
    assert 0.8 * least < np.median([one.damping_error for one in found]) < 1.5 * least
    assert 0.8 * least < np.median([one.frequency_error / frequency for one in found]) < 1.5 * least
    misses = np.array([[one.frequency / frequency - 1, one.damping - damping] for one in found])
    assert np.all(np.abs(misses) < 3.3 * least)
    assert np.all(np.abs(misses.mean(axis=0)) < 3.3 * least / np.sqrt(5))


def test_one_mode_is_found_and_nothing_else() -> None:
    for seed in range(5):
        [mode] = identified(signals(seed, (2.0, 0.01))).modes
        np.testing.assert_allclose(mode.shape, SHAPE, atol=0.01)


def test_intervals_are_those_of_student_with_49_degrees_of_freedom() -> None:
    [mode] = identified(signals(0, (2.0, 0.01))).modes
    low, high = mode.damping_interval
    assert (high - mode.damping, mode.damping - low) == pytest.approx([2.00958 * mode.damping_error] * 2, rel=1e-5)
    assert np.ptp(mode.frequency_interval) == pytest.approx(2 * 2.00958 * mode.frequency_error, rel=1e-5)


def test_scale_offset_trend_and_order_of_the_sensors_do_not_matter() -> None:
    record = signals(1, (2.0, 0.01))
    [plain] = identified(record).modes
    [other] = identified(1e-200 * (record + 3.0 + 0.01 * TIME)[::-1]).modes
    assert tuple(other) == pytest.approx(tuple(plain), rel=1e-6)
    np.testing.assert_allclose(other.shape, plain.shape[::-1], atol=1e-6)


def test_a_record_is_decimated_to_the_band_that_is_asked_for() -> None:
    """The band is what is asked for, whatever the sampling frequency: a mode of 4 Hz is left out."""
    record = signals(2, (2.0, 0.01), (4.0, 0.01), shapes=np.array([SHAPE, [1.0, 1.0, 1.0]]))
    both, slow = identified(record, highest=3.3), identified(record, highest=2.5)
    assert len(both.modes) == len(slow.modes) == 1
    assert identified(record, highest=1.6).modes == ()


# several modes, and references

def test_close_modes_are_told_apart() -> None:
    shapes = np.array([[1.0, 1.0, 1.0], [1.0, 0.0, -1.0]])
    slow, fast = identified(signals(3, (2.0, 0.008), (2.1, 0.008), shapes=shapes)).modes
    for one, frequency, shape in ((slow, 2.0, shapes[0]), (fast, 2.1, shapes[1])):
        assert abs(one.frequency - frequency) < 3.3 * one.frequency_error
        assert abs(one.damping - 0.008) < 3.3 * one.damping_error
        likeness = abs(np.vdot(one.shape, shape))**2 / (np.vdot(one.shape, one.shape).real * (shape @ shape))
        assert likeness > 0.9        # 1/3 between both


def test_reference_channels_are_those_that_are_given() -> None:
    record = signals(4, (2.0, 0.01))
    everything = identified(record).nearest(2.0)
    assert tuple(identified(record, references=[0, 1, 2]).nearest(2.0)) == tuple(everything)
    one = identified(record, references=[1]).nearest(2.0)
    assert tuple(one) != tuple(everything)
    assert one.frequency == pytest.approx(2.0, abs=3.3 * one.frequency_error)
    record[2] = np.random.default_rng(5).standard_normal(len(TIME))        # a dead sensor is no reference
    dead = identified(record, references=[0, 1]).nearest(2.0)
    assert dead.damping == pytest.approx(0.01, abs=3.3 * dead.damping_error)
    assert abs(dead.shape[2]) < 0.1


def test_one_sensor_is_enough_for_frequency_and_damping() -> None:
    mode = identified(signals(6, (2.0, 0.01))[0]).nearest(2.0)
    assert mode.frequency == pytest.approx(2.0, abs=3.3 * mode.frequency_error)
    assert mode.shape == pytest.approx([1.0])


# the occupied reference bridge

def test_intervals_hold_the_poles_of_the_occupied_reference_bridge() -> None:
    """The full study of 100 records is docs/subspace_coverage.py."""
    people = hsi.Population.walking().sample(15, np.random.default_rng(0))
    occupied = hsi.couple(hsi.reference_bridge(), people, (np.arange(15) + 0.5) * 50 / 15)
    poles = ct.poles(occupied)
    pole = poles[np.argmin(np.abs(poles - 2j * np.pi * 1.97))]
    frequency, damping = abs(pole) / (2 * np.pi), -pole.real / abs(pole)
    found = []
    for seed in range(6):
        record = hsi.virtual_measurement(occupied, sense_at=[12.5, 25.0, 37.5], rng=np.random.default_rng(seed))
        found.append(hsi.subspace_identification(record, highest=3.0).nearest(2.0))
    for one in found:
        assert one.frequency == pytest.approx(frequency, abs=3.3 * one.frequency_error)
        assert one.damping == pytest.approx(damping, abs=3.3 * one.damping_error)
        np.testing.assert_allclose(one.shape, [np.sqrt(0.5), 1.0, np.sqrt(0.5)], atol=0.02)
    assert np.median([np.ptp(one.frequency_interval) / 2 for one in found]) < 0.005 * frequency
    assert np.median([np.ptp(one.damping_interval) / 2 for one in found]) < 0.35 * damping


# what is given back

def test_it_unpacks_prints_and_goes_into_json() -> None:
    found = identified(signals(0, (2.0, 0.01)))
    [mode] = found.modes
    assert tuple(mode) == (mode.frequency, mode.damping)
    row = json.loads(json.dumps(mode.to_dict()))
    assert row["damping_interval"] == list(mode.damping_interval)
    assert row["shape_real"] == mode.shape.real.tolist()
    assert str(found) == str(mode)
    with pytest.raises(ValueError, match="read-only"):
        mode.shape[0] = 0.0


def test_the_nearest_mode_of_none_is_refused() -> None:
    nothing = hsi.SubspaceIdentification(modes=())
    assert str(nothing) == "no mode"
    with pytest.raises(ValueError, match="a mode must have been found, got none; give a longer record, or another"):
        nothing.nearest(2.0)


def test_nothing_is_printed_and_nothing_is_switched_off(capfd: pytest.CaptureFixture[str]) -> None:
    before = np.geterr(), logging.getLogger("matplotlib").level
    identified(signals(0, (2.0, 0.01)))
    assert (np.geterr(), logging.getLogger("matplotlib").level) == before
    assert capfd.readouterr() == ("", "")


# refusals

NOISE = np.random.default_rng(0).standard_normal((3, len(TIME)))


@pytest.mark.parametrize(("given", "says"), [
    ({"highest": 3.4}, r"record must be sampled at 3 times highest=3.4 Hz at least, got 10 Hz; sample it faster, or"),
    ({"highest": 0.0}, r"highest must be above 0, got 0; give the frequency \[Hz\] up to which"),
    ({"order": 2}, "order must be at least 4, got 2; give twice the number of modes"),
    ({"order": 100}, r"record must be at least 1010 s long for these highest= and order=, got 600 s; measure longer"),
    ({"record": NOISE[:, :1000], "timepts": TIME[:1000]}, r"at least 110 s long .*, got 100 s; measure longer, or"),
    ({"references": [0, 3]}, r"references must be different outputs below 3, got \[0, 3\]; count from 0"),
    ({"references": [1, 1]}, r"references must be different outputs below 3, got \[1, 1\]; count from 0"),
    ({"record": NOISE[0], "references": [1]}, r"references must be different outputs below 1, got \[1\]; count"),
    ({"references": []}, "references must hold at least one, got none; give a list of some"),
    ({"record": np.where(TIME[7] == TIME, np.nan, NOISE)}, r"record\[0, 7\] must be finite, got nan; cut or fill"),
    ({"record": np.vstack([NOISE, 0 * TIME])}, r"every output must vibrate, got none in 3; leave it out"),
    ({"record": [np.sin(12 * TIME)] * 2}, "record must be a random vibration at every sensor, got covariances that"),
    ({"record": np.zeros((2, len(TIME)))}, "every output must vibrate, got none in 0; leave it out"),
    ({"timepts": TIME**2}, "times of a record must increase evenly"),
    ({"timepts": TIME[1:]}, r"record must hold one value per output and time, got shape \(3, 6000\) for 5999 times"),
])
def test_refused_by_value(given: dict[str, Any], says: str) -> None:
    with pytest.raises(ValueError, match=says):
        hsi.subspace_identification(**{"record": NOISE, "timepts": TIME, "highest": 3.0, **given})


@pytest.mark.parametrize(("given", "says"), [
    ({"timepts": None}, "timepts must go with an array, got none with a ndarray; give seconds"),
    ({"order": 10.0}, "order must be a whole number, got 10.0; give twice the number of modes"),
    ({"references": 1}, "references must be of type list or tuple, got int; give a list"),
    ({"references": [0.0]}, "references must be a whole number, got 0.0; count from 0"),
])
def test_refused_by_kind(given: dict[str, Any], says: str) -> None:
    with pytest.raises(TypeError, match=says):
        hsi.subspace_identification(**{"record": NOISE, "timepts": TIME, "highest": 3.0, **given})


def test_without_pyoma_the_remedy_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyoma2.algorithms", None)
    with pytest.raises(ImportError, match=r"must find pyOMA-2, got none; pip install 'hsictrl\[oma\]'"):
        identified(NOISE)
