"""Truth: the objects that the same words make in Python, and what a reader of the refusal has to find in the file."""

import re
import textwrap
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import hsictrl as hsi
from hsictrl.cli import description
from hsictrl.cli.description import Description, read_description
from hsictrl.cli.schema import line_of

SIMPLE = 'kind = "simply_supported"\nlength = 50.0\nwidth = 3.0\nmass = 50e3\nfrequency = 3.25\n'


@pytest.fixture
def written(tmp_path):
    def write(text):
        path = tmp_path / "bridge.toml"
        path.write_text(text, encoding="utf-8")
        return path
    return write


def same_bridge(one, other):
    x = np.linspace(0, one.length, 7)
    assert str(one) == str(other)
    np.testing.assert_array_equal(one.participation(x), other.participation(x))


def test_empty_file_is_section_4_2_of_the_paper(written):
    found = read_description(written(""))
    assert [flow.density for flow in found.flows] == [0.2, 0.5, 0.8, 1.0, 1.5]
    assert (found.force, found.seed) == (hsi.ZivanovicForce(), 1)
    same_bridge(found.bridge, hsi.reference_bridge(frequency=2.0, damping=0.005, modal_mass=25e3))


@pytest.mark.parametrize(("text", "bridge"), [
    ('kind = "reference"', hsi.reference_bridge()),
    ('kind = "reference"\nfrequency = 5\ndamping = 0.01\nmodal_mass = 50e3',
     hsi.reference_bridge(frequency=5.0, damping=0.01, modal_mass=50e3)),
    (SIMPLE + "damping = [0.005, 0.01]\nn_modes = 2",
     hsi.Footbridge.simply_supported(length=50.0, width=3.0, mass=50e3, frequency=3.25, damping=[0.005, 0.01],
                                     n_modes=2)),
    ('kind = "beam"\nspans = [20.0, 30.0]\nends = ["clamped", "pinned"]\nwidth = 2\nmass = 6e4\nfrequency = 2.5\n'
     "damping = 0.005\nn_modes = 2",
     hsi.Footbridge.beam(spans=[20.0, 30.0], ends=("clamped", "pinned"), width=2.0, mass=6e4, frequency=2.5,
                         damping=0.005, n_modes=2)),
])
def test_every_kind_of_bridge(written, text, bridge):
    same_bridge(read_description(written("[bridge]\n" + text)).bridge, bridge)


@pytest.mark.parametrize(("text", "force"), [
    ('model = "zivanovic"', hsi.ZivanovicForce()),
    ('model = "zivanovic"\nspacing = 0.05\nscaling = "variance"', hsi.ZivanovicForce(spacing=0.05, scaling="variance")),
    ('model = "young"\nvalues = "design"', hsi.YoungForce(values="design")),
    ('model = "harmonic"\nfactors = [0.43, 0.08]\nphases = [0.0, 1.5]', hsi.HarmonicForce([0.43, 0.08], [0.0, 1.5])),
])
def test_every_force(written, text, force):
    assert read_description(written("[force]\n" + text)).force == force


@pytest.mark.parametrize(("text", "flows"), [
    ("density = 0.3", [hsi.CrowdFlow(density=0.3)]),
    ("density = [0.3, 1]", [hsi.CrowdFlow(density=0.3), hsi.CrowdFlow(density=1)]),
    ("persons = 15", [hsi.CrowdFlow(persons=15)]),
    ("classes = 'TC1'", [hsi.CrowdFlow(traffic_class="TC1")]),
    ("classes = ['TC2', 'TC5']\nweight = 800",
     [hsi.CrowdFlow(traffic_class=name, weight=800) for name in ("TC2", "TC5")]),
    ("persons = [15, 30]\nspeed = 1.2\nstep_frequency = [1.9, 0.1]\nweight = 800",
     [hsi.CrowdFlow(persons=n, speed=1.2, step_frequency=(1.9, 0.1), weight=800) for n in (15, 30)]),
    ("density = 1.0\nstep_frequency = 1.8", [hsi.CrowdFlow(density=1.0, step_frequency=1.8)]),
    ("density = 1.0\n[traffic.population]\nfrequency = [5.7, 0.56]\ndamping = 0.44\nmass = [75, 10]\nsprung_ratio = 1",
     [hsi.CrowdFlow(density=1.0, population=hsi.Population(frequency=(5.7, 0.56), damping=0.44, mass=(75, 10),
                                                           sprung_ratio=1))]),
    ("density = 1.0\npopulation.mass = 80",     # what is left out stays that of walkers
     [hsi.CrowdFlow(density=1.0, population=replace(hsi.Population.walking(), mass=80))]),
    ("density = 1.0\npopulation = {posture = 'upright', mass = 80}",
     [hsi.CrowdFlow(density=1.0, population=replace(hsi.Population.standing(), mass=80))]),
])
def test_every_traffic(written, text, flows):
    assert read_description(written("[traffic]\n" + text)).flows == tuple(flows)


