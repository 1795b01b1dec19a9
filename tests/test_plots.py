"""Asserted on the data that is drawn, not on images; truth is what went in."""

from collections.abc import Callable
from itertools import combinations
from pathlib import Path

import control as ct
import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.animation import AbstractMovieWriter
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.layout_engine import ConstrainedLayoutEngine
from PIL import Image

import hsictrl as hsi
from hsictrl.plots import (
    assessment_figure,
    bars_plot,
    contact_force_plot,
    convergence_plot,
    crossing_animation,
    decay_plot,
    effective_map_plot,
    effective_panels,
    frf_plot,
    map_plot,
    models_plot,
    normalised_frf_plot,
    nyquist_plot,
    persons_plot,
    pole_scatter_plot,
    response_plot,
    root_locus_plot,
    save,
    save_animation,
    sensitivity_plot,
    simulation_figure,
    spectrum_plot,
)
from hsictrl.records import amplitude_spectrum, running_rms

HERTZ = np.linspace(2.0, 5.0, 301)
BRIDGE = hsi.reference_bridge(frequency=3.25)
OCCUPIED = hsi.couple(BRIDGE, hsi.Pedestrian(damping=0.1), np.linspace(5, 45, 100))   # two competing peaks
FRFS = [hsi.frf(BRIDGE, HERTZ), hsi.frf(OCCUPIED, HERTZ)]
FOUND = [hsi.effective(BRIDGE), hsi.effective(OCCUPIED)]
TIME = np.linspace(0.0, 10.0, 1001)


def acceleration(amplitude: float, name: str | None) -> ct.TimeResponseData:
    signal = amplitude * np.sin(2 * np.pi * 2.0 * TIME) * np.sin(np.pi * TIME / 10)
    return ct.TimeResponseData(TIME, signal, issiso=True, sysname=name)


WIDE = hsi.PercentileRule(tolerance=0.2)


def study(scale: float, rule: hsi.StopRule = WIDE) -> hsi.Ensemble:
    return hsi.monte_carlo(lambda rng: rng.rayleigh(scale), rule=rule)


RECORDS = [acceleration(2.0, "MF"), acceleration(0.5, "PMC")]
MARKS = {"steps": [1.9, 3.8], "bridge": 2.0}
MAPS = {"few": np.add.outer([0.0, 1.0, 2.0], [0.0, 1.0]), "many": np.add.outer([4.0, 5.0, 6.0], [0.0, 2.0])}
PERSONS = np.where(TIME < 5.0, 3, 4)
STUDIES = [study(1.0), study(0.3)]
DECAY = hsi.free_decay(0.3 + np.exp(-0.4 * TIME) * np.cos(4 * np.pi * TIME), timepts=TIME)
LOCUS = hsi.root_locus(BRIDGE, hsi.Pedestrian(), np.linspace(5, 45, 10))
SCATTER = hsi.pole_scatter(BRIDGE, hsi.CrowdFlow(persons=10), trials=50, rng=np.random.default_rng(1))
MAP = {f"μ = {mu}": {"frequency": np.outer([1.0, 0.9, 1.1], np.ones(301)), "damping": np.full((3, 301), mu)}
       for mu in (0.1, 0.2)}


@pytest.fixture
def ax() -> Axes:
    return plt.subplots(layout="constrained")[1]


def entries(plot: ct.ControlPlot, row: int = 0) -> list[str]:
    return [text.get_text() for text in plot.legend[row, 0].get_texts()]


# what all of them share

DRAWINGS = {
    "frf": (1, lambda ax: frf_plot(FRFS, effective=FOUND, ax=ax)),
    "response": (1, lambda ax: response_plot(RECORDS, ax=ax)),
    "convergence": (1, lambda ax: convergence_plot(STUDIES, ax=ax)),
    "decay": (2, lambda ax: decay_plot(DECAY, ax=ax)),
    "assessment": (3, lambda ax: assessment_figure(
        frfs=FRFS, effective=FOUND, responses=RECORDS, ensembles=STUDIES, title="Bridge", ax=ax)),
    "map": (2, lambda ax: effective_map_plot(HERTZ, MAP, ax=ax)),
    "maps": (2, lambda ax: map_plot(
        [1.0, 2.0], [20.0, 30.0, 50.0], MAPS, quantity="Peak [m/s²]", columns=1, ax=ax)),
    "normalised": (2, lambda ax: normalised_frf_plot(
        HERTZ / 3.25, {"few": {"100": FRFS[1]}, "many": {"200": FRFS[1]}}, empty=FRFS[0], ax=ax)),
    "spectrum": (1, lambda ax: spectrum_plot(RECORDS[0], marks=MARKS, ax=ax)),
    "nyquist": (1, lambda ax: nyquist_plot(hsi.loop_gain(OCCUPIED), ax=ax)),
    "sensitivity": (1, lambda ax: sensitivity_plot(hsi.sensitivity(OCCUPIED), ax=ax)),
    "locus": (1, lambda ax: root_locus_plot(LOCUS, ax=ax)),
    "scatter": (1, lambda ax: pole_scatter_plot(SCATTER, ax=ax)),
    "persons": (1, lambda ax: persons_plot(TIME, PERSONS, ax=ax)),
    "simulation": (3, lambda ax: simulation_figure(
        response=RECORDS[0], marks=MARKS, persons=PERSONS, title="Crowd", ax=ax)),
}


@pytest.mark.parametrize("name", DRAWINGS)
def test_without_axes_one_figure_is_made(name: str) -> None:
    rows, draw = DRAWINGS[name]
    plot = draw(None)
    assert isinstance(plot, ct.ControlPlot)
    assert plot.axes.shape == plot.lines.shape == (rows, 1)
    assert plt.get_fignums() == [plot.figure.number]


@pytest.mark.parametrize("name", DRAWINGS)
def test_given_axes_are_drawn_on_and_no_figure_is_made(name: str) -> None:
    rows, draw = DRAWINGS[name]
    figure, axes = plt.subplots(rows, 1)
    plot = draw(axes)
    assert plot.figure is figure
    assert plt.get_fignums() == [figure.number]
    assert list(plot.axes[:, 0]) == list(np.ravel(axes))
    assert all(line.axes is axis for axis, lines in zip(plot.axes[:, 0], plot.lines[:, 0], strict=True)
               for line in lines)


@pytest.mark.parametrize("name", DRAWINGS)
def test_every_axis_has_a_unit(name: str) -> None:
    rows, draw = DRAWINGS[name]
    shown = [label for axis in draw(None).axes[:, 0] for label in (axis.get_xlabel(), axis.get_ylabel()) if label]
    assert len(shown) >= rows + 1
    assert all("[" in label and label.endswith("]") for label in shown)


@pytest.mark.parametrize("name", DRAWINGS)
def test_legends_cover_no_data_and_lie_within_the_figure(name: str) -> None:
    plot = DRAWINGS[name][1](None)
    plot.figure.canvas.draw()
    for axis, legend in zip(plot.axes[:, 0], plot.legend[:, 0], strict=True):
        if legend is not None:
            assert legend.get_window_extent().y0 >= axis.get_window_extent().y1 - 1
            assert plot.figure.bbox.count_contains(legend.get_window_extent().corners()) == 4


@pytest.mark.parametrize("name", ["assessment", "decay", "normalised", "simulation"])
def test_titles_of_panels_do_not_meet_the_legends(name: str) -> None:
    plot = DRAWINGS[name][1](None)
    plot.figure.canvas.draw()
    for axis, legend in zip(plot.axes[:, 0], plot.legend[:, 0], strict=True):
        if legend is not None:
            assert not axis._left_title.get_window_extent().overlaps(legend.get_window_extent())


# the crowd as a controller


def test_nyquist_draws_the_loop_gain_and_its_mirror_image() -> None:
    line, mirrored, point = nyquist_plot(hsi.loop_gain(OCCUPIED), band=(1.0, 9.0)).lines[0, 0]
    at = 2j * np.pi * hsi.loop_gain(OCCUPIED).frequencies((1.0, 9.0))
    assert line.get_xdata() + 1j * line.get_ydata() == pytest.approx(hsi.loop_gain(OCCUPIED)(at))
    assert np.array_equal(mirrored.get_ydata(), -line.get_ydata())
    assert point.get_xydata().tolist() == [[-1, 0]]


