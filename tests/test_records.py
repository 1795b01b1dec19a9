"""Truth here: the RMS of a sine, of a constant, ISO 2631-1's integral by brute force; spectra in closed form."""

from collections.abc import Callable

import control as ct
import numpy as np
import pytest

from hsictrl.records import amplitude_spectrum, running_rms


def record(time: np.ndarray, signal: np.ndarray) -> ct.TimeResponseData:
    return ct.TimeResponseData(time, signal, issiso=np.ndim(signal) == 1)


def test_sine_has_its_amplitude_over_root_two() -> None:
    time = np.linspace(0.0, 10.0, 1001)
    rms = running_rms(record(time, 3.0 * np.sin(2 * np.pi * 2.5 * time)))
    np.testing.assert_allclose(rms[time >= 1.0], 3.0 / np.sqrt(2), rtol=1e-12)


def test_constant_is_its_own_rms_from_the_first_sample_on() -> None:
    time = np.linspace(0.0, 3.0, 301)
    np.testing.assert_allclose(running_rms(record(time, np.full(301, -0.7))), 0.7, rtol=1e-12)


def test_a_ramp_by_its_closed_form() -> None:
    """∫_{t−τ}^{t} s² ds = (t³ − (t−τ)³)/3, with what there is of the window before τ."""
    time, window = np.linspace(0.0, 5.0, 5001), 0.75
    start = np.maximum(time - window, 0.0)
    exact = np.sqrt((time[1:]**3 - start[1:]**3) / 3 / (time - start)[1:])
    np.testing.assert_allclose(running_rms(record(time, time), duration=window)[50:], exact[49:], rtol=1e-4)


def test_uneven_times_and_a_window_that_ends_between_samples() -> None:
    rng = np.random.default_rng(1)
    time = np.unique(np.concatenate([[0.0, 4.0], rng.uniform(0.0, 4.0, 40_000)]))
    rms = running_rms(record(time, np.cos(2 * np.pi * time)), duration=0.5)
    np.testing.assert_allclose(rms[time > 0.5], np.sqrt(0.5), rtol=1e-5)


def test_window_longer_than_the_record_is_the_rms_so_far() -> None:
    time = np.linspace(0.0, 2.0, 201)
    signal = np.random.default_rng(2).normal(size=201)
    energy = np.trapezoid(signal**2, time)
    assert running_rms(record(time, signal), duration=60.0)[-1] == pytest.approx(np.sqrt(energy / 2.0))


def test_the_time_need_not_start_at_zero() -> None:
    time, signal = np.linspace(0.0, 3.0, 301), np.random.default_rng(3).normal(size=301)
    np.testing.assert_allclose(running_rms(record(time + 500.0, signal)), running_rms(record(time, signal)), rtol=1e-9)


def test_a_quiet_end_after_a_loud_beginning() -> None:
    time = np.linspace(0.0, 100.0, 100_001)
    rms = running_rms(record(time, np.where(time < 50.0, 1e3, 0.1)))
    np.testing.assert_allclose(rms[time > 51.1], 0.1, rtol=1e-3)


def test_silence_after_noise_never_gives_nan() -> None:
    time = np.linspace(0.0, 10.0, 1001)
    rms = running_rms(record(time, np.where(time < 5.0, np.random.default_rng(4).normal(size=1001), 0.0)))
    assert np.all(rms >= 0)


def test_shape_is_that_of_the_outputs() -> None:
    time = np.linspace(0.0, 2.0, 201)
    both = record(time, np.array([np.ones(201), np.full(201, 2.0)]))
    assert running_rms(both).shape == both.outputs.shape
    np.testing.assert_allclose(running_rms(both)[:, -1], [1.0, 2.0])


def test_refusals() -> None:
    time = np.linspace(0.0, 1.0, 11)
    with pytest.raises(TypeError, match="response must be of type TimeResponseData, got ndarray; give"):
        running_rms(time)
    with pytest.raises(ValueError, match="duration must be above 0, got 0; give seconds"):
        running_rms(record(time, time), duration=0.0)
    with pytest.raises(ValueError, match=r"times of a record must increase, got 1 s and then 0.9 s; sort"):
        running_rms(record(time[::-1], time))
    with pytest.raises(ValueError, match=r"times of a record\[10\] must be finite, got nan; give seconds"):
        running_rms(record(np.append(time[:-1], np.nan), time))


@pytest.mark.parametrize("read", [running_rms, amplitude_spectrum])
@pytest.mark.parametrize("hole", [np.nan, np.inf])
def test_records_with_holes_are_refused(read: Callable, hole: float) -> None:
    time = np.linspace(0.0, 1.0, 11)
    with pytest.raises(ValueError, match=rf"outputs of a record\[1, 3\] must be finite, got {hole}; cut or fill"):
        read(record(time, np.array([time, np.where(np.arange(11) == 3, hole, time)])))


# amplitude spectrum

@pytest.mark.parametrize("n", [1000, 1001])
def test_a_sine_at_the_centre_of_a_bin_shows_its_amplitude(n: int) -> None:
    """A Hann window spreads a line as 1/2, 1, 1/2 over three bins, and over no more."""
    time = 5.0 + 0.01 * np.arange(n)
    signal = 3.0 * np.sin(2 * np.pi * 20 / (0.01 * n) * time + 0.4)
    frequencies, amplitudes = amplitude_spectrum(record(time, signal))
    exact = np.zeros(n // 2 + 1)
    exact[19:22] = 1.5, 3.0, 1.5
    np.testing.assert_allclose(amplitudes, exact, atol=1e-9)
    np.testing.assert_allclose(frequencies, np.arange(n // 2 + 1) / (0.01 * n), rtol=1e-9)


def test_halfway_between_bins_a_sine_shows_8_over_3_pi() -> None:
    time = 0.01 * np.arange(4000)
    amplitudes = amplitude_spectrum(record(time, np.sin(2 * np.pi * 400.5 / 40.0 * time)))[1]
    np.testing.assert_allclose(amplitudes[400:402], 8 / (3 * np.pi), rtol=1e-4)


def test_mean_and_nyquist_frequency_have_one_side() -> None:
    """2 + 3 (-1)^k: the lines at both ends are themselves, each neighbour holds half of two sides."""
    signal = 2.0 + 3.0 * (-1.0)**np.arange(64)
    amplitudes = amplitude_spectrum(record(np.arange(64) / 10, signal))[1]
    np.testing.assert_allclose(amplitudes, [2.0, 2.0, *[0.0] * 29, 3.0, 3.0], atol=1e-12)


def test_spectrum_has_a_row_per_output() -> None:
    time = np.arange(400) / 100
    both = np.array([np.sin(2 * np.pi * 5.0 * time), 2.0 * np.cos(2 * np.pi * 10.0 * time)])
    frequencies, amplitudes = amplitude_spectrum(record(time, both))
    assert frequencies[np.argmax(amplitudes, axis=1)] == pytest.approx([5.0, 10.0])
    np.testing.assert_allclose(amplitudes.max(axis=1), [1.0, 2.0])


def test_spectrum_refusals() -> None:
    with pytest.raises(TypeError, match="response must be of type TimeResponseData, got list; give"):
        amplitude_spectrum([1.0])
    with pytest.raises(ValueError, match=r"times of a record must increase evenly, got steps from 1 to 2 s; use"):
        amplitude_spectrum(record(np.array([0.0, 1.0, 3.0]), np.zeros(3)))
