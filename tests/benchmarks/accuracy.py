"""What is lost, measured against a second road: `make bench`. The tests assert the bounds."""

from __future__ import annotations

from collections.abc import Iterator

import control as ct
import numpy as np
from bench import BRIDGE, SEED, crowd, error_of, stream
from rows import check_threads, publish

import hsictrl as hsi
from hsictrl.coupling import CondensedCrowd
from tests.second_road import dense, on_coordinate, peaks

OMEGA = 2 * np.pi * np.linspace(0.5, 8.0, 800)
WALKERS = 75


def response() -> tuple[str, ...]:
    """Three modes and a random crowd, condensed and as matrices."""
    bridge = hsi.Footbridge.simply_supported(length=50.0, width=3.0, mass=50e3, frequency=2.0, damping=0.005, n_modes=3)
    people, places = crowd(WALKERS)
    condensed, plain = (ct.frequency_response(system, OMEGA).frdata for system in (
        hsi.couple(bridge, people, places), dense(bridge, people, places)))
    return ("frequency response, 75 walkers, 3 modes", "dense matrices of appendix A", "1e-10 of the peak",
            told(np.max(np.abs(condensed - plain)) / np.max(np.abs(plain))))


def peak() -> Iterator[tuple[str, ...]]:
    """The highest peak under a random crowd, as a search on a fine grid finds it."""
    people, places = crowd(WALKERS)
    found = hsi.effective(hsi.couple(BRIDGE, people, places))
    frequency, size = peaks(on_coordinate(BRIDGE, people, places))[0]
    yield ("`effective`, frequency", "zero of the slope of the plain system", "1e-9",
           told(abs(found.frequency / frequency - 1)))
    yield "`effective`, peak", "the same", "1e-9", told(abs(found.peak / size - 1))


def shared() -> tuple[str, ...]:
    """Many bridges under one crowd, at once and one by one."""
    people, places = crowd(WALKERS)
    frequencies = np.linspace(1.0, 6.0, 21)
    _, together = hsi.effective_map(CondensedCrowd(people, BRIDGE.participation(places)), frequencies, [0.005])
    apart = [hsi.effective(hsi.couple(hsi.reference_bridge(frequency=f), people, places)).damping for f in frequencies]
    return "`effective_map`, damping", "`effective`, bridge by bridge", "1.5e-7", told(
        np.max(np.abs(np.ravel(together) / apart - 1)))


def forces() -> Iterator[tuple[str, ...]]:
    """Walking forces off their tables, and line by line."""
    rng = np.random.default_rng(SEED)
    for name, force, bound in (("narrow band", hsi.ZivanovicForce(), "2e-5"), ("two harmonics", hsi.HarmonicForce(
            [0.4, 0.1]), "2e-10")):
        lines = force.lines([1.9] * 10, weight=[700.0] * 10, draws=rng.random((10, force.n_draws)))
        times = np.arange(1000) * 0.0173
        exact = lines.at(times)
        lost = np.max(np.abs(lines.on_grid(np.zeros(10), len(times), 0.0173) - exact), axis=1)
        yield (f"walking forces off a table, {name}", "the direct sum of lines", f"{bound} of a walker's peak",
               told(np.max(lost / np.max(np.abs(exact), axis=1))))


def stepper() -> Iterator[tuple[str, ...]]:
    """The default step, its estimate of the error, and its order."""
    moving = stream(225, hsi.HarmonicForce([0.4, 0.1]))
    error, estimate = error_of(moving), hsi.simulate(moving).error
    yield "`simulate`, 225 walkers, default step", "steps an eighth as long", "1e-4 of the peak", told(error)
    yield "its estimate of that error, over the error", "the same", "2/3 to 5", f"{estimate / error:.1f}"
    yield "its order", "regression over three steps", "at least 3.7", f"{order():.2f}"


def order() -> float:
    """Slope of log error over log step, 30 walkers who step on between steps."""
    moving, times, steps = stream(30, hsi.HarmonicForce([0.4])), np.linspace(20.0, 30.0, 251), (20e-3, 10e-3, 5e-3)
    exact, *found = (hsi.simulate(moving, times, step=step).response.outputs for step in (1e-3, *steps))
    return float(np.polyfit(np.log(steps), np.log([np.max(np.abs(one - exact)) for one in found]), 1)[0])


def told(value: float) -> str:
    return f"{value:.1e}"


if __name__ == "__main__":
    check_threads()
    publish("accuracy", "accuracy", ["road", "against", "bound", "measured"],
            [list(row) for row in (response(), *peak(), shared(), *forces(), *stepper())], [])