def test_nyquist_of_several_modes_draws_their_determinant() -> None:
    bridge = hsi.Footbridge.simply_supported(length=50, width=3, mass=50e3, frequency=2, damping=0.005, n_modes=2)
    gain = hsi.loop_gain(hsi.couple(bridge, hsi.Pedestrian(), [10.0, 20.0]))
    line = nyquist_plot(gain, band=(1.0, 9.0)).lines[0, 0][0]
    L = gain(2j * np.pi * gain.frequencies((1.0, 9.0)))
    determinant = (1 + L[0, 0]) * (1 + L[1, 1]) - L[0, 1] * L[1, 0]
    assert line.get_xdata() + 1j * line.get_ydata() == pytest.approx(determinant - 1)


def test_sensitivity_is_drawn_over_hertz_and_shaded_on_both_sides_of_one(ax: Axes) -> None:
    plot = sensitivity_plot(hsi.sensitivity(OCCUPIED), band=(1.0, 9.0), ax=ax)
    line, = plot.lines[0, 0]
    frequencies = line.get_xdata()
    ratio = hsi.frf(OCCUPIED, frequencies).frdata / hsi.frf(BRIDGE, frequencies).frdata
    assert line.get_ydata() == pytest.approx(np.abs(ratio[0, 0]))
    assert entries(plot) == ["sensitivity", "amplifies", "helps"]
    assert entries(sensitivity_plot([hsi.sensitivity(OCCUPIED)] * 2, labels=["a", "b"])) == ["a", "b"]


def test_a_locus_is_drawn_as_frequency_over_damping_with_its_ends_marked(ax: Axes) -> None:
    plot = root_locus_plot(LOCUS, ax=ax)
    upper, _, first, last, *bodies = plot.lines[0, 0]
    assert upper.get_ydata() == pytest.approx(LOCUS.frequency[:, 0])
    assert upper.get_xdata() == pytest.approx(100 * LOCUS.damping[:, 0])
    assert first.get_ydata()[0] == pytest.approx(3.25)
    assert last.get_ydata()[0] == LOCUS.frequency[-1, 0]
    assert len(bodies) == 20
    assert entries(plot) == ["bridge", "bodies", "0 people", "10 people"]


def test_scatters_are_drawn_with_ellipses_and_the_empty_bridge(ax: Axes) -> None:
    plot = pole_scatter_plot([SCATTER, SCATTER], labels=["one", "two"], ax=ax)
    cloud, ellipse, *_, empty = plot.lines[0, 0]
    assert cloud.get_xdata() == pytest.approx(100 * SCATTER.damping)
    assert cloud.get_ydata() == pytest.approx(SCATTER.frequency)
    assert ellipse.get_ydata() == pytest.approx(np.abs(SCATTER.region()) / (2 * np.pi))
    assert (empty.get_xdata()[0], empty.get_ydata()[0]) == pytest.approx((0.5, 3.25))
    assert entries(plot) == ["one", "two", "95 %", "empty bridge"]


def test_refusals_of_what_is_no_loop() -> None:
    with pytest.raises(TypeError, match="gain must be of type LoopGain"):
        nyquist_plot(OCCUPIED)
    with pytest.raises(TypeError, match="sensitivities must be of type Sensitivity"):
        sensitivity_plot(OCCUPIED)
    with pytest.raises(ValueError, match="mode must be below the number of modes 1, got 1"):
        sensitivity_plot(hsi.sensitivity(OCCUPIED), mode=1)
    with pytest.raises(TypeError, match="locus must be of type RootLocus"):
        root_locus_plot(OCCUPIED)
    with pytest.raises(TypeError, match="scatters must be of type PoleScatter"):
        pole_scatter_plot(OCCUPIED)


# frequency

def test_frf_draws_modulus_over_hertz(ax: Axes) -> None:
    plot = frf_plot(FRFS, labels=["empty", "occupied"], ax=ax)
    for line, response in zip(plot.lines[0, 0], FRFS, strict=True):
        np.testing.assert_allclose(line.get_xdata(), HERTZ)
        np.testing.assert_allclose(line.get_ydata(), abs(response.frdata[0, 0]))
    assert (ax.get_yscale(), ax.get_xscale()) == ("log", "linear")
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("Frequency [Hz]", "Accelerance |H| [m/s² per N]")
    assert entries(plot) == ["empty", "occupied"]


def test_curves_differ_in_colour_and_in_dashes() -> None:
    first, second = frf_plot(FRFS).lines[0, 0]
    assert to_hex(first.get_color()) != to_hex(second.get_color())
    assert first.get_linestyle() != second.get_linestyle()


def test_effective_properties_are_marked_and_named(ax: Axes) -> None:
    plot = frf_plot(FRFS, effective=FOUND, ax=ax)
    for curve, mark, one in zip(plot.lines[0, 0][:2], plot.lines[0, 0][2:], FOUND, strict=True):
        assert (*mark.get_xdata(), *mark.get_ydata()) == (one.frequency, one.peak)
        assert mark.get_color() == curve.get_color()
    assert entries(plot)[2].startswith(r"$f_\mathrm{eff}$ = 3.250 Hz, $\xi_\mathrm{eff}$ = 0.50 %")


def hollow(ax: Axes) -> list[tuple[float, float]]:
    return [(line.get_xdata()[0], line.get_ydata()[0]) for line in ax.lines if line.get_markerfacecolor() == "white"]


def test_competing_peaks_are_hollow(ax: Axes) -> None:
    plot = frf_plot(FRFS[1], effective=FOUND[1], ax=ax)
    assert len(FOUND[1].competing) == 1
    assert hollow(ax) == list(FOUND[1].competing)
    assert entries(plot)[-1].endswith("hollow: competing")


def test_competing_peaks_beyond_the_curves_do_not_stretch_the_axis(ax: Axes) -> None:
    plot = frf_plot(hsi.frf(OCCUPIED, np.linspace(2.0, 3.0, 50)), effective=FOUND[1], ax=ax)
    assert hollow(ax) == []
    assert ax.get_xlim() == (2.0, 3.0)
    assert "competing" not in entries(plot)[-1]


def test_one_mark_for_two_curves_takes_neither_colour() -> None:
    *curves, mark = frf_plot(FRFS, effective=FOUND[1]).lines[0, 0]
    assert mark.get_color() not in {curve.get_color() for curve in curves}


def test_frf_refusals() -> None:
    two = hsi.frf(hsi.couple(BRIDGE, [], [], sense_at=[10.0, 25.0]), HERTZ)
    with pytest.raises(ValueError, match=r"responses must have one input and one output, got 1 and 2; choose a pair"):
        frf_plot(two)
    with pytest.raises(TypeError, match="responses must be of type FrequencyResponseData, got OccupiedBridge; compute"):
        frf_plot(OCCUPIED)
    with pytest.raises(TypeError, match="effective must be of type EffectiveProperties, got float; compute"):
        frf_plot(FRFS, effective=3.25)
    with pytest.raises(ValueError, match="responses must hold at least one FrequencyResponseData, got none; compute"):
        frf_plot([])
    with pytest.raises(ValueError, match="labels must be one per curve, got 1 for 2; give as many"):
        frf_plot(FRFS, labels="both")
    with pytest.raises(TypeError, match="ax must be of type Axes, got str; make one"):
        frf_plot(FRFS, ax="here")
    assert plt.get_fignums() == []


def test_normalised_frf_draws_over_the_ratio_with_the_empty_bridge_in_black() -> None:
    panels = {"few": {"100": FRFS[1]}, "many": {"200": FRFS[1], "300": FRFS[1]}}
    plot = normalised_frf_plot(HERTZ / 3.25, panels, empty=FRFS[0])
    few, many = plot.lines[:, 0]
    assert [line.get_label() for line in many] == ["200", "300", "empty bridge"]
    np.testing.assert_array_equal(few[0].get_xdata(), HERTZ / 3.25)
    np.testing.assert_allclose(few[0].get_ydata(), abs(FRFS[1].frdata[0, 0]))
    np.testing.assert_allclose(few[-1].get_ydata(), abs(FRFS[0].frdata[0, 0]))
    assert few[-1].get_color() == many[-1].get_color() == "#222222"
    assert [axis.get_title("left") for axis in plot.axes[:, 0]] == ["(a) few", "(b) many"]


def test_normalised_frf_refusals() -> None:
    with pytest.raises(ValueError, match="each response must have 3 frequencies, one per ratio, got 301; compute"):
        normalised_frf_plot([0.9, 1.0, 1.1], {"few": {"100": FRFS[1]}}, empty=FRFS[0])
    with pytest.raises(ValueError, match="panels must hold at least one panel, got none; give"):
        normalised_frf_plot(HERTZ, {}, empty=FRFS[0])
    with pytest.raises(TypeError, match="panels must be of type Mapping, got NoneType; give"):
        normalised_frf_plot(HERTZ, None, empty=FRFS[0])


