"""``hsictrl simulate``: one crowd crosses the bridge, by the moving crowd model."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.table import Table

from hsictrl import _checks as check
from hsictrl import assessment
from hsictrl._digits import significant
from hsictrl.cli import options, tables
from hsictrl.cli.crossing import Crossing
from hsictrl.cli.description import Description
from hsictrl.cli.endings import failing, refusing
from hsictrl.cli.files import checked_animation, checked_figure, whole_file
from hsictrl.cli.outcome import Outcome, Rows, one_form
from hsictrl.cli.tables import Column

DENSITY = 1.0   # persons/m², where neither a file nor an option says


def simulate(
    file: options.File = None,
    frequency: options.Frequency = None,
    damping: options.Damping = None,
    modal_mass: options.ModalMass = None,
    density: options.Density = None,
    seed: options.Seed = None,
    trial: Annotated[int, typer.Option(
        metavar="WHOLE", help="Which trial of a study with this seed: the same traffic, the same digits.")] = 0,
    figure: Annotated[Path | None, typer.Option(
        metavar="FILE", help="Draw the acceleration, its spectrum, and how many people are on the deck.")] = None,
    animate: Annotated[Path | None, typer.Option(
        metavar="FILE", help="Show the eight seconds about the peak in motion: .gif, or .mp4 where ffmpeg is "
                             "installed.")] = None,
    as_json: options.AsJson = False,
    as_csv: options.AsCsv = False,
) -> None:
    """One crowd crosses the bridge, by the moving crowd model (MC).

    Bodies and forces walk; step frequencies are tuned to the bridge with a standing crowd, as in a study.

    FILE, with one density or number of persons, and exit codes are those of 'hsictrl assess'.
    """
    with refusing():
        density = [DENSITY] if file is None and not density else density
        case = _one_flow(options.described(file, frequency=frequency, damping=damping, modal_mass=modal_mass,
                                           density=density, seed=seed))
        check.whole("trial", trial, least=0, remedy="count trials from 0")
        one_form(as_json, as_csv)
        _check_files(figure, animate)
        assessment.check_assessable(case.bridge, case.flows[0])
    with failing():
        crossing = Crossing.of(case, trial)
    _draw(crossing, figure, animate)
    rows = [crossing.row()]
    Outcome(description=case, settings={"model": "MC", "trial": trial}, rows=rows, table=_table(rows),
            notes=_notes(crossing)).show(as_json=as_json, as_csv=as_csv)


def _one_flow(case: Description) -> Description:
    if len(case.flows) != 1:
        raise ValueError(f"simulate takes one density, got {len(case.flows)}: {', '.join(map(str, case.flows))}; "
                         f"give one, such as --density {DENSITY:.1f}")
    return case


def _check_files(figure: Path | None, animation: Path | None) -> None:
    for path, checked in ((figure, checked_figure), (animation, checked_animation)):
        if path is not None:
            checked(path)
    if figure is not None and animation is not None and figure.resolve() == animation.resolve():
        raise ValueError(f"figure and animation must be two files, got {figure} for both; rename one")


def _draw(crossing: Crossing, figure: Path | None, animation: Path | None) -> None:
    if figure is not None:
        from hsictrl.cli.figure import draw_crossing  # only now: it loads matplotlib

        with whole_file(figure) as draft:
            draw_crossing(draft, crossing)
    if animation is not None:
        from hsictrl.cli.figure import animate_crossing

        with whole_file(animation) as draft:
            animate_crossing(draft, crossing)


def _table(rows: Rows) -> Table:
    return tables.table([
        tables.FLOW,
        Column("n_H", "[-]", lambda row: significant(row["persons_on_deck_mean"])),
        Column("T", "[s]", lambda row: significant(row["crossing_s"])),
        Column("f_l", "[Hz]", lambda row: significant(row["step_frequency_hz"], 4)),
        Column("f_eff", "[Hz]", lambda row: significant(row["f_eff_hz"], 4)),
        Column("ξ_eff", "[%]", lambda row: significant(100 * row["xi_eff"])),
        Column("peak", "[m/s²]", lambda row: f"{significant(row['a_mc_m_per_s2'])}\nat {row['peak_at_s']:.1f} s"),
        Column("RMS", "[m/s²]", lambda row: significant(row["rms_m_per_s2"])),
        Column("comfort", "", lambda row: row["class_mc"]),
        Column("error", "[-]", lambda row: f"{row['error']:.0e}"),
        Column("step", "[ms]", lambda row: significant(1e3 * row["step_s"])),
    ], rows)


def _notes(crossing: Crossing) -> list[str]:
    tuned = crossing.case.flows[0].step_frequency is None
    return [
        *tables.case_notes(crossing.case),
        f"MC: bodies and forces walk. Trial {crossing.trial}. n_H: mean number of people on the deck while it is "
        "observed, for the time T of one crossing.",
        f"f_l: mean step frequency, {'tuned to f_eff or a part of it' if tuned else 'as described'}. f_eff, ξ_eff: of "
        "the bridge with the standing crowd of this trial.",
        "peak, RMS: largest acceleration at the antinode of the first mode, and largest running 1-s RMS. error: "
        "estimate, of the peak.",
        *(f"Remark: {remark}." for remark in crossing.prediction.remarks)]
