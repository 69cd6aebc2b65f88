"""The command line as a whole: help, version, exit codes, errors in one line, slips answered with the right line."""

import re
from importlib.metadata import entry_points, version

import pytest

from aolab.papers import PAPERS
from aolab.shell import cli
from aolab.shell.app import NAMES as COMMANDS
from aolab.shell.exercise import NAMES as EXERCISES

RUN = "import sys; sys.argv = ['aolab', *{!r}]; from aolab.shell.cli import main; main()"
HELP = [(), *((name,) for name in COMMANDS), *(("exercise", name) for name in EXERCISES)]


def test_the_installed_command_is_this_one(monkeypatch):
    (script,) = (point for point in entry_points(group="console_scripts") if point.name == "aolab")
    ran = []
    monkeypatch.setattr(cli, "main", lambda imported: ran.append(imported()))
    script.load()()
    assert len(ran) == 1


@pytest.mark.parametrize("command", HELP)
def test_help_is_no_error_and_no_sentence_is_cut(aolab, monkeypatch, command):
    monkeypatch.setenv("COLUMNS", "80")
    done = aolab(*command, "--help")
    assert (done.code, done.err) == (0, "")
    assert "Usage: aolab" in done.out
    assert "..." not in re.sub(r"[]}]\.\.\.", "", done.out)


def test_help_names_every_command(aolab):
    assert all(f"\n  {name}  " in aolab().out for name in COMMANDS)
    assert all(f"\n  {name} " in aolab("exercise").out for name in EXERCISES)


def test_without_arguments_the_help_is_printed(aolab):
    assert aolab() == aolab("--help") == aolab("-h")
    assert aolab("exercise") == aolab("exercise", "--help")


def test_help_of_reproduce_names_every_paper(aolab):
    out = aolab("reproduce", "--help").out
    assert all(re.search(rf"\b{paper}\b", out) for paper in PAPERS)


def test_version(aolab):
    assert aolab("--version").out == aolab("-V").out == f"aolab {version('aolab')}\n"


@pytest.mark.parametrize(
    "arguments",
    [
        ("rendr",),
        ("modules", "sao"),
        ("bench", "--frames", "1"),
        ("bench", "--size", "x"),
        ("compare", "boxes", "--modules", "sao"),
        ("compare", "boxes", "--relight", "2", "-o", "a.png"),
        ("tune", "sao"),
        ("reproduce", "sdo"),
    ],
)
def test_every_command_refuses_in_one_line(aolab, arguments):
    done = aolab(*arguments)
    assert (done.code, done.out) == (2, "")
    assert done.err.startswith("aolab: ")
    assert done.err.count("\n") == 1