def test_example_at_the_top_of_the_module_runs(written):
    example = textwrap.dedent(description.__doc__.split("::\n\n")[1].split("\n\n====")[0])
    found = read_description(written(example))
    assert [flow.density for flow in found.flows] == [0.2, 0.5]
    assert (str(found.force), found.seed) == ("YoungForce(values='mean')", 1)
    assert found.bridge.modes[0].frequency == 3.25


@pytest.mark.parametrize(("text", "says"), [
    ("seeed = 1", r"line 1, seeed: key must be one of 'bridge', 'traffic', 'force', 'absorbers', 'seed', got 'seeed'"),
    ("seed = 1\n\n[brigde]\nkind = 1", r"line 3, brigde: key must be one of .*, got 'brigde'"),
    ("bridge = 3", r"line 1, bridge: bridge must be a table, got 3; write it like \[name\]"),
    ("[[bridge]]\nkind = 'beam'", r"line 1, bridge: bridge must be a table, got \[\{"),
    ("seed = 1.5", r"line 1, seed: seed must be a whole number, got 1.5; write it like 2"),
    ("seed = true", r"seed must be a whole number, got True"),
    ("seed = -1", r"line 1, seed: seed must be at least 0, got -1; give"),
    ("[bridge]\nfrequency = 2.0", r"line 1, \[bridge\]: kind must be one of 'reference', .*, got None; choose"),
    ("[bridge]\nkind = 'truss'", r"line 2, \[bridge\] kind: kind must be one of .*, got 'truss'"),
    ("[bridge]\nkind = 'reference'\nlength = 50.0",
     r"line 3, \[bridge\] length: key must be one of 'kind', 'frequency', 'damping', 'modal_mass', got 'length'"),
    ("[bridge]\n" + SIMPLE, r"line 1, \[bridge\]: the table must hold 'length', .*, got no 'damping'; add it"),
    ("[bridge]\n" + SIMPLE + "damping = 5",
     r"line 7, \[bridge\] damping: damping must lie in \[0, 1\), got 5; give a fraction, not percent"),
    ("[bridge]\n" + SIMPLE + "damping = -0.005", r"\[bridge\] damping: damping must lie in .*, got -0.005"),
    ("[bridge]\n" + SIMPLE + "damping = nan", r"\[bridge\] damping: damping must lie in .*, got nan"),
    ("[bridge]\n" + SIMPLE + "damping = '0.5 %'",
     r"line 7, \[bridge\] damping: damping must be a number or a list of numbers, got '0.5 %'; write it like"),
    ("[bridge]\n" + SIMPLE + "damping = [0.005, 0.01]", r"damping must be one number or one per mode \(1\)"),
    ("[bridge]\n" + SIMPLE + "damping = 0.005\nn_modes = 0", r"line 8, \[bridge\] n_modes: n_modes must be at least 1"),
    ("[bridge]\n" + SIMPLE + "damping = 0.005\nn_modes = 2.0", r"line 8, .*n_modes must be a whole number, got 2.0"),
    ("[bridge]\nkind = 'beam'\nspans = [20.0, -3.0]\nwidth = 3\nmass = 1e4\nfrequency = 2\ndamping = 0.01",
     r"line 3, \[bridge\] spans: spans\[1\] must be above 0, got -3"),
    ("[bridge]\nkind = 'beam'\nspans = [20]\nends = ['free', 'pinned']\nwidth = 3\nmass = 1e4\nfrequency = 2\n"
     "damping = 0.01", r"line 4, \[bridge\] ends: each of the ends must be one of 'pinned', 'clamped', got 'free'"),
    ("[traffic]\ndensity = 0", r"line 2, \[traffic\] density: density must lie in \(0, 5.4\), got 0; give persons"),
    ("[traffic]\ndensity = 5.4", r"\[traffic\] density: density must lie in \(0, 5.4\), got 5.4"),
    ("[traffic]\ndensity = [0.2, nan]", r"\[traffic\] density: density must lie in \(0, 5.4\), got nan"),
    ("[traffic]\ndensity = []", r"density must be a number or a list of numbers, got \[\]"),
    ("[traffic]\ndensity = 1\npersons = 15",
     r"line 3, \[traffic\] persons: a flow must have one of density, persons, classes, got density and persons;"),
    ("[traffic]\nclasses = ['TC2', 'TC9']",
     r"line 2, \[traffic\] classes: classes must be one of 'TC1', .*, got 'TC9'; choose"),
    ("[traffic]\nclasses = 3", r"line 2, .*classes must be a word in quotes or a list of them, got 3; write it like"),
    ("[traffic]\nclasses = 'TC2'\ndensity = 1", r"a flow must have one of .*, got density and classes; leave out all"),
    ("[traffic]\ngoal = 'CL4'", r"line 2, \[traffic\] goal: goal must be one of 'CL1', 'CL2', 'CL3', got 'CL4'"),
    ("[traffic]\ndensity = [0.1, 0.2, 0.3]\ngoal = ['CL1', 'CL2']",
     r"line 3, \[traffic\] goal: goal must be one for all rows or one per row \(3\), got 2; match them"),
    ("[traffic]\npersons = 1.5", r"line 2, \[traffic\] persons: persons must be a whole number or a list of them"),
    ("[traffic]\ndensity = 0.001", r"density must put at least one person on the deck of 150 m², got 0.001 persons/m²"),
    ("[traffic]\nspeed = -1.0", r"line 2, \[traffic\] speed: speed must lie in \(0, 10\], got -1; give m/s"),
    ("[traffic]\nstep_frequency = [1.9, 0.1, 2]", r"step_frequency must be a number or \[mean, standard deviation\]"),
    ("[traffic]\ndensity = 1\n[traffic.population]\ndirection = 'lateral'",
     r"line 4, \[traffic.population\] direction: key must be one of 'frequency', 'damping', 'mass', 'sprung_ratio'"),
    ("[traffic.population]\ndamping = 30",
     r"line 2, \[traffic.population\] damping: damping must be below 1, got 30; give a fraction, not percent"),
    ("[traffic.population]\nposture = 'seated'", r"line 2, .*posture must be one of 'bent legs', 'upright', got 'seat"),
    ("[traffic.population]\nmass = [75, true]", r"mass must be a number or \[mean, .*, got \[75, True"),
    ("[force]\nmodel = 'harmonic'", r"line 1, \[force\]: the table must hold 'factors', got no 'factors'"),
    ("[force]\nmodel = 'young'\nvalues = 'worst'", r"line 3, \[force\] values: values must be one of 'mean', 'design'"),
    ("[force]\nmodel = 'zivanovic'\nspacing = 0.03", r"line 3, \[force\] spacing: spacing must be 0.01 where scal"),
    ("[bridge]\nkind = \nlength = 2", r"must be TOML in UTF-8, got Invalid value \(at line 2, column 8\); correct"),
    ("seed = 1\nseed = 2", r"must be TOML in UTF-8, got Cannot overwrite a value \(at "),
])
def test_refusals_name_file_line_key_rule_value_and_remedy(written, text, says):
    path = written(text)
    with pytest.raises(ValueError, match=says) as refusal:
        read_description(path)
    assert str(refusal.value).startswith(str(path))
    assert re.search(r"[:;] \w[^;]*; \w", str(refusal.value))     # rule and value; remedy