# time

def test_response_draws_traces_running_rms_and_peaks(ax: Axes) -> None:
    plot = response_plot(RECORDS, ax=ax)
    lines = plot.lines[0, 0]
    for record, trace, bold, peak in zip(RECORDS, lines[:2], lines[2:4], lines[4:], strict=True):
        np.testing.assert_array_equal(trace.get_xdata(), TIME)
        np.testing.assert_array_equal(trace.get_ydata(), record.outputs)
        np.testing.assert_array_equal(bold.get_ydata(), running_rms(record))
        assert bold.get_linewidth() > 2 * trace.get_linewidth()
        assert abs(peak.get_ydata()[0]) == np.abs(record.outputs).max()
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("Time [s]", "Acceleration [m/s²]")


def test_response_names_systems_and_states_peaks() -> None:
    shown = entries(response_plot(RECORDS))
    assert shown[:4] == ["MF", "PMC", "running 1-s RMS", "running 1-s RMS"]
    assert shown[4] == "peak 2.0 m/s² at 5.1 s"
    assert entries(response_plot(acceleration(1.0, None)))[0] == "curve 0"
    assert entries(response_plot(RECORDS[0], labels="without"))[0] == "without"


def test_a_downward_peak_is_marked_where_it_is() -> None:
    record = ct.TimeResponseData(np.array([0.0, 1.0, 2.0]), np.array([0.0, -2.0, 1.0]), issiso=True)
    peak = response_plot(record).lines[0, 0][-1]
    assert (*peak.get_xdata(), *peak.get_ydata()) == (1.0, -2.0)
    assert peak.get_label() == "peak 2.0 m/s² at 1.0 s"


def test_predictions_are_drawn_as_they_come() -> None:
    walker = hsi.Walker(force=hsi.HarmonicForce([0.43]), step_frequency=2.0, speed=1.25)
    found = hsi.predict("MF", BRIDGE, hsi.Traffic([walker]), sense_at=[10.0])
    np.testing.assert_array_equal(response_plot(found.response).lines[0, 0][0].get_ydata(), found.response.y[0])


def test_response_refusals() -> None:
    both = ct.TimeResponseData(TIME, np.zeros((2, 1001)), issiso=False)
    with pytest.raises(ValueError, match="responses must have one output, got 2; predict with one point"):
        response_plot(both)
    with pytest.raises(TypeError, match="responses must be of type TimeResponseData, got ndarray; give predict"):
        response_plot(TIME)
    with pytest.raises(ValueError, match=r"outputs of a record\[7\] must be finite, got nan; cut or fill"):
        response_plot(ct.TimeResponseData(TIME, np.where(np.arange(1001) == 7, np.nan, 1.0), issiso=True))


def test_people_are_drawn_as_steps_from_zero(ax: Axes) -> None:
    line, = persons_plot(TIME, PERSONS, ax=ax).lines[0, 0]
    np.testing.assert_array_equal(line.get_data(), [TIME, PERSONS])
    assert (line.get_drawstyle(), ax.get_ylim()[0]) == ("steps-post", 0.0)


def test_an_empty_deck_has_an_axis_too() -> None:
    assert persons_plot([0.0, 1.0], [0, 0]).axes[0, 0].get_ylim()[1] > 1


def test_persons_refusals() -> None:
    with pytest.raises(ValueError, match="persons must be one number per time, got 2 for 3; count them with"):
        persons_plot([0.0, 1.0, 2.0], [1, 2])
    with pytest.raises(ValueError, match=r"persons\[0\] must be at least 0, got -1; count them"):
        persons_plot([0.0], [-1])
    with pytest.raises(ValueError, match=r"times must hold at least 1 number\(s\), got 0; give a list of seconds"):
        persons_plot([], [])


def test_spectrum_is_drawn_over_hertz_with_marks_at_their_frequencies(ax: Axes) -> None:
    curve, steps, bridge = spectrum_plot(RECORDS[0], marks=MARKS, ax=ax).lines[0, 0]
    np.testing.assert_array_equal(curve.get_data(), amplitude_spectrum(RECORDS[0]))
    assert curve.get_xdata()[np.argmax(curve.get_ydata())] == pytest.approx(2.0, abs=0.1)
    assert np.unique(steps.get_xdata()).tolist() == [1.9, 3.8]
    assert np.unique(bridge.get_xdata()).tolist() == [2.0]
    assert np.nanmax(steps.get_ydata()) == 1.0    # of the height of the axes
    assert bridge.get_linewidth() < steps.get_linewidth()
    assert ax.get_xlim() == pytest.approx((0.0, 1.1 * 3.8))
    assert ax.get_yscale() == "log"


def test_spectrum_without_marks_is_drawn_whole() -> None:
    plot = spectrum_plot(RECORDS[0])
    assert plot.axes[0, 0].get_xlim()[1] == pytest.approx(amplitude_spectrum(RECORDS[0])[0][-1])
    assert len(plot.lines[0, 0]) == 1


def test_silence_has_a_spectrum_to_draw() -> None:
    silence = ct.TimeResponseData(TIME, np.zeros(1001), issiso=True)
    spectrum_plot(silence).figure.canvas.draw()


def test_spectrum_refusals() -> None:
    with pytest.raises(ValueError, match="response must have one output, got 2; predict with one point"):
        spectrum_plot(ct.TimeResponseData(TIME, np.zeros((2, 1001)), issiso=False))
    with pytest.raises(ValueError, match=r"marks\['steps'\] must be above 0, got -1; give Hz"):
        spectrum_plot(RECORDS[0], marks={"steps": -1.0})
    with pytest.raises(TypeError, match="response must be of type TimeResponseData, got ndarray; give predict"):
        spectrum_plot(TIME)
    with pytest.raises(ValueError, match=r"marks\['a'\] must hold at least 1 number\(s\), got 0; give Hz"):
        spectrum_plot(RECORDS[0], marks={"a": []})
    with pytest.raises(ValueError, match=r"marks\['a'\] must have 1 dimension\(s\), got shape \(2, 2\); give Hz"):
        spectrum_plot(RECORDS[0], marks={"a": [[1, 2], [3, 4]]})
    with pytest.raises(TypeError, match=r"marks must be of type Mapping, got list; give \{label: frequencies in Hz\}"):
        spectrum_plot(RECORDS[0], marks=[1, 2])
    assert plt.get_fignums() == []


def test_simulation_figure_composes_the_three_plots() -> None:
    plot = DRAWINGS["simulation"][1](None)
    assert plot.figure.get_suptitle() == "Crowd"
    heads = [axis.get_title("left") for axis in plot.axes[:, 0]]
    assert heads == ["(a) Acceleration", "(b) Amplitude spectrum", "(c) People on the deck"]
    assert [entries(plot, row)[0] for row in range(2)] == ["MF", "steps"]
    assert [len(lines) for lines in plot.lines[:, 0]] == [3, 3, 1]


# studies

def test_convergence_draws_history_and_tolerance(ax: Axes) -> None:
    plot = convergence_plot(STUDIES, labels=["MF", "PMC"], ax=ax)
    lines = plot.lines[0, 0]
    for i, one in enumerate(STUDIES):
        np.testing.assert_array_equal(lines[i].get_xdata(), one.history().trials)
        np.testing.assert_array_equal(lines[i].get_ydata(), one.history().estimate)
        limits = [line.get_ydata()[0] for line in lines[2 + 2 * i:4 + 2 * i]]
        np.testing.assert_allclose(limits, [1.2 * one.estimate, 0.8 * one.estimate])
    assert {line.get_linestyle() for line in lines[2:]} == {"--"}
    assert entries(plot) == ["MF", "PMC", *["95 % interval"] * 2, *["±20 % tolerance"] * 2]


def test_the_band_is_the_interval(ax: Axes) -> None:
    convergence_plot(STUDIES[0], ax=ax)
    corners, history = ax.collections[0].get_paths()[0].vertices, STUDIES[0].history()
    drawn = np.isfinite(history.low) & np.isfinite(history.high)
    assert {*corners[:, 1]} >= {*history.low[drawn], *history.high[drawn]}


