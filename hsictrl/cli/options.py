"""Words that several commands take."""

from __future__ import annotations

import shlex
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from hsictrl.bridge import reference_bridge
from hsictrl.cli.description import Description, read_description

File = Annotated[Path | None, typer.Argument(
    metavar="FILE.toml", show_default=False, help="Bridge, traffic, force and seed; the reference bridge without.")]
Frequency = Annotated[float | None, typer.Option(
    metavar="HZ", help="Natural frequency of the reference bridge [default: 2.0].")]
Damping = Annotated[float | None, typer.Option(
    metavar="FRACTION", help="Damping ratio of the reference bridge [default: 0.005].")]
ModalMass = Annotated[float | None, typer.Option(
    metavar="KG", help="Modal mass of the reference bridge [default: 25000].")]
Densities = Annotated[list[float] | None, typer.Option(
    "--density", metavar="PER_M2", help="Persons/m², a row each; repeat it for more, in place of FILE's "
                                        "[default: 0.2, 0.5, 0.8, 1.0, 1.5].")]
Density = Annotated[list[float] | None, typer.Option(
    "--density", metavar="PER_M2", help="Persons/m², in place of FILE's [default: 1.0].")]
Mode = Annotated[int, typer.Option(
    metavar="INDEX", help="Mode that is brought into resonance, counted from 0.")]
Percentile = Annotated[float, typer.Option(
    metavar="PERCENT", help="Percentile of the peak acceleration that is the design value.")]
Tolerance = Annotated[float, typer.Option(
    metavar="FRACTION", help="Trials run until the 95 % intervals lie within this of their estimates.")]
Seed = Annotated[int | None, typer.Option(
    metavar="WHOLE", help="Seed of all trials, in place of FILE's [default: 1].")]
Processes = Annotated[int, typer.Option(
    metavar="WHOLE", help="Processes that run the trials; the digits do not depend on it.")]
LedgerFile = Annotated[Path | None, typer.Option(
    "--ledger", metavar="FILE", show_default=False, help="Keep each batch of trials in FILE as it finishes.")]
Resume = Annotated[bool, typer.Option("--resume", help="Go on with the trials that the ledger holds.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON.")]
AsCsv = Annotated[bool, typer.Option("--csv", help="Print CSV.")]


def described(
    file: Path | None, *, frequency: float | None, damping: float | None, modal_mass: float | None,
    density: list[float] | None, seed: int | None,
) -> Description:
    """The description that a file and the options ask for together."""
    options = {"frequency": frequency, "damping": damping, "modal_mass": modal_mass}
    given = {name: value for name, value in options.items() if value is not None}
    if file is not None and given:
        raise ValueError(f"the bridge must be described either by a file or by options, got {file} and "
                         f"--{next(iter(given)).replace('_', '-')}; write it into [bridge] of the file")
    found = Description(bridge=reference_bridge(**given)) if file is None else read_description(file)
    found = found.at_densities(density) if density else found
    return found if seed is None else replace(found, seed=seed)


def as_typed(context: typer.Context, *, leave_out: Iterable[str]) -> str:
    """The command with those of its words that were typed, but for some options."""
    words = context.command_path.split()
    for one in context.command.params:
        source = context.get_parameter_source(one.name or "")
        if source is not None and source.name == "COMMANDLINE" and one.name not in leave_out:
            value = context.params[one.name]
            flag = [one.opts[0]] if one.param_type_name == "option" else []
            words += [word for each in (value if isinstance(value, list) else [value]) for word in (*flag, str(each))]
    return shlex.join(words)
