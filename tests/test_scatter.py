"""Scattered poles against the host's eigenvalues, a first-order mean, and the counts of an ellipse."""

import numpy as np
import pytest

import hsictrl as hsi
from hsictrl.loop import scatter as module


def beam(frequency=2.0, n_modes=1):
    return hsi.Footbridge.simply_supported(length=50.0, width=3.0, mass=50e3, frequency=frequency, damping=0.005,
                                           n_modes=n_modes)


def found(bridge, persons=15, trials=200, seed=1, **given):
    flow = hsi.CrowdFlow(persons=persons, **({"population": given.pop("population")} if "population" in given else {}))
    return hsi.pole_scatter(bridge, flow, trials=trials, rng=np.random.default_rng(seed), **given)


def crowds(bridge, persons, trials, seed=1):
    """The crowds again, one by one."""
    return [hsi.couple(bridge, *hsi.CrowdFlow(persons=persons).crowd(bridge, rng))
            for rng in np.random.default_rng(seed).spawn(trials)]


@pytest.mark.parametrize("frequency", [1.0, 2.0, 3.25, 5.0])
@pytest.mark.parametrize(("n_modes", "persons"), [(1, 40), (3, 10)])
def test_each_is_the_pole_of_its_crowd_that_dominates_the_response(frequency, n_modes, persons):
    bridge = beam(frequency, n_modes)
    for pole, occupied in zip(found(bridge, persons).poles, crowds(bridge, persons, 5), strict=False):
        hertz, damping = hsi.effective(occupied, method="pole")
        assert abs(pole) / (2 * np.pi) == pytest.approx(hertz, rel=1e-9)
        assert -pole.real / abs(pole) == pytest.approx(damping, rel=1e-8)


def test_tuned_bodies_take_the_pole_where_the_root_locus_over_their_mass_does():
    """At 3.5 Hz bridge and bodies exchange poles; crowds 2, 13 and 15 lead astray those who take too long steps."""
    bridge, flow = beam(3.5), hsi.CrowdFlow(persons=150)
    poles, streams = found(bridge, 150, trials=16).poles, np.random.default_rng(1).spawn(16)
    for i in (2, 13, 15):
        people, places = flow.crowd(bridge, streams[i])
        locus = hsi.root_locus(bridge, people, places, parameter="mass", values=np.linspace(1e-3, 70, 30))
        assert abs(locus.poles[-1, 0] - poles[i]) < 1e-9


def test_each_mode_has_its_own():
    bridge = beam(n_modes=2)
    poles = found(bridge, 5, trials=3, mode=1).poles
    for pole, occupied in zip(poles, crowds(bridge, 5, 3), strict=True):
        own = hsi.effective(occupied, mode=1, method="pole")
        assert abs(pole) / (2 * np.pi) == pytest.approx(own.frequency, rel=1e-9)


def test_light_bodies_shift_the_mean_by_first_order():
    """E[p] − p₀ = −n E[φ²] p₀²α(p₀)/D₀′(p₀), with E[φ²] = 1/(2 m_B) of a half sine."""
    light = hsi.Population(frequency=3.25, damping=0.3, mass=0.1)
    scattered, body, (mode,) = found(beam(), trials=2000, population=light), hsi.Pedestrian(mass=0.1), beam().modes
    p = scattered.empty
    assert p == pytest.approx(mode.omega * (-0.005 + 1j * np.sqrt(1 - 0.005**2)))
    shift = -15 / (2 * 25e3) * p**2 * body.apparent_mass(p) / (2 * p + 2 * mode.damping * mode.omega)
    assert scattered.mean - p == pytest.approx(shift, rel=0.02)    # its error is 0.5 %


def test_trials_are_streams_of_their_own():
    assert np.array_equal(found(beam(), trials=10).poles, found(beam(), trials=30).poles[:10])


@pytest.mark.parametrize("share", [0.5, 0.95])
def test_the_region_holds_its_share(share):
    scattered = found(beam(), trials=400)
    outline = scattered.region(share) - scattered.mean
    assert outline[0] == pytest.approx(outline[-1])
    away = scattered.poles - scattered.mean
    edge = np.interp(np.angle(away), *_turned(outline))
    assert np.mean(np.abs(away) <= edge) == pytest.approx(share, abs=0.01)


def _turned(outline):
    """Distance of an outline from its centre over the angle, periodic."""
    order = np.argsort(np.angle(outline))
    angle, size = np.angle(outline)[order], np.abs(outline)[order]
    return np.concatenate([angle - 2 * np.pi, angle, angle + 2 * np.pi]), np.tile(size, 3)


def test_summary():
    scattered = found(beam())
    assert scattered.frequency == pytest.approx(np.abs(scattered.poles) / (2 * np.pi))
    assert scattered.damping == pytest.approx(-scattered.poles.real / np.abs(scattered.poles))
    assert str(scattered).startswith("200 crowds of 15: 1.97")


def test_refusals(monkeypatch):
    bridge, flow, rng = beam(), hsi.CrowdFlow(persons=3), np.random.default_rng(1)
    with pytest.raises(TypeError, match="flow must be of type CrowdFlow, got int"):
        hsi.pole_scatter(bridge, 3, rng=rng)
    with pytest.raises(TypeError, match="rng must be of type Generator, got int"):
        hsi.pole_scatter(bridge, flow, rng=1)
    with pytest.raises(ValueError, match="trials must be at least 2, got 1"):
        hsi.pole_scatter(bridge, flow, trials=1, rng=rng)
    with pytest.raises(ValueError, match="mode must be below the number of modes 1, got 1"):
        hsi.pole_scatter(bridge, flow, mode=1, rng=rng)
    with pytest.raises(ValueError, match=r"share must lie in \(0, 1\), got 95"):
        found(bridge, 3, 10).region(95)
    monkeypatch.setattr(module, "SETTLED", -1.0)
    with pytest.raises(ArithmeticError, match="the poles of 5 crowds must settle in 40 rounds"):
        hsi.pole_scatter(bridge, flow, trials=5, rng=rng)