def test_quantity_names_the_vertical_axis() -> None:
    assert convergence_plot(STUDIES[0]).axes[0, 0].get_ylabel() == "Peak acceleration [m/s²]"
    assert convergence_plot(STUDIES[0], quantity="Mean [Hz]").axes[0, 0].get_ylabel() == "Mean [Hz]"


def test_a_mean_is_named_by_its_rule() -> None:
    assert entries(convergence_plot(study(1.0, hsi.MeanRule(tolerance=0.2))))[0] == "mean"


def test_a_study_too_short_for_an_interval_is_drawn_all_the_same(ax: Axes) -> None:
    short = hsi.monte_carlo(lambda rng: rng.rayleigh(), max_trials=10)
    convergence_plot(short, ax=ax).figure.canvas.draw()


def test_convergence_refusals() -> None:
    rows = hsi.monte_carlo(lambda rng: rng.rayleigh(size=2), rule=hsi.MeanRule(tolerance=0.5))
    with pytest.raises(ValueError, match=r"ensembles must hold one quantity, got samples of shape \(100, 2\); run one"):
        convergence_plot(rows)
    several = study(1.0, hsi.AllRules([hsi.MeanRule(tolerance=0.5)]))
    with pytest.raises(TypeError, match="each ensemble must be of type PercentileRule or MeanRule, got AllRules"):
        convergence_plot(several)
    with pytest.raises(TypeError, match="ensembles must be of type Ensemble, got ndarray; run hsictrl"):
        convergence_plot(STUDIES[0].samples)


# free decay

def test_decay_draws_the_record_its_extremes_and_an_envelope_through_them() -> None:
    trace, extremes, above, below = decay_plot(DECAY, quantity="Displacement [mm]").lines[0, 0]
    np.testing.assert_array_equal(trace.get_xydata(), np.column_stack([TIME, DECAY.record.outputs]))
    np.testing.assert_array_equal(extremes.get_xydata(), np.column_stack([DECAY.times, DECAY.values]))
    np.testing.assert_allclose(above.get_ydata() - 0.3, np.exp(-0.4 * above.get_xdata()), rtol=0.01)
    np.testing.assert_allclose(above.get_ydata() + below.get_ydata(), 0.6, rtol=0.01)
    assert trace.axes.get_ylabel() == "Displacement [mm]"


def test_decay_draws_logarithms_over_cycles_and_their_line() -> None:
    """A decay by exp(-0.4 t) at 2 Hz loses 0.2 in a cycle."""
    plot = decay_plot(DECAY)
    extremes, line = plot.lines[1, 0]
    np.testing.assert_allclose(np.diff(extremes.get_ydata()) / np.diff(extremes.get_xdata()), -0.2, rtol=0.01)
    (start, end), (high, low) = line.get_xdata(), line.get_ydata()
    assert (low - high) / (end - start) == pytest.approx(-0.2, rel=1e-3)
    assert high == pytest.approx(extremes.get_ydata()[0], abs=1e-3)
    assert entries(plot, 1) == ["extremes", "slope −0.2, R² = 1.0000"]


def test_decay_refusal() -> None:
    with pytest.raises(TypeError, match="decay must be of type FreeDecay, got TimeResponseData; give what"):
        decay_plot(RECORDS[0])


# figures of several panels

def test_assessment_figure_composes_the_three_plots() -> None:
    plot = DRAWINGS["assessment"][1](None)
    assert tuple(plot.figure.get_size_inches()) == (10.0, 9.0)
    assert plot.figure.get_suptitle() == "Bridge"
    heads = [axis.get_title("left") for axis in plot.axes[:, 0]]
    assert heads == ["(a) Frequency response", "(b) Acceleration", "(c) Convergence of percentile 95"]
    assert [entries(plot, row)[:2] for row in range(3)] == [["empty bridge", "occupied bridge"], *[["MF", "PMC"]] * 2]
    assert [len(lines) for lines in plot.lines[:, 0]] == [4, 6, 6]


def test_effective_map_draws_ratios_and_percents() -> None:
    plot = effective_map_plot(HERTZ, MAP)
    top, bottom = plot.axes[:, 0]
    for mean, low_high in zip(plot.lines[0, 0], top.collections, strict=True):
        np.testing.assert_allclose(mean.get_ydata(), 1.0)
        np.testing.assert_allclose(np.unique(low_high.get_paths()[0].vertices[:, 1].round(12)), [0.9, 1.1])
    assert [line.get_ydata()[0] for line in plot.lines[1, 0]] == pytest.approx([10.0, 20.0])
    np.testing.assert_array_equal(plot.lines[1, 0][0].get_xdata(), HERTZ)
    assert (entries(plot), plot.legend[1, 0]) == (["μ = 0.1", "μ = 0.2"], None)
    assert "%" in bottom.get_ylabel()


def test_effective_panels_stand_side_by_side() -> None:
    plot = effective_panels(HERTZ, {"one": MAP, "two": MAP, "three": MAP})
    assert plot.axes.shape == plot.lines.shape == plot.legend.shape == (2, 3)
    assert [axis.get_title("left") for axis in plot.axes[0]] == ["(a) one", "(b) two", "(c) three"]
    for j in range(3):
        assert [line.axes for line in plot.lines[1, j]] == [plot.axes[1, j]] * 2
        assert plot.lines[1, j][1].get_ydata()[0] == pytest.approx(20.0)
    assert [legend is None for legend in plot.legend.flat] == [True, True, False, True, True, True]
    plot.figure.canvas.draw()
    title = plot.axes[0, 2]._left_title.get_window_extent()
    assert not title.overlaps(plot.legend[0, 2].get_window_extent())


def test_effective_panels_are_drawn_on_given_axes() -> None:
    figure, axes = plt.subplots(2, 2)
    plot = effective_panels(HERTZ, {"one": MAP, "two": MAP}, ax=axes)
    assert plt.get_fignums() == [figure.number]
    assert plot.axes.tolist() == axes.tolist()


def test_effective_map_refusals() -> None:
    with pytest.raises(ValueError, match=r"statistics\['a'\] must hold 'frequency' and 'damping', got no 'damping'"):
        effective_map_plot([1.0], {"a": {"frequency": [[1.0]] * 3}})
    with pytest.raises(ValueError, match=r"statistics\['a'\]\['damping'\] must have shape \(3, 1\), got \(2, 1\)"):
        effective_map_plot([1.0], {"a": {"frequency": [[1.0]] * 3, "damping": [[0.1]] * 2}})
    with pytest.raises(ValueError, match="statistics must hold at least one label, got none"):
        effective_map_plot([1.0], {})
    with pytest.raises(ValueError, match="ax must hold 2 axes, got 1; make them with"):
        effective_map_plot(HERTZ, MAP, ax=plt.subplots()[1])
    with pytest.raises(ValueError, match="panels must hold at least one panel, got none; give"):
        effective_panels([1.0], {})
    with pytest.raises(ValueError, match=r"panels\['a'\] must hold at least one label, got none; give"):
        effective_panels([1.0], {"a": {}})


@pytest.mark.parametrize("wrong", [None, [1.0], 2.0])
def test_effective_maps_of_no_mapping_are_refused(wrong: object) -> None:
    got = type(wrong).__name__
    with pytest.raises(TypeError, match=rf"^statistics must be of type Mapping, got {got}; give \{{label"):
        effective_map_plot([1.0], wrong)
    with pytest.raises(TypeError, match=rf"^statistics\['a'\] must be of type Mapping, got {got}; give \{{'frequency'"):
        effective_map_plot([1.0], {"a": wrong})
    with pytest.raises(TypeError, match=rf"^panels must be of type Mapping, got {got}; give \{{title"):
        effective_panels([1.0], wrong)
    with pytest.raises(TypeError, match=rf"^panels\['a'\] must be of type Mapping, got {got}; give \{{label"):
        effective_panels([1.0], {"a": wrong})
    assert plt.get_fignums() == []


# maps

ACROSS, ALONG = np.linspace(1.0, 6.0, 26), np.array([20.0, 30.0, 40.0, 50.0])
RISING = ACROSS + 0.1 * ALONG[:, None]    # linear, from 3 to 11


def maps(panels: dict[str, np.ndarray], **options) -> ct.ControlPlot:
    return map_plot(ACROSS, ALONG, panels, quantity="Peak [m/s²]", **options)


