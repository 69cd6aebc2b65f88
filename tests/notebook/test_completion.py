"""Names offered by Tab, and lists of names."""

import typing

import numpy as np
import pytest

import aolab
from aolab.loading import scene_names
from aolab.modules import MODULES, ModuleName
from aolab.modules.filters import FILTERS
from aolab.notebook.completion import candidates, install
from aolab.truth.buffers import BUFFERS as TRACED


def test_editors_know_the_names_of_all_modules():
    assert list(typing.get_args(ModuleName)) == list(MODULES)


def test_modules_and_scenes_are_listed():
    assert list(aolab.modules()) == list(MODULES)  # pyright: ignore[reportCallIssue]
    assert list(aolab.scenes()) == scene_names()
    assert "<td" in aolab.scenes()._repr_html_()
    assert "ssao" in repr(aolab.modules())  # pyright: ignore[reportCallIssue]


def test_modules_are_listed_by_the_first_call_of_a_process(python):
    done = python("import aolab; print(*aolab.modules())")
    assert done.stdout.split() == list(MODULES), done.stderr


@pytest.mark.parametrize("module", MODULES)
def test_a_call_offers_the_parameters_of_its_module(module):
    offered = candidates(f'frame = lab.render(scene, "{module}", size=(64, 48), ')
    assert offered == [f"{name}=" for name in MODULES[module].stated()]


def test_a_given_parameter_is_not_offered_again():
    assert "radius=" not in candidates('aolab.render("boxes", "ssao", radius=0.5, ')


@pytest.mark.parametrize(
    ("before", "offered"),
    [
        ('aolab.load("', scene_names()),
        ('aolab.render("', scene_names()),
        ('aolab.render("boxes", "', list(MODULES)),
        ("lab.render(aolab.load('boxes'), module='", list(MODULES)),
        ('print("', []),
        ('aolab.render("boxes")', []),
        ("aolab.load(", []),
        ('aolab.load("toasters", ', ["time=", "count="]),
        ('aolab.render(scene, "ssao", filter="', list(FILTERS)),
        ('aolab.render(scene, "ssao", tone_map="', ["filmic", "linear"]),
        ('aolab.render(scene, "ssao", radius="', ["auto"]),
        ('aolab.compare_modules(scene, ["none", "', list(MODULES)),
        ('aolab.relighting_error(scene, "', list(MODULES)),
        ('aolab.reference(scene, buffers=["visibility", "', list(TRACED)),
        ('aolab.reference(scene, like="', list(MODULES)),
        ('aolab.bake("', scene_names()),
        ('aolab.show("', []),
    ],
)
def test_a_string_offers_names(before, offered):
    assert candidates(before) == offered


def test_a_call_without_a_module_offers_the_parameters_of_all():
    assert {"power=", "bounces="} <= set(candidates("aolab.render(scene, "))


FRAME = aolab.Frame({"visibility": np.ones((1, 1)), "mine": np.ones((1, 1))}, timings={}, info={})


@pytest.mark.parametrize(
    "before", ['frame.show("', 'aolab.compare(frame, truth, "', 'aolab.compare(frame, t, buffers=["']
)
def test_a_string_offers_the_buffers_of_the_frame(before):
    assert candidates(before, {"frame": FRAME, "ssao": aolab.SSAO()}) == ["mine", "visibility"]


# --- IPython itself


@pytest.fixture(scope="module")
def tab():
    """{text of a cell: IPython's completions at its end}, with a `frame` and a `scene` among the variables."""
    completer = pytest.importorskip("IPython.core.completer")
    shell = pytest.importorskip("IPython.core.interactiveshell").InteractiveShell()
    shell.user_ns |= {"aolab": aolab, "scene": "boxes", "frame": FRAME, "ssao": aolab.SSAO()}
    install(shell)

    def completions(cell: str) -> list[str]:
        with completer.provisionalcompleter():
            return [one.text for one in shell.Completer.completions(cell, len(cell))]

    return completions


@pytest.mark.parametrize(
    ("cell", "offered"),
    [
        ('aolab.render(scene, "ssao", rad', ["radius="]),
        ('x = 1\nframe = aolab.render(scene, "ssao",\n    rad', ["radius="]),  # a call over two lines
        ('aolab.render(scene, "ssa', ["ssao"]),
        ('aolab.render(scene, "ssao", filter="b', ["bilateral", "box4"]),
        ('aolab.render("', scene_names()),
        ('frame["m', ["mine"]),
        ('frame.show("m', ["mine"]),
        ("aolab.SSAO(rad", ["radius="]),
        ("ssao.replace(rad", ["radius="]),
        ("mine = ssao.replace(\n    filter='b", ["bilateral", "box4"]),
        ("aolab.render(scene, ssao, rad", ["radius="]),
        ("aolab.render(scene, aolab.SSAO(radius=2), bi", ["bias="]),
        ('aolab.render(scene, "ssao?radius=2", dir', ["directions="]),
        ('aolab.render(scene, "ssao", camera=aolab.Camera(eye=(0, 1, 2)), rad', ["radius="]),
        ('aolab.load("toasters?', ["toasters?count=", "toasters?time="]),
        ('aolab.load("toasters?time=1&', ["toasters?time=1&count="]),
        ('aolab.render("toasters?ti', ["toasters?time="]),
        ('aolab.render(scene, "ssao?rad', ["ssao?radius="]),
        ('aolab.render(scene, "ssao?filter=b', ["ssao?filter=bilateral", "ssao?filter=box4"]),
        ('aolab.render(scene, "ssao+rsm?rsm_rad', ["ssao+rsm?rsm_radius="]),
    ],
)
def test_tab_in_ipython(tab, cell, offered, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # no files whose names fit
    assert tab(cell) == offered
