"""``hsictrl sweep``: design accelerations over bridges, crowds, forces and models."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from hsictrl import _checks as check
from hsictrl import study
from hsictrl.cli import options
from hsictrl.cli.endings import failing, refusing
from hsictrl.cli.files import checked_folder, checked_ledger, whole_file
from hsictrl.cli.outcome import json_text, print_json, print_table
from hsictrl.cli.study import Study, read_study
from hsictrl.cli.swept import Swept
from hsictrl.cli.workers import checked_processes, workers
from hsictrl.study import PercentileRule

LARGEST_SEED = 2**31 - 1    # of a whole number in a netCDF file
UNITS = {"density": "1/m²", "frequency": "Hz", "modal_mass": "kg"}


def sweep(
    file: Annotated[Path, typer.Argument(
        metavar="STUDY.toml", help="Axes, and what does not vary: bridge, traffic, force and seed.")],
    percentile: options.Percentile = 95.0,
    tolerance: options.Tolerance = 0.05,
    max_trials: Annotated[int, typer.Option(
        metavar="WHOLE", help="Trials after which a cell that has not settled is left.")] = 20_000,
    seed: options.Seed = None,
    processes: options.Processes = 1,
    ledger: Annotated[Path | None, typer.Option(
        "--ledger", metavar="FILE", show_default=False, help="Keep each batch of trials in FILE as it finishes "
                                                             "[default: STUDY.ledger in the output folder].")] = None,
    resume: options.Resume = False,
    output: Annotated[Path, typer.Option(metavar="FOLDER", help="Where the files go.")] = Path(),
    as_json: options.AsJson = False,
) -> None:
    """Design accelerations over bridges, crowds, forces and models.

    A Monte Carlo study for every density, frequency and force. Its trials put one sample of traffic on bridges of
    every modal mass and damping, by every model, so that these are compared under the same people.

    \b
    The description is that of 'hsictrl assess' and a table of axes, any of which may be left out:
        [sweep]
        frequency = [2.0, 3.25]         # Hz
        modal_mass = [20e3, 50e3]       # kg
        damping = [0.002, 0.02]         # fractions
        density = [0.2, 1.0]            # persons/m²
        model = ["MF", "PMC"]           # also "SF", "MFAM", "MC"
        force = ["zivanovic", "young"]

    Writes STUDY.json, STUDY.nc (with xarray) and, over several frequencies and modal masses, maps: STUDY.png and, of
    MF over PMC, STUDY_r_hsi.png. A sweep that was stopped goes on with --resume, to the same digits.

    Exit codes are those of 'hsictrl assess'.
    """
    with refusing():
        asked = _seeded(read_study(file), seed)
        rule = PercentileRule(percentile=percentile, tolerance=tolerance)
        check.whole("max_trials", max_trials, least=1, remedy="give at least one")
        processes, folder = checked_processes(processes), checked_folder(output)
        book = checked_ledger(ledger or folder / f"{file.stem}.ledger", resume)
    with failing(), workers(processes) as executor:
        found = study.sweep(
            asked.trial, asked.cells, shared=asked.shared, name=_name(rule), units={**UNITS, _name(rule): "m/s²"},
            rule=rule, seed=asked.case.seed, executor=executor, max_trials=max_trials, label=file.stem, ledger=book)
    swept = Swept.of(asked, rule, max_trials, found)
    _write(folder / file.stem, swept)
    if as_json:
        print_json(swept.document())
    else:
        print_table(swept.table(), swept.notes())


def _seeded(asked: Study, seed: int | None) -> Study:
    """The same study with the seed of an option, if there is one."""
    asked = asked if seed is None else replace(asked, case=replace(asked.case, seed=seed))
    if asked.case.seed > LARGEST_SEED:
        raise ValueError(f"seed must be at most {LARGEST_SEED}, got {asked.case.seed}; netCDF files hold no larger one")
    return asked


def _name(rule: PercentileRule) -> str:
    return f"a{rule.percentile:g}".replace(".", "_")


def _write(stem: Path, swept: Swept) -> None:
    with whole_file(stem.with_name(f"{stem.name}.json")) as draft:
        draft.write_text(json_text(swept.document()) + "\n", encoding="utf-8")
    _write_dataset(stem.with_name(f"{stem.name}.nc"), swept)
    if min(len(swept.found.axes[name]) for name in ("frequency", "modal_mass")) > 1:
        _draw(stem, swept)


def _write_dataset(path: Path, swept: Swept) -> None:
    try:
        data = swept.dataset()
    except ImportError as error:
        typer.echo(f"Remark: {path} was not written: {error}", err=True)
        return
    with whole_file(path) as draft:
        data.to_netcdf(draft)


def _draw(stem: Path, swept: Swept) -> None:
    from hsictrl.cli.figure import draw_maps  # only now: it loads matplotlib

    models = swept.asked.model
    model = "PMC" if "PMC" in models else models[-1]
    with whole_file(stem.with_name(f"{stem.name}.png")) as draft:
        draw_maps(draft, swept.found.at({"model": model}), f"$a_{{{swept.rule.percentile:g}}}$ {model} [m/s²]")
    if swept.ratio is not None:
        with whole_file(stem.with_name(f"{stem.name}_r_hsi.png")) as draft:
            draw_maps(draft, swept.ratio, r"$R_\mathrm{HSI}$ [-]")