def test_contours_lie_where_the_field_has_their_value() -> None:
    """By hand: f_B + 0.1 m_B is linear, so that each contour is a straight line."""
    _, lines = maps({"rising": RISING}, levels=[4, 6, 8, 10]).lines[0, 0]
    assert lines.levels.tolist() == [4, 6, 8, 10]
    for level, (piece,) in zip(lines.levels, [level[:1] for level in lines.allsegs], strict=True):
        np.testing.assert_allclose(piece[:, 0] + 0.1 * piece[:, 1], level, rtol=1e-12)


def test_fills_change_at_the_levels() -> None:
    filled, _ = maps({"rising": RISING}, levels=[4, 6, 8, 10]).lines[0, 0]
    between = [np.concatenate([one @ [1.0, 0.1] for one in band]) for band in filled.allsegs]
    assert [(low.min().round(9), low.max().round(9)) for low in between] == [(3, 4), (4, 6), (6, 8), (8, 10), (10, 11)]


def test_all_maps_share_one_scale_over_the_range_of_all() -> None:
    plot = maps({"low": RISING, "high": 2 * RISING, "flat": np.full_like(RISING, 5.0)})
    low, high, flat = plot.lines[0]
    assert low[0].norm is high[0].norm is flat[0].norm
    levels = low[0].levels
    assert (levels[0], levels[-1]) == (2.0, 22.0)    # 3 to 22 in steps of 2
    np.testing.assert_array_equal(levels, np.linspace(2.0, 22.0, 11))
    assert len(flat) == 1    # no level lies within it


def test_one_colour_bar_names_the_quantity() -> None:
    plot = maps({"low": RISING, "high": 2 * RISING})
    bar, = set(plot.figure.axes) - set(plot.axes.flat)
    assert bar.get_ylabel() == "Peak [m/s²]"
    assert bar.get_ylim() == (2.0, 22.0)


@pytest.mark.parametrize(("levels", "extend"), [
    ([2, 6, 12], "neither"), ([4, 6, 12], "min"), ([2, 6, 10], "max"), ([4, 6], "both")])
def test_the_scale_is_open_where_values_lie_beyond_it(levels: list[float], extend: str) -> None:
    assert maps({"rising": RISING}, levels=levels).lines[0, 0][0].extend == extend


def test_colours_grow_lighter_with_the_level() -> None:
    """Relative luminance as of WCAG 2.1; lines stand out by 5 to 2 from the fills on either side."""
    filled, lines = maps({"rising": RISING}, levels=[2, 4, 6, 8, 10, 12]).lines[0, 0]
    fills, inks = ([luminance(one) for one in colours] for colours in (filled.get_facecolor(), lines.get_edgecolor()))
    assert np.all(np.diff(fills) > 0.02)
    for ink, below, above in zip(inks, fills[:-1], fills[1:], strict=True):
        assert min(contrast(ink, below), contrast(ink, above)) > 2.5


def luminance(colour: np.ndarray) -> float:
    linear = np.where(colour[:3] <= 0.04045, colour[:3] / 12.92, ((colour[:3] + 0.055) / 1.055) ** 2.4)
    return float(linear @ [0.2126, 0.7152, 0.0722])


def contrast(one: float, other: float) -> float:
    return (max(one, other) + 0.05) / (min(one, other) + 0.05)


def test_what_is_not_known_is_hatched() -> None:
    holed = np.where((ACROSS > 4.9) & (ALONG[:, None] > 35.0), np.nan, RISING)
    plot = maps({"whole": RISING, "holed": holed, "void": np.full_like(RISING, np.nan)})
    filled, lines = plot.lines[0, 1]
    for artist in (filled, lines):
        corners = np.concatenate([piece for level in artist.allsegs for piece in level])
        assert not np.any((corners[:, 0] > 4.9) & (corners[:, 1] > 35.0))
    assert [bool(ax.patch.get_hatch()) for ax in plot.axes[0]] == [False, True, True]
    assert [text.get_text() for text in plot.legend[0, 0].get_texts()] == ["not known"]
    plot.figure.canvas.draw()


def test_numbers_that_know_no_neighbour_make_no_contours() -> None:
    alone = np.full((3, 3), np.nan)
    alone[0, 0], alone[2, 2] = 1.0, 2.0
    map_plot([1, 2, 3], [1, 2, 3], {"alone": alone}, quantity="Peak [m/s²]").figure.canvas.draw()


def test_fifteen_maps_stand_in_three_rows_with_names_outside_only() -> None:
    plot = maps({f"{xi} %, {d} /m²": d * RISING for xi in (0.2, 0.5, 2.0) for d in (0.2, 0.5, 0.8, 1.0, 1.5)})
    assert plot.axes.shape == (3, 5)
    assert plot.axes[2, 4].get_title("left") == "(o) 2.0 %, 1.5 /m²"
    plot.figure.canvas.draw()
    for (row, column), ax in np.ndenumerate(plot.axes):
        assert ax.get_xlabel() == ("Frequency $f_B$ [Hz]" if row == 2 else "")
        assert ax.get_ylabel() == ("Modal mass $m_B$ [t]" if column == 0 else "")
        assert any(tick.label1.get_visible() for tick in ax.xaxis.get_major_ticks()) == (row == 2)
        assert any(tick.label1.get_visible() for tick in ax.yaxis.get_major_ticks()) == (column == 0)
        assert ax.get_yticks().tolist() == ALONG.tolist()


def test_names_of_contours_do_not_meet_and_lie_within_their_panel() -> None:
    steep = 10.0 * np.exp(-(((ACROSS - 2.0) / 0.5) ** 2)) * 20.0 / ALONG[:, None]
    plot = maps({f"{i}": i * steep for i in range(10, 25)})
    plot.figure.canvas.draw()
    for ax, (_, *lines) in zip(plot.axes.flat, plot.lines.flat, strict=True):
        boxes = [text.get_window_extent() for one in lines for text in one.labelTexts]
        assert not any(one.overlaps(other) for one, other in combinations(boxes, 2))
        assert all(ax.bbox.count_contains(box.corners()) == 4 for box in boxes)
        assert boxes


def test_contours_are_named_by_their_levels() -> None:
    texts = maps({"rising": RISING}, levels=[4, 6, 8.5]).lines[0, 0][1].labelTexts
    assert sorted(float(text.get_text()) for text in texts) == [4, 6, 8.5]
    for text in texts:
        assert np.dot(text.get_position(), [1.0, 0.1]) == pytest.approx(float(text.get_text()), rel=1e-6)


def test_a_value_that_is_the_same_everywhere_has_a_scale_about_it() -> None:
    levels = maps({"flat": np.ones_like(RISING)}).lines[0, 0][0].levels
    assert (levels[0], levels[-1]) == pytest.approx((0.9, 1.1))
    maps({"nothing": np.zeros_like(RISING)}).figure.canvas.draw()


def test_a_table_of_axes_says_which_are_outside() -> None:
    _, axes = plt.subplots(3, 2)
    plot = maps({f"{i}": RISING for i in range(6)}, ax=axes)
    assert plot.axes.tolist() == axes.tolist()
    assert [ax.get_xlabel() != "" for ax in axes[:, 0]] == [False, False, True]


def test_panels_beyond_z_have_titles_too() -> None:
    assert maps({f"{i}": RISING for i in range(28)}).axes.flat[27].get_title("left") == "(ab) 27"


@pytest.mark.parametrize(("changes", "kind", "refusal"), [
    ({"x": [1.0, 3.0, 2.0]}, ValueError, "x must increase, got 3 and then 2; sort them, and the columns"),
    ({"y": [20.0, 20.0]}, ValueError, "y must increase, got 20 and then 20; sort them, and the rows"),
    ({"x": [1.0]}, ValueError, r"x must hold at least 2 number\(s\), got 1; sort"),
    ({"y": [[1.0, 2.0]]}, ValueError, r"y must have 1 dimension\(s\), got shape \(1, 2\); sort"),
    ({"panels": {}}, ValueError, r"panels must hold at least one panel, got none; give \{title: array"),
    ({"panels": None}, TypeError, r"panels must be of type Mapping, got NoneType; give \{title: array"),
    ({"panels": {"a": np.ones((3, 2))}}, ValueError, r"panels\['a'\] must have shape \(2, 3\), got \(3, 2\); give"),
    ({"panels": {"a": [[1, 2, 3], [4, 5, np.inf]]}}, ValueError, r"panels\['a'\]\[1, 2\] must be finite, got inf; g"),
    ({"panels": {"a": "map"}}, TypeError, r"panels\['a'\] must be real numbers, got 'map'; give"),
    ({"panels": {"a": np.full((2, 3), np.nan)}}, ValueError, "panels must hold at least one number, got only nan; g"),
    ({"levels": [1.0, 3.0, 2.0]}, ValueError, "levels must increase, got 3 and then 2; give them from low to high"),
    ({"levels": [1.0]}, ValueError, r"levels must hold at least 2 number\(s\), got 1; give"),
    ({"columns": 2}, ValueError, "panels must fill their rows, got 1 in 2 columns; give a divisor of 1"),
    ({"columns": 0}, ValueError, "columns must be at least 1, got 0; give the number of panels side by side"),
    ({"ax": []}, ValueError, "ax must hold 1 axes, got 0; make them with")])
