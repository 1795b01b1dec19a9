"""The page as a browser reads it, and the numbers of the objects that it was made from."""

import base64
import datetime
import re
from dataclasses import replace
from html.parser import HTMLParser
from importlib import metadata
from xml.etree import ElementTree

import numpy as np
import pytest

import hsictrl as hsi
from hsictrl import plots
from hsictrl.report import report_page

EVIL = '<script>alert("1 & 2")</script> \'quoted\' </code></pre> {{ 7 * 7 }}'
VOID = {"meta", "img", "link", "br", "hr", "input"}
DAY = datetime.date(2024, 2, 29)
BRIDGE = hsi.Footbridge.beam(spans=[30.0, 24.0], width=3.0, mass=81e3, frequency=2.0, damping=0.01, n_modes=2)


class Page(HTMLParser):
    """Every element with its attributes and its text; refuses what is not closed in order."""

    def __init__(self, text: str) -> None:
        super().__init__(convert_charrefs=True)
        self.elements, self._open = [], []
        self.feed(text)
        self.close()
        assert self._open == []

    def handle_starttag(self, tag, attrs):
        one = {"tag": tag, "in": [each["tag"] for each in self._open], "text": "", **dict(attrs)}
        self.elements.append(one)
        if tag not in VOID:
            self._open.append(one)

    def handle_endtag(self, tag):
        assert self._open.pop()["tag"] == tag

    def handle_data(self, data):
        for one in self._open:
            one["text"] += data

    def all(self, tag):
        return [one for one in self.elements if one["tag"] == tag]

    def text(self):
        return " ".join(self.all("body")[0]["text"].split())


@pytest.fixture(scope="module")
def found():
    return [hsi.assess(BRIDGE, flow, force=hsi.YoungForce(), goal="CL1",
                       rule=hsi.PercentileRule(percentile=90.0, tolerance=0.5))
            for flow in (hsi.CrowdFlow(traffic_class="TC1"), hsi.CrowdFlow(persons=4))]


@pytest.fixture(scope="module")
def written(found):
    return report_page(found, title=EVIL, description=EVIL, command=EVIL, date=DAY)


@pytest.fixture(scope="module")
def page(written):
    return Page(written)


def test_the_page_stands_alone(written, page):
    """Nothing is fetched: no script, no link, no address; styles and pictures are inside."""
    assert {one["tag"] for one in page.elements}.isdisjoint({"script", "link", "iframe", "object", "base", "form", "a"})
    for one in page.elements:
        assert {"href", "srcset", "action", "poster", "data", "style"}.isdisjoint(one)
        assert not [name for name in one if name.startswith("on")]
        assert one.get("src", "data:").startswith("data:")
    assert not re.search(r"url\(|@import|https?:|file:", written)
    policy, = (one["content"] for one in page.all("meta") if "http-equiv" in one)
    assert policy == "default-src 'none'; img-src data:; style-src 'unsafe-inline'"


def test_every_picture_is_whole_and_says_what_it_shows(page):
    pictures = page.all("img")
    assert len(pictures) == 4
    for one in pictures:
        assert len(one["alt"]) > 20
        kind, drawn = one["src"].split(",")
        assert kind == "data:image/svg+xml;base64"
        root = ElementTree.fromstring(base64.b64decode(drawn))
        assert root.tag == "{http://www.w3.org/2000/svg}svg"
        links = [value for each in root.iter() for name, value in each.attrib.items() if name.endswith("href")]
        assert all(link.startswith("#") for link in links)


def test_what_was_written_is_quoted_and_not_run(page):
    assert page.all("title")[0]["text"] == page.all("h1")[0]["text"] == EVIL
    assert [one["text"] for one in page.all("code")] == [EVIL, EVIL]


def test_a_reader_of_any_kind_finds_the_way(page):
    assert page.all("html")[0]["lang"] == "en"
    assert [one["content"] for one in page.all("meta") if one.get("name") == "viewport"] == [
        "width=device-width, initial-scale=1"]
    titles = [one["text"] for one in page.all("h2")]
    assert titles[0] == "Answer"
    assert [one["aria-labelledby"] for one in page.all("section")] == [one["id"] for one in page.all("h2")]
    tables, heads = page.all("table"), page.all("th")
    assert len(tables) == len(page.all("caption")) == len(page.all("thead"))
    assert all(one["text"] and one["scope"] in ("col", "row") for one in heads)
    rows = [one for one in page.all("tr") if "tbody" in one["in"]]
    assert sum(one["scope"] == "row" for one in heads) == len(rows)
    for one in page.all("div"):
        assert (one["class"], one["role"], one["tabindex"]) == ("scroll", "region", "0")


def test_numbers_are_those_of_the_assessments(found, page):
    text = page.text()
    for one in found:
        for ensemble in (one.mf, one.pmc):
            low, high = ensemble.interval
            assert f"{ensemble.estimate:#.3g}{low:#.3g}–{high:#.3g}{ensemble.n_trials} trials" in text
        frequency, damping = np.ravel(one.effective.estimate)
        assert f"{frequency:#.4g}" in text
        assert f"{100 * damping:#.3g}" in text
        for case in one.guides:
            assert f"{case.response.acceleration:#.3g} {case.response.comfort_class}" in text
        assert " → ".join(one.classes) in text
        assert " → ".join(one.verdicts) + "goal CL1" in text
        assert f"CL1 under {one.flow}: {one.verdicts[1]}" in text
        assert all(remark in text for remark in one.remarks)


