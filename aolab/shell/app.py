"""The commands of the shell: one file each. A file imports what its command needs when the command runs."""

from typing import Annotated

import typer

from ..version import __version__
from .animate import animate
from .bake import bake
from .bench import bench
from .compare import compare
from .doctor import doctor
from .exercise import exercise
from .modules import modules
from .reference import reference
from .render import render
from .reproduce import reproduce
from .scenes import scenes
from .sweep import sweep
from .tune import tune
from .view import view

COMMANDS = (render, reference, compare, modules, scenes, doctor, bench, tune, sweep, reproduce, animate, bake, view)

NAMES = [*(command.__name__ for command in COMMANDS), "exercise"]


def _print_version(asked: bool) -> None:
    if asked:
        print(f"aolab {__version__}")
        raise typer.Exit()


def _options(
    version: Annotated[
        bool,
        typer.Option("-V", "--version", callback=_print_version, is_eager=True, help="Print the version and exit."),
    ] = False,
) -> None: ...


def app(*names: str) -> typer.Typer:
    """The commands of these names, or all. Typer reads the options of each command, which takes 1 ms."""
    made = typer.Typer(
        name="aolab",
        help="A laboratory for ambient lighting in image space.",
        epilog="`aolab COMMAND --help` describes a command. `--debug` shows the traceback of an error.",
        pretty_exceptions_enable=False,
        rich_markup_mode=None,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    made.callback()(_options)
    for command in COMMANDS:
        if command.__name__ in (names or NAMES):
            made.command()(command)
    if "exercise" in (names or NAMES):
        made.add_typer(exercise)
    return made