def test_map_refusals(changes: dict[str, object], kind: type, refusal: str) -> None:
    given = {"x": [1.0, 2.0, 3.0], "y": [20.0, 50.0], "panels": {"a": np.ones((2, 3))}} | changes
    with pytest.raises(kind, match=f"^{refusal}"):
        map_plot(**given, quantity="Peak [m/s²]")
    assert plt.get_fignums() == []


# schematics

STEADY = hsi.HarmonicForce([0.4])
WALKERS = hsi.Traffic([hsi.Walker(force=STEADY, step_frequency=2.0, speed=1.0, arrival=arrival,
                                  body=hsi.Pedestrian(mass=80.0, frequency=2.0, sprung_ratio=0.9))
                       for arrival in (0.0, 10.0, 30.0, 70.0)])
PRESENT = [40.0, 30.0, 10.0]    # at 40 s, by hand: x = 1 m/s (t - t_a), and the last has not arrived
SCENES = {"one": {"forces_at_m": [10.0, 20.0], "forces_move": False, "added_mass_kg": 140.0, "bodies_at_m": [],
                  "bodies_move": False},
          "two": {"forces_at_m": [10.0, 20.0], "forces_move": True, "added_mass_kg": 0.0, "bodies_at_m": [5.0],
                  "bodies_move": False},
          "three": {"forces_at_m": [], "forces_move": True, "added_mass_kg": 0.0, "bodies_at_m": [5.0, 30.0],
                    "bodies_move": True}}
SCHEMATICS = {"contact force": lambda ax=None: contact_force_plot(BRIDGE, WALKERS, time=40.0, ax=ax),
              "models": lambda ax=None: models_plot(BRIDGE, SCENES, ax=ax)}


def drawn(ax: Axes, gid: str) -> list[Artist]:
    return ax.findobj(lambda artist: artist.get_gid() == gid)


def points_at(ax: Axes, gid: str) -> list[float]:
    """Places along the deck from which arrows hang, or the middles of symbols."""
    return [float(one.xyann[0]) if hasattr(one, "xyann") else float(np.nanmean([np.nanmin(one.get_xdata()),
            np.nanmax(one.get_xdata())])) for one in drawn(ax, gid)]


@pytest.mark.parametrize("name", SCHEMATICS)
def test_schematics_are_drawn_on_given_axes_or_on_one_figure(name: str) -> None:
    plot = SCHEMATICS[name]()
    assert plt.get_fignums() == [plot.figure.number]
    assert plot.axes.shape == plot.lines.shape == plot.legend.shape == (2, 2)
    figure, axes = plt.subplots(2, 2)
    assert SCHEMATICS[name](axes).axes.tolist() == axes.tolist()
    assert plt.get_fignums() == [plot.figure.number, figure.number]


@pytest.mark.parametrize("name", SCHEMATICS)
def test_words_of_schematics_do_not_meet_and_lie_within_the_figure(name: str) -> None:
    plot = SCHEMATICS[name]()
    plot.figure.canvas.draw()
    boxes = [text.get_window_extent() for ax in plot.axes.flat for text in [*ax.texts, ax._left_title]
             if text.get_text()]
    assert len(boxes) >= 4
    assert not any(one.overlaps(other) for one, other in combinations(boxes, 2))
    assert all(plot.figure.bbox.count_contains(box.corners()) == 4 for box in boxes)


def test_the_deck_is_the_first_mode_downwards() -> None:
    for ax in contact_force_plot(BRIDGE, WALKERS, time=40.0).axes.flat[1:]:
        x, y = drawn(ax, "deck")[0].get_data()
        assert (x[0], x[-1]) == (0.0, 50.0)
        np.testing.assert_allclose(y / y.min(), np.sin(np.pi * x / 50.0), atol=1e-12)


def test_contact_forces_stand_where_the_walkers_are() -> None:
    _, contact, driver, interaction = contact_force_plot(BRIDGE, WALKERS, time=40.0).axes.flat
    for ax, gid in ((contact, "person"), (contact, "force"), (driver, "force"), (driver, "trace"),
                    (interaction, "force")):
        assert points_at(ax, gid) == pytest.approx(PRESENT)
    assert len(drawn(interaction, "spring")) == len(drawn(interaction, "damper")) == 3
    assert not drawn(driver, "spring")
    for ax in (contact, driver, interaction):
        assert len(drawn(ax, "motion")) == 3
        assert all(one.xy[1] < one.xyann[1] for one in drawn(ax, "force"))    # downwards
        assert all(one.xy[0] > one.xyann[0] for one in drawn(ax, "motion"))    # onwards


def test_traces_are_the_walking_forces_to_the_scale_that_is_shown() -> None:
    """0.4 · 700 N cos(2π 2 t) for 0.75 s before and after 40 s, when 40 s is a whole number of steps."""
    ax = contact_force_plot(BRIDGE, WALKERS, time=40.0).axes[1, 0]
    bars = drawn(ax, "scale")[0].get_data()
    assert {"500 N", "0.5 s"} <= {text.get_text() for text in ax.texts}
    seconds, newtons = 0.5 / np.ptp(bars[0]), 500.0 / np.ptp(bars[1])
    x, y = drawn(ax, "trace")[0].get_data()
    times = (x - PRESENT[0]) * seconds
    assert (times[0], times[-1]) == pytest.approx((-0.75, 0.75))
    np.testing.assert_allclose((y - drawn(ax, "zero")[0].get_ydata()[0]) * newtons,
                               280.0 * np.cos(2 * np.pi * 2.0 * times), atol=1e-9)


def test_the_body_carries_its_numbers() -> None:
    """By hand: m_H1 = 0.9 · 80 kg, k = (2π 2 Hz)² 72 kg = 11370 N/m, c = 2 · 0.3 · 72 kg · 2π 2 Hz = 543 N s/m."""
    words = [text.get_text() for text in contact_force_plot(BRIDGE, WALKERS, time=40.0).axes[0, 0].texts]
    assert {r"$m_{H1}$ = 72.0 kg", r"$m_{H0}$ = 8.0 kg", r"$k_{H1}$ = 11.4 kN/m", r"$c_{H1}$ = 543 N s/m",
            r"$f_{H1}$ = 2.00 Hz, $\xi_{H1}$ = 30 %"} <= set(words)


def test_models_are_drawn_as_their_scenes_say() -> None:
    plot = models_plot(BRIDGE, SCENES)
    for ax, scene in zip(plot.axes.flat, SCENES.values(), strict=False):
        assert points_at(ax, "force") == scene["forces_at_m"]
        assert points_at(ax, "damper") == pytest.approx([x + 3 * 0.25 for x in scene["bodies_at_m"]])
        assert len(drawn(ax, "force motion")) == scene["forces_move"] * len(scene["forces_at_m"])
        assert len(drawn(ax, "body motion")) == scene["bodies_move"] * len(scene["bodies_at_m"])
        assert [band.get_hatch() for band in drawn(ax, "added mass")] == ["////"] * bool(scene["added_mass_kg"])
    assert [text.get_text() for text in plot.axes[0, 0].texts if text.get_text()] == ["140 kg"]
    assert [ax.get_title("left") for ax in plot.axes.flat] == ["(a) one", "(b) two", "(c) three", ""]
    assert len(plot.legend[1, 1].get_texts()) == 4


