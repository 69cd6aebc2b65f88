"""Names offered by Tab, and lists of names."""

import typing

import pytest

import aolab
from aolab.loading import scene_names
from aolab.modules import MODULES, ModuleName
from aolab.notebook.completion import candidates


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
    ],
)
def test_a_string_offers_names(before, offered):
    assert candidates(before) == offered


def test_a_call_without_a_module_offers_the_parameters_of_all():
    assert {"power=", "bounces="} <= set(candidates("aolab.render(scene, "))
