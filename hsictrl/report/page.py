"""From assessments to a page."""

from __future__ import annotations

import datetime
from collections.abc import Sequence

from jinja2 import Environment, PackageLoader, StrictUndefined

from hsictrl import __version__
from hsictrl import _checks as check
from hsictrl.assessment import Assessment
from hsictrl.report.assumptions import assumptions
from hsictrl.report.pictures import FirstTrial, response_pictures, shapes_picture
from hsictrl.report.sections import Section
from hsictrl.report.tables import (
    answer_table,
    class_tables,
    deck_table,
    effective_table,
    guide_table,
    modes_table,
    traffic_table,
    versions_table,
)
from hsictrl.report.words import answer, resonance


def report_page(
    found: Sequence[Assessment], *, title: str, description: str = "", command: str = "",
    date: datetime.date | None = None,
) -> str:
    """Write assessments of one bridge onto one page that needs nothing else, in HTML.

    Parameters
    ----------
    found : sequence of Assessment
        Of one bridge, one mode and one force; a row each. Pictures are of the one with the largest acceleration.
    title : str
        Title of the page.
    description : str
        What the assessments were described by, quoted.
    command : str
        What makes the page again, quoted.
    date : datetime.date, optional
        Date on the page; today if not given. The rest of the page depends on the assessments and versions alone.

    Returns
    -------
    str
        HTML without scripts or links; text is escaped.

    Raises
    ------
    ValueError
        If there is no assessment, or they are of several bridges, modes or forces.

    Examples
    --------
    >>> import hsictrl as hsi
    >>> found = hsi.assess(hsi.reference_bridge(), hsi.CrowdFlow(traffic_class="TC1"), force=hsi.YoungForce(),
    ...                    rule=hsi.PercentileRule(tolerance=0.5), goal="CL2")
    >>> page = report_page([found], title="A bridge of <50 m")
    >>> "A bridge of &lt;50 m" in page, "<script" in page
    (True, False)
    """
    found = _checked(found)
    largest = max(found, key=lambda one: float(one.pmc.estimate))
    day = datetime.date.today() if date is None else date
    return _ENVIRONMENT.get_template("page.html").render(
        title=check.instance("title", title, str, "give a few words"), date=day.isoformat(), version=__version__,
        bridge=str(found[0].bridge).splitlines()[0], sections=_sections(found, largest, description, command))


def _sections(
    found: tuple[Assessment, ...], largest: Assessment, description: str, command: str,
) -> list[Section]:
    one, first = found[0], FirstTrial.of(largest)
    frequencies, history, settles = response_pictures(largest, first)
    return [
        Section(title="Answer", text=answer(found, largest), tables=[answer_table(found)]),
        Section(title="Inputs", tables=[deck_table(one), traffic_table(found)], quoted=description),
        Section(title="Modes", text=[resonance(one)], tables=[modes_table(found)],
                pictures=[shapes_picture(largest, first)]),
        Section(title="Effective properties", tables=[effective_table(found)], pictures=[frequencies]),
        Section(title="One history", pictures=[history]),
        Section(title="Convergence", pictures=[settles]),
        Section(title="Guides, on every critical mode", tables=[guide_table(found)]),
        Section(title="Classes", tables=class_tables()),
        Section(title="Remarks", points=_remarks(found)),
        Section(title="Assumptions", points=assumptions(largest)),
        Section(title="How this page was made", tables=[versions_table()], quoted=command)]


def _remarks(found: tuple[Assessment, ...]) -> list[str]:
    remarks = [*found[0].bridge.remarks, *(f"{one.flow}: {remark}" for one in found for remark in one.remarks)]
    return [f"{remark}." for remark in remarks] or ["None."]


def _checked(found: Sequence[Assessment]) -> tuple[Assessment, ...]:
    held = check.several("found", found)
    for one in held:
        check.instance("found", one, Assessment, "give what hsictrl.assess returns")
        if (one.bridge, one.mode, one.force) != (held[0].bridge, held[0].mode, held[0].force):
            raise ValueError(f"found must be of one bridge, one mode and one force, got {one.flow} of another; "
                             "write a page for each")
    return held


_ENVIRONMENT = Environment(loader=PackageLoader("hsictrl.report", ""), autoescape=True, undefined=StrictUndefined,
                           trim_blocks=True, lstrip_blocks=True)