def test_schematic_refusals() -> None:
    with pytest.raises(ValueError, match="time must be an instant with somebody on the deck, got 200 s; choose"):
        contact_force_plot(BRIDGE, WALKERS, time=200.0)
    with pytest.raises(TypeError, match="traffic must be of type Traffic, got list; make it with"):
        contact_force_plot(BRIDGE, [], time=0.0)
    with pytest.raises(TypeError, match="bridge must be of type Footbridge, got str; describe"):
        models_plot("bridge", SCENES)
    with pytest.raises(ValueError, match="panels must hold at least one panel, got none; give"):
        models_plot(BRIDGE, {})
    with pytest.raises(ValueError, match=r"panels\['a'\] must hold 'forces_at_m', .*got no 'forces_at_m'; give all"):
        models_plot(BRIDGE, {"a": {}})
    with pytest.raises(ValueError, match=r"panels\['a'\]\['bodies_at_m'\] must lie on the deck, .* got .*60"):
        models_plot(BRIDGE, {"a": SCENES["one"] | {"bodies_at_m": [60.0]}})
    with pytest.raises(ValueError, match=r"panels\['a'\]\['added_mass_kg'\] must be at least 0, got -1; give kg"):
        models_plot(BRIDGE, {"a": SCENES["one"] | {"added_mass_kg": -1.0}})
    with pytest.raises(ValueError, match="ax must hold 4 axes, got 1; make them with"):
        models_plot(BRIDGE, SCENES, ax=plt.subplots()[1])


@pytest.mark.parametrize(("scene", "kind", "refusal"), [
    ({"forces_at_m": [[10.0, 0.0]]}, ValueError, r"\['forces_at_m'\] must have 1 dim.*, got shape \(1, 2\); give"),
    ({"forces_at_m": 10.0}, ValueError, r"\['forces_at_m'\] must have 1 dim.*, got shape \(\); give a list of x"),
    ({"forces_move": "no"}, TypeError, r"\['forces_move'\] must be of type bool, got str; give True or False"),
    ({"bodies_move": 1}, TypeError, r"\['bodies_move'\] must be of type bool, got int; give True or False")])
def test_scenes_that_cannot_be_drawn_are_refused(scene: dict[str, object], kind: type, refusal: str) -> None:
    with pytest.raises(kind, match=r"panels\['a'\]" + refusal):
        models_plot(BRIDGE, {"a": SCENES["one"] | scene})


@pytest.mark.parametrize(("panels", "refusal"), [
    (None, r"panels must be of type Mapping, got NoneType; give \{title"),
    ({"a": None}, r"panels\['a'\] must be of type Mapping, got NoneType; give \{'forces_at_m'")])
def test_models_without_scenes_are_refused(panels: object, refusal: str) -> None:
    with pytest.raises(TypeError, match=refusal):
        models_plot(BRIDGE, panels)


def test_whether_scenes_move_may_come_from_numpy() -> None:
    plot = models_plot(BRIDGE, {"a": SCENES["one"] | {"forces_move": np.bool_(True)}})
    assert len(drawn(plot.axes[0, 0], "force motion")) == 2


# animation

LONG = hsi.Footbridge.simply_supported(length=40.0, width=3.0, mass=40e3, frequency=2.0, damping=0.005, n_modes=2)
CROWD = hsi.moving_crowd(LONG, hsi.Traffic([
    hsi.Walker(force=STEADY, step_frequency=2.0, speed=1.0, arrival=arrival) for arrival in (0.0, 10.0)]))
MOVED = ct.TimeResponseData(     # z₁ = 0.01 t, z₂ = −0.03 t, and an acceleration with its peak at 30 s
    np.linspace(0.0, 60.0, 601), 5.0 - 0.1 * abs(np.linspace(0.0, 60.0, 601) - 30.0),
    np.outer([0.01, -0.03, 0.0, 0.0], np.linspace(0.0, 60.0, 601)), issiso=True)


class Watcher(AbstractMovieWriter):
    """Keeps what is drawn, by the title of the line, from picture to picture."""

    def setup(self, fig, outfile, dpi=None):
        self.fig, self.seen, self.outfile, self.dpi = fig, [], outfile, dpi

    def grab_frame(self, **words):
        deck, history = self.fig.axes
        self.seen.append({"title": deck.get_title("left"), "past": history.lines[0].get_data(),
                          **{line.get_label(): line.get_data() for line in deck.lines}})

    def finish(self):
        pass


def watched(**words) -> list[dict]:
    watcher = Watcher(fps=25)
    crossing_animation(CROWD, MOVED, **words).save("nowhere.gif", writer=watcher)
    return watcher.seen


def test_the_deck_is_the_sum_of_its_modes_downwards() -> None:
    """At 35.04 s, by hand: m = 20 t of both modes, w = (0.3504 sin πx/L − 1.0512 sin 2πx/L)/√20000 m."""
    picture = watched(span=(35.0, 35.2))[1]
    x, w = picture["deck"]
    by_hand = 1e3 * (0.3504 * np.sin(np.pi * x / 40.0) - 1.0512 * np.sin(2 * np.pi * x / 40.0)) / np.sqrt(20e3)
    np.testing.assert_allclose(w, by_hand, atol=1e-9)
    assert picture["title"] == "35.04 s, 2 on the deck"
    ax, _ = plt.gcf().axes
    assert ax.get_ylim()[0] > 0 > ax.get_ylim()[1]     # positive downwards
    assert ax.get_ylabel() == "Deflection [mm]"


def test_walkers_ride_on_the_deck() -> None:
    """One has left after 40 s; the other is at 1 m/s · (t − 10 s)."""
    pictures = watched(span=(39.0, 41.0))
    for picture, places in ((pictures[0], [39.0, 29.0]), (pictures[-1], [31.0])):
        x, w = picture["people"]
        assert x == pytest.approx(places)
        np.testing.assert_allclose(w, np.interp(x, *picture["deck"]), rtol=1e-2)


def test_the_acceleration_is_drawn_up_to_now() -> None:
    for i, picture in enumerate(watched(span=(20.0, 21.0))):
        time, signal = picture["past"]
        assert time[-1] == pytest.approx(20.0 + i / 25)
        assert np.all(np.diff(time) > 0)
        np.testing.assert_allclose(signal, 2.0 + 0.1 * time, rtol=1e-9)    # 5 − 0.1 (30 − t)


def test_the_stated_factor_is_that_of_the_picture() -> None:
    crossing_animation(CROWD, MOVED, span=(20.0, 20.2)).save("nowhere.gif", writer=Watcher(fps=25))
    ax = plt.gcf().axes[0]
    factor = float(ax.get_title("right").removeprefix("deflection × ").replace(" ", ""))
    (x0, y0), (x1, y1) = ax.transData.transform([(0.0, 0.0), (1.0, 1000.0)])    # 1 m along, 1 m down
    assert (y0 - y1) / (x1 - x0) == pytest.approx(factor, rel=1e-3)
    largest = 20.2 * np.max(abs(0.01 * np.sin(np.linspace(0, np.pi, 999))
                                - 0.03 * np.sin(np.linspace(0, 2 * np.pi, 999)))) / np.sqrt(20e3)
    assert 0.03 <= factor * largest / 40.0 <= 0.08


def test_eight_seconds_about_the_peak_are_shown() -> None:
    pictures = watched(rate=1.0)
    assert [picture["title"].split()[0] for picture in pictures] == [f"{time}.00" for time in range(26, 35)]


@pytest.mark.parametrize(("peak", "span"), [(1.0, (0.0, 8.0)), (59.0, (52.0, 60.0))])
def test_a_peak_near_an_end_shows_the_eight_seconds_there(peak: float, span: tuple[float, float]) -> None:
    late = ct.TimeResponseData(MOVED.time, np.exp(-abs(MOVED.time - peak)), MOVED.x, issiso=True)
    watcher = Watcher(fps=1)
    crossing_animation(CROWD, late, rate=1.0).save("nowhere.gif", writer=watcher)
    assert [float(one["title"].split()[0]) for one in watcher.seen] == np.arange(span[0], span[1] + 1).tolist()


def test_supports_stand_where_the_spans_meet() -> None:
    spans = hsi.Footbridge.beam(spans=[20.0, 30.0], width=3.0, mass=50e3, frequency=2.0, damping=0.005)
    crowd = hsi.moving_crowd(spans, CROWD.traffic)
    response = ct.TimeResponseData(MOVED.time, MOVED.outputs, np.zeros((2, 601)), issiso=True)
    crossing_animation(crowd, response, span=(0.0, 0.1)).save("nowhere.gif", writer=Watcher(fps=25))
    supports = next(line for line in plt.gcf().axes[0].lines if line.get_marker() not in ("None", "o", None))
    assert supports.get_xdata().tolist() == [0.0, 20.0, 50.0]