SLIPS = {
    "a scene as the command": ("boxes", "write: aolab render boxes"),
    "a scene with parameters": ("boxes?swap=1 --size 8x8", "write: aolab render boxes?swap=1"),
    "a model as the command": ("model.glb", "write: aolab render model.glb"),
    "a picture as the command": ("a.png", "write: aolab render --like a.png"),
    "a picture as the scene": ("render a.png", "a.png is a picture, not a scene: to repeat it, write --like a.png"),
    "a module as an argument": ("render boxes SSAO?steps=2", "write --module ssao?steps=2"),
    "--set with a space": ("render boxes --set radius 0.5", "write --set radius=0.5"),
    "--set with a space, before the scene": ("render --set radius 0.5 boxes", "write --set radius=0.5"),
    "a parameter as an option": ("render boxes --radius 0.5", "write --set radius=0.5"),
    "a parameter as an option with =": ("tune ssao --light-steps=2", "write --set light_steps=2"),
    "a parameter as an option of compare": ("compare boxes --steps 2", 'write --modules "ssao?steps=2"'),
    "a size with a space": ("render boxes --size 64 36", "write --size 64x36"),
    "a place with spaces": ("render boxes --eye 0 1 -4", "write --eye 0,1,-4"),
    "a module in capitals": ("render boxes --module SSAO", "did you mean 'ssao'"),
    "two letters swapped": ("modules ssoa", "did you mean 'ssao'"),
    "a module that is none, as an argument": ("render boxes ssoa", "write --module ssao"),
    "a module as an argument of compare": ("compare boxes SSAO,ssdo", "write --modules ssao,ssdo"),
    "--module of compare": ("compare boxes --module ssao", "write --modules ssao"),
    "--set of compare": ("compare boxes --set radius=0.5", 'write --modules "ssao?radius=0.5"'),
    "a module as an argument of sweep": ("sweep boxes ssao", "stand in a file: aolab sweep SPEC.toml"),
    "a scene as the argument of sweep": (
        "sweep boxes",
        "no file boxes: the scene, the module and its parameters stand in a",
    ),
    "--scene of sweep": ("sweep --scene boxes", "stand in a file: aolab sweep SPEC.toml"),
    "a module as an argument of bench": ("bench ssao", "`aolab bench` measures every module"),
    "--module of bench": ("bench --module ssao", "`aolab bench` measures every module"),
    "two scenes": ("compare boxes cornell", "a command takes one scene; write aolab compare cornell"),
    "--scene of render": ("render --scene boxes", "write aolab render boxes"),
    "a parameter as an argument": ("render boxes radius=0.5", "write --set radius=0.5"),
    "a scene as an argument of bench": ("bench boxes", "write --scene boxes"),
    "a scene as an argument of scenes": ("scenes boxes", "to render one, write: aolab render boxes"),
    "a function of Python": ("explain boxes", "it is a function in Python, aolab.explain"),
    "a misspelt scene as the command": ("boxs", "write: aolab render boxes"),
    "a module as the command": ("SSAO", "write: aolab render boxes --module ssao"),
    "help as the command": ("help", "write: aolab --help"),
    "version as the command": ("version", "write: aolab --version"),
    "no scene": ("compare", "`aolab scenes` lists them"),
    "no module": ("tune", "`aolab modules` lists them"),
    "no paper": ("reproduce", "aolab reproduce s3ho"),
    "the number of a figure": ("reproduce s3ho 7", "did you mean 'fig7'"),
    "an unknown command of exercises": ("exercise chek", "no command 'exercise chek'; did you mean 'check'"),
    "a model that is missing": ("render model.glb", "knot.glb"),
    "an unknown command": ("rendr boxes", "no command 'rendr'; did you mean 'render'?"),
}


@pytest.mark.parametrize("case", SLIPS)
def test_a_slip_gets_the_line_that_was_meant(aolab, case):
    line, answer = SLIPS[case]
    done = aolab(*line.split())
    assert (done.code, done.out) == (2, "")
    assert answer in done.err
    assert done.err.count("\n") == 1


@pytest.mark.parametrize("line", ["render boxes --frob", "render boxes quartz", "frob", "render boxes --size 9"])
def test_another_mistake_keeps_its_message(aolab, line):
    assert re.search(
        "No such option|extra argument|no command 'frob'; known: |is not WIDTHxHEIGHT", aolab(*line.split()).err
    )


def test_debug_shows_where_an_error_came_from(python):
    quiet = python(RUN.format(["render", "boxs"]))
    assert quiet.returncode == 2
    assert quiet.stderr.count("\n") == 1
    loud = python(RUN.format(["--debug", "render", "boxs"]))
    assert loud.returncode not in (0, None)
    assert "Traceback" in loud.stderr
    assert loud.stderr.rstrip().splitlines()[-1].startswith("aolab.errors.FileError: no scene 'boxs'")


def test_a_fault_of_the_program_keeps_its_traceback(aolab, monkeypatch):
    monkeypatch.setattr("aolab.loading.scene_names", lambda: 1 / 0)
    monkeypatch.setattr("sys.argv", ["aolab", "scenes"])
    with pytest.raises(ZeroDivisionError):
        cli.main()