def test_file_that_is_missing_or_not_text(tmp_path):
    with pytest.raises(ValueError, match=r"nothing.toml: the description must be a file .*got No such file"):
        read_description(tmp_path / "nothing.toml")
    (tmp_path / "latin.toml").write_bytes("# ξ²".encode("utf-16"))
    with pytest.raises(ValueError, match=r"latin.toml: the description must be TOML in UTF-8"):
        read_description(tmp_path / "latin.toml")


LINES = """seed = 1  # mass = 2

 [ bridge ]
# mass = 1
mass = 3
[traffic . population]
'mass' = 4
[[force]]
model.name = "x"
"""


@pytest.mark.parametrize(("names", "line"), [
    (("seed",), 1), (("bridge",), 3), (("bridge", "mass"), 5), (("traffic",), 6), (("traffic", "population"), 6),
    (("traffic", "population", "mass"), 7), (("force",), 8), (("force", "model"), 9), (("mass",), None)])
def test_line_of_a_key(names, line):
    assert line_of(LINES, *names) == line


def test_densities_take_the_place_of_rows_and_keep_the_people():
    heavy = Description(flows=(hsi.CrowdFlow(persons=15, weight=800.0),)).at_densities([0.2, 0.4])
    assert heavy.flows == (hsi.CrowdFlow(density=0.2, weight=800.0), hsi.CrowdFlow(density=0.4, weight=800.0))


@pytest.mark.parametrize(("text", "goals"), [
    ("", [None] * 5), ("[traffic]\ngoal = 'CL2'", ["CL2"] * 5),
    ("[traffic]\npersons = [15, 30]\ngoal = ['CL1', 'CL3']", ["CL1", "CL3"])])
def test_goals_go_with_their_flows(written, text, goals):
    assert [goal for _, goal in read_description(written(text)).aims] == goals


def test_a_goal_stays_when_densities_take_the_place_of_rows_unless_there_are_several():
    flows = tuple(hsi.CrowdFlow(traffic_class=name) for name in ("TC2", "TC3"))
    same = Description(flows=flows, goals=("CL2", "CL2")).at_densities([0.3, 0.4, 0.6])
    assert same.aims == [(hsi.CrowdFlow(density=density), "CL2") for density in (0.3, 0.4, 0.6)]
    with pytest.raises(ValueError, match=r"goal must be one for all densities .*, got CL1, CL2; write one"):
        Description(flows=flows, goals=("CL1", "CL2")).at_densities([0.3])


def test_the_example_of_a_design_has_a_goal_for_each_class():
    example = Path(__file__).parent.parent / "examples" / "design.toml"
    assert [(flow.traffic_class, goal) for flow, goal in read_description(example).aims] == [
        ("TC2", "CL2"), ("TC3", "CL3")]