def test_words_and_panels_of_an_animation_do_not_meet() -> None:
    boxes = []

    class Boxes(Watcher):
        def grab_frame(self, **words):
            boxes.append([ax.get_tightbbox() for ax in self.fig.axes])
            assert not isinstance(self.fig.get_layout_engine(), ConstrainedLayoutEngine)
            ax = self.fig.axes[0]
            assert not ax._left_title.get_window_extent().overlaps(ax._right_title.get_window_extent())
            assert all(self.fig.bbox.count_contains(box.corners()) == 4 for box in boxes[-1])
    crossing_animation(CROWD, MOVED, span=(39.9, 40.1)).save("nowhere.gif", writer=Boxes(fps=25))
    assert len(boxes) == 6
    assert not any(deck.overlaps(history) for deck, history in boxes)


def test_a_gif_holds_every_picture_in_real_time(tmp_path: Path) -> None:
    seen = []
    animation = crossing_animation(CROWD, MOVED, span=(20.0, 20.4))
    save_animation(animation, tmp_path / "a.gif", after_each=lambda *count: seen.append(count))
    with Image.open(tmp_path / "a.gif") as image:
        assert (image.n_frames, image.info["duration"]) == (11, 40)
    assert seen == [(i, 11) for i in range(11)]


def test_a_simulation_is_animated_as_it_comes(tmp_path: Path) -> None:
    found = hsi.simulate(CROWD).response
    watcher = Watcher(fps=25)
    crossing_animation(CROWD, found, span=(20.0, 20.1)).save("nowhere.gif", writer=watcher)
    at_first = int(np.searchsorted(found.time, 20.0))
    x, w = watcher.seen[0]["deck"]
    np.testing.assert_allclose(w, 1e3 * LONG.participation(x) @ found.x[:2, at_first], rtol=0.02, atol=1e-3)


def test_animation_refusals(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"response must hold z and dz of 2 mode\(s\), .* got none; give simulate"):
        crossing_animation(CROWD, RECORDS[0])
    with pytest.raises(ValueError, match=r"states of shape \(4, 601\), got \(2, 601\); give simulate"):
        crossing_animation(CROWD, ct.TimeResponseData(MOVED.time, MOVED.outputs, np.zeros((2, 601)), issiso=True))
    with pytest.raises(ValueError, match=r"span must be \(start, end\) within 0 to 60 s, got \(50.0, 61.0\); choose"):
        crossing_animation(CROWD, MOVED, span=(50.0, 61.0))
    for span, samples in (((20.001, 20.002), 0), ((20.05, 20.15), 1)):
        with pytest.raises(ValueError, match=rf"span must hold at least two samples.*, got {samples} from 20.*; widen"):
            crossing_animation(CROWD, MOVED, span=span)
    with pytest.raises(ValueError, match="rate must be above 0, got 0; give pictures per second"):
        crossing_animation(CROWD, MOVED, rate=0)
    with pytest.raises(TypeError, match="crowd must be of type MovingCrowd, got Footbridge; make it"):
        crossing_animation(LONG, MOVED)
    assert plt.get_fignums() == []
    animation = crossing_animation(CROWD, MOVED, span=(0.0, 0.1))
    with pytest.raises(ValueError, match=r"ending of the file must be one of 'gif'.*, got 'doc'; choose one"):
        save_animation(animation, tmp_path / "a.doc")
    save_animation(animation, tmp_path / "a.gif")
    assert plt.get_fignums() == []
    with pytest.raises(TypeError, match="figure of ax must be of type Figure, got SubFigure; make it"):
        crossing_animation(CROWD, MOVED, ax=plt.figure().subfigures().subplots(2))


# files

@pytest.mark.parametrize("kind", [str, Path])
def test_files_are_named_by_words_or_paths(kind: type, tmp_path: Path) -> None:
    save(persons_plot(TIME, PERSONS), kind(tmp_path / "a.png"))
    save_animation(crossing_animation(CROWD, MOVED, span=(0.0, 0.1)), kind(tmp_path / "a.gif"))
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.gif", "a.png"]
    assert plt.get_fignums() == []


@pytest.mark.parametrize("write", [save, save_animation])
def test_files_without_a_name_are_refused(write: Callable) -> None:
    with pytest.raises(TypeError, match="path must be of type str or PathLike, got int; give the name of a file"):
        write(persons_plot(TIME, PERSONS), 3)


# bars

BARS = {"sparse": {"MF": [2.0, 1.9, 2.2], "PMC": [1.0, 0.9, 1.1]},
        "dense": {"MF": [8.0, 7.0, 9.5], "PMC": [1.5, 1.2, 1.6]}}


def test_bars_are_as_high_as_estimates_and_their_intervals_as_long() -> None:
    plot = bars_plot({"2 Hz": BARS, "5 Hz": BARS}, columns=2)
    for ax, lines in zip(plot.axes.flat, plot.lines.flat, strict=True):
        assert [patch.get_height() for patch in ax.patches] == [2.0, 8.0, 1.0, 1.5]
        for i, (name, line) in enumerate(zip(("MF", "PMC"), lines, strict=True)):
            x, y = line.get_xdata().reshape(2, 3), line.get_ydata().reshape(2, 3)
            np.testing.assert_array_equal(y[:, :2], [BARS[group][name][1:] for group in BARS])
            assert np.all(np.isnan(y[:, 2]))
            centres = [patch.get_x() + patch.get_width() / 2 for patch in ax.patches[2 * i:2 * i + 2]]
            assert x[:, 0] == pytest.approx(centres)
    assert plot.axes[0, 0].get_ylabel() == "Peak acceleration [m/s²]"
    assert [tick.get_text() for tick in plot.axes[0, 0].get_xticklabels()] == ["sparse", "dense"]


def test_bars_of_a_group_touch_but_do_not_overlap() -> None:
    first, _, second, _ = bars_plot({"2 Hz": BARS}).axes[0, 0].patches
    assert first.get_x() + first.get_width() == pytest.approx(second.get_x())
    assert (to_hex(first.get_facecolor()), to_hex(second.get_facecolor())) == ("#595959", "#ffffff")


def test_bars_have_one_legend_that_covers_no_panel() -> None:
    plot = bars_plot({"2 Hz": BARS, "5 Hz": BARS, "a": BARS, "b": BARS}, columns=2)
    plot.figure.canvas.draw()
    assert entries(plot) == ["MF", "PMC", "95 % interval"]
    box = plot.legend[0, 0].get_window_extent()
    assert not any(box.overlaps(ax.get_tightbbox()) for ax in plot.axes.flat)
    assert [ax.get_title("left") for ax in plot.axes.flat] == ["(a) 2 Hz", "(b) 5 Hz", "(c) a", "(d) b"]


def test_bars_on_given_axes_make_no_figure() -> None:
    figure, axes = plt.subplots(1, 2)
    assert bars_plot({"2 Hz": BARS, "5 Hz": BARS}, columns=2, ax=axes).figure is figure
    assert plt.get_fignums() == [figure.number]


def test_bars_that_do_not_fit_are_refused() -> None:
    with pytest.raises(ValueError, match=r"panels must fill their rows, got 3 in 2 columns; give a divisor of 3"):
        bars_plot({"a": BARS, "b": BARS, "c": BARS}, columns=2)
    with pytest.raises(ValueError, match=r"every group must hold the same bars, got .*; give all alike"):
        bars_plot({"a": {**BARS, "odd": {"MF": [1.0, 0.9, 1.1]}}})
    with pytest.raises(ValueError, match=r"panels\['a'\]\['one'\]\['MF'\] must hold 3 numbers, got 2; give estimate"):
        bars_plot({"a": {"one": {"MF": [1.0, 0.9]}}})


@pytest.mark.parametrize(("panels", "kind", "refusal"), [
    ({}, ValueError, r"panels must hold at least one panel, got none; give \{title"),
    ({"a": BARS, "b": {}}, ValueError, r"panels\['b'\] must hold at least one group, got none; give \{group"),
    ({"a": {"g": {}}}, ValueError, r"panels\['a'\]\['g'\] must hold at least one bar, got none; give \{bar"),
    ([1, 2], TypeError, r"panels must be of type Mapping, got list; give \{title"),
    ({"a": 1}, TypeError, r"panels\['a'\] must be of type Mapping, got int; give \{group"),
    ({"a": {"g": [1.0]}}, TypeError, r"panels\['a'\]\['g'\] must be of type Mapping, got list; give \{bar")])
def test_bars_that_are_missing_are_refused(panels: object, kind: type, refusal: str) -> None:
    with pytest.raises(kind, match=refusal):
        bars_plot(panels)
    assert plt.get_fignums() == []
