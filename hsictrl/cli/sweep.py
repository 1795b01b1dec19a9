"""``hsictrl sweep``: design accelerations over bridges, crowds, forces and models."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.table import Table

from hsictrl import __version__, study
from hsictrl import _checks as check
from hsictrl.cli import options, tables
from hsictrl.cli.endings import failing, refusing
from hsictrl.cli.files import checked_folder, checked_ledger, whole_file
from hsictrl.cli.outcome import Rows, bridge_document, json_text, print_json, print_table
from hsictrl.cli.study import PAIR, Study, read_study
from hsictrl.cli.tables import Column, estimate
from hsictrl.cli.workers import checked_processes, workers
from hsictrl.study import Estimates, PercentileRule, Sweep

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
    ratio = found.ratio("model", *PAIR) if {*PAIR} <= {*asked.model} else None
    document = {"bridge": bridge_document(asked.case.bridge), "settings": _settings(asked, rule, max_trials),
                "rows": list(_rows(asked, found, ratio))}
    _write(folder / file.stem, document, found, ratio)
    if as_json:
        print_json(document)
    else:
        print_table(_table(asked, rule, document["rows"]), _notes(asked, rule, found))


def _seeded(asked: Study, seed: int | None) -> Study:
    """The same study with the seed of an option, if there is one."""
    asked = asked if seed is None else replace(asked, case=replace(asked.case, seed=seed))
    if asked.case.seed > LARGEST_SEED:
        raise ValueError(f"seed must be at most {LARGEST_SEED}, got {asked.case.seed}; a netCDF file holds no larger one")
    return asked


def _name(rule: PercentileRule) -> str:
    return f"a{rule.percentile:g}".replace(".", "_")


def _settings(asked: Study, rule: PercentileRule, max_trials: int) -> dict[str, Any]:
    return {"percentile": rule.percentile, "tolerance": rule.tolerance, "confidence": rule.confidence,
            "max_trials": max_trials, "seed": asked.case.seed,
            "forces": {name: repr(force) for name, force in asked.forces.items()},
            "flows": list(map(repr, asked.case.flows)), "hsictrl": __version__}


def _rows(asked: Study, found: Sweep, ratio: Estimates | None) -> Iterator[dict[str, Any]]:
    """A row per bridge, crowd and force, with a peak per model."""
    whole = found.at({})
    for cell, ensemble in zip(product(*asked.cells.values()), found.ensembles, strict=True):
        for shared in product(asked.modal_mass, asked.damping):
            density, frequency, force, modal_mass, damping = *cell, *shared
            point = {"density": density, "frequency": frequency, "force": force, "modal_mass": modal_mass,
                     "damping": damping}
            row = {"density_per_m2": density, "persons": asked.flows[density].persons_on(asked.case.bridge),
                   "frequency_hz": frequency, "force": force, "modal_mass_kg": modal_mass, "damping": damping}
            for model in asked.model:
                row |= _quantity(f"a_{model.lower()}", "_m_per_s2", whole.at({**point, "model": model}))
            row |= {} if ratio is None else _quantity("r_hsi", "", ratio.at(point))
            yield row | {"trials": ensemble.n_trials, "converged": ensemble.converged}


def _quantity(name: str, unit: str, found: Estimates) -> dict[str, float]:
    parts = {"": found.estimate, "_low": found.low, "_high": found.high}
    return {f"{name}{part}{unit}": float(value) for part, value in parts.items()}


def _write(stem: Path, document: dict[str, Any], found: Sweep, ratio: Estimates | None) -> None:
    with whole_file(stem.with_name(f"{stem.name}.json")) as draft:
        draft.write_text(json_text(document) + "\n", encoding="utf-8")
    _write_dataset(stem.with_name(f"{stem.name}.nc"), found, ratio)
    if min(len(found.axes[name]) for name in ("frequency", "modal_mass")) > 1:
        _draw(stem, found, ratio)


def _write_dataset(path: Path, found: Sweep, ratio: Estimates | None) -> None:
    try:
        data = found.to_xarray()
    except ImportError as error:
        typer.echo(f"Remark: {path} was not written: {error}", err=True)
        return
    if ratio is not None:
        data = data.assign({f"r_hsi{part}": (list(ratio.axes), values) for part, values in (
            ("", ratio.estimate), ("_low", ratio.low), ("_high", ratio.high))})
    with whole_file(path) as draft:
        data.to_netcdf(draft)


def _draw(stem: Path, found: Sweep, ratio: Estimates | None) -> None:
    from hsictrl.cli.figure import draw_maps  # only now: it loads matplotlib

    model = "PMC" if "PMC" in found.axes["model"] else str(found.axes["model"][-1])
    with whole_file(stem.with_name(f"{stem.name}.png")) as draft:
        draw_maps(draft, found.at({"model": model}), f"$a_{{{found.name[1:].replace('_', '.')}}}$ {model} [m/s²]")
    if ratio is not None:
        with whole_file(stem.with_name(f"{stem.name}_r_hsi.png")) as draft:
            draw_maps(draft, ratio, r"$R_\mathrm{HSI}$ [-]")


def _table(asked: Study, rule: PercentileRule, rows: Rows) -> Table:
    axes = {
        "density": tables.FLOW,
        "frequency": Column("f_B", "[Hz]", lambda row: f"{row['frequency_hz']:.4g}"),
        "force": Column("force", "", lambda row: row["force"], "left"),
        "modal_mass": Column("m_B", "[t]", lambda row: f"{row['modal_mass_kg'] / 1e3:.4g}"),
        "damping": Column("ξ_B", "[%]", lambda row: f"{100 * row['damping']:.3g}")}
    sizes = {name: len(values) for name, values in {**asked.cells, **asked.shared}.items()}
    accelerations = [Column(f"a{rule.percentile:g} {model}", "[m/s²]", estimate(f"a_{model.lower()}", unit="_m_per_s2"))
                     for model in asked.model]
    reduction = [Column("R_HSI", "[-]", estimate("r_hsi"))] if "r_hsi" in rows[0] else []
    count = Column("trials", "settled", lambda row: f"{row['trials']}\n{'yes' if row['converged'] else 'no'}")
    return tables.table([*(column for name, column in axes.items() if sizes[name] > 1), *accelerations, *reduction,
                         count], rows)


def _notes(asked: Study, rule: PercentileRule, found: Sweep) -> list[str]:
    left = int((~found.converged).sum())
    return [
        f"Deck: {asked.case.bridge.length:g} m × {asked.case.bridge.width:g} m. {_fixed(asked)}Seed: {asked.case.seed}.",
        *(f"Force {name}: {force}." for name, force in asked.forces.items()),
        f"a{rule.percentile:g}: percentile {rule.percentile:g} of the peak acceleration. R_HSI: that of MF over that of "
        "PMC (eq. 18).",
        f"Below an estimate: its {100 * rule.confidence:g} % interval. Trials of a row settle when all intervals lie "
        f"within ±{100 * rule.tolerance:g} %.",
        *([f"Remark: {left} of {found.converged.size} studies have not settled; give more --max-trials and --resume."]
          if left else [])]


def _fixed(asked: Study) -> str:
    """What has one value, and no column."""
    density, flow = next(iter(asked.flows.items()))
    words = {"density": f"d = {density:.3g} /m² (n={flow.persons_on(asked.case.bridge)})",
             "frequency": f"f_B = {asked.frequency[0]:g} Hz", "modal_mass": f"m_B = {asked.modal_mass[0] / 1e3:g} t",
             "damping": f"ξ_B = {100 * asked.damping[0]:g} %"}
    axes = {**asked.cells, **asked.shared}
    told = [word for name, word in words.items() if len(axes[name]) == 1]
    return f"{', '.join(told)}. " if told else ""
