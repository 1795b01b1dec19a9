"""The command ``hsictrl``: words in, one call, one table or one file out."""

import os

import typer

from hsictrl.cli import assess, effective, paper, simulate, sweep

app = typer.Typer(
    name="hsictrl", add_completion=False, no_args_is_help=True, rich_markup_mode=None,
    pretty_exceptions_enable=False, help="Footbridges under crowds: human-structure interaction, by python-control.")
app.command()(assess.assess)
app.command()(effective.effective)
app.command()(sweep.sweep)
app.command()(simulate.simulate)
app.command()(paper.paper)


def main() -> None:
    """Run the command on the words it was called with, and exit."""
    os.environ.setdefault("MPLBACKEND", "Agg")    # figures go into files; no screen is needed
    app(prog_name="hsictrl")