def test_simulated_accelerations_stand_beside_the_guides_of_the_mode_in_resonance_alone(found, page):
    table, = (one for one in page.all("table") if "by the guides" in one["text"])
    rows = [" ".join(row.split()) for row in re.split(r"(?=TC1, 15|4 persons)", table["text"])[1:]]
    assert len(rows) == 4        # two flows, two critical modes
    for row, (one, mode) in zip(rows, ((one, mode) for one in found for mode in (0, 1)), strict=True):
        assert f"{mode}, vertical" in row
        assert (f"{one.pmc.estimate:#.3g}" in row) == (mode == 0)
        assert row.endswith("– –") == (mode == 1)


def test_the_answer_is_of_the_largest_acceleration(found, page):
    largest = max(found, key=lambda one: one.pmc.estimate)
    low, high = largest.pmc.interval
    said = page.all("p")[1]["text"]
    assert said.startswith(
        f"Under {largest.flow}, percentile 90 of the peak acceleration is {largest.pmc.estimate:#.3g} m/s² (95 % "
        f"interval {low:#.3g} to {high:#.3g}; {largest.pmc.n_trials} trials) with human-structure interaction: comfort "
        f"class {largest.classes[1]}.")


def test_inputs_modes_assumptions_and_versions_are_told(page):
    text = page.text()
    for words in ("54 m × 3 m", "81000 kg", "YoungForce(values='mean')", "in resonance, critical by a guide",
                  f"{BRIDGE.modes[1].frequency:#.4g}", "Mode 0 (2.000 Hz) is the one in resonance: steps are tuned",
                  "3.25 ± 0.32 Hz, 30 ± 5 %, 70 kg, 95 % sprung", "±50 %", "15 persons", "0.5 to below 1",
                  "more than 5 % of the modal mass", "SeedSequence(1, spawn_key=(i,))", "at most 2.5 Hz",
                  f"hsictrl {hsi.__version__}", f"numpy {metadata.version('numpy')}", "Python", "Platform"):
        assert words in text, words


def test_the_rest_of_a_page_depends_on_the_assessments_alone(found, written):
    again = report_page(found, title=EVIL, description=EVIL, command=EVIL, date=DAY)
    assert again == written
    later = report_page(found, title=EVIL, description=EVIL, command=EVIL, date=datetime.date(2025, 1, 1))
    assert later.replace("2025-01-01", "2024-02-29") == written


def test_without_goals_there_is_no_column_for_them(found):
    plain = Page(report_page([replace(found[0], goal=None)], title="t"))
    assert "Goal" not in " ".join(one["text"] for one in plain.all("th"))
    assert "Goals" not in plain.text()
    assert len(plain.all("code")) == 0
    assert plain.all("time")[0]["text"] == datetime.date.today().isoformat()


def test_absorbers_are_among_the_inputs_and_in_the_empty_bridge(monkeypatch):
    """With an absorber the empty bridge has two peaks, neither at 2 Hz nor 1 % high."""
    damped = BRIDGE.with_absorbers(hsi.Absorber(mass=800.0, frequency=1.95, damping=0.09), at=[15.0])
    one = hsi.assess(damped, hsi.CrowdFlow(persons=15), force=hsi.YoungForce(), rule=hsi.PercentileRule(tolerance=0.9))
    drawn, draw = [], plots.modes_plot
    monkeypatch.setattr(plots, "modes_plot", lambda bridge, places: drawn.append(places) or draw(bridge, places))
    text = Page(report_page([one], title="t")).text()
    assert {name: len(places) for name, places in drawn[0].items()} == {"standing crowd of trial 0": 15, "absorbers": 1}
    alone = hsi.effective(hsi.couple(damped))
    assert f"empty {alone.frequency:#.4g} {100 * alone.damping:#.3g}" in text
    for words in ("Absorber at (15, 0) m", "800 kg at 1.950 Hz, 9.0 %, vertical", "its highest peak with the absorbers",
                  "effective frequency of the bridge with its absorbers for MF", "empty bridge, without its absorbers"):
        assert words in text, words


def test_refusals(found):
    other = replace(found[1], mode=1)
    for given, kind, says in (
            ([], ValueError, "found must hold at least one"),
            ([1], TypeError, "found must be of type Assessment, got int"),
            (found[0], TypeError, "found must be of type list or tuple"),
            ([found[0], other], ValueError, "found must be of one bridge, one mode and one force, got 4 persons of")):
        with pytest.raises(kind, match=says):
            report_page(given, title="t")
    with pytest.raises(TypeError, match="title must be of type str, got int; give a few words"):
        report_page(found, title=3)


def test_the_same_plot_is_the_same_svg():
    drawn = [plots.svg(plots.frf_plot(hsi.frf(hsi.reference_bridge(), [1.0, 2.0, 3.0])), size=(4.0, 3.0))
             for _ in range(2)]
    assert drawn[0] == drawn[1]
    assert 'width="288pt" height="216pt"' in drawn[0]      # 72 points to the inch
