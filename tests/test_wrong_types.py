"""Calls with values of a wrong type, as beginners make them: aolab's own errors, which name value and remedy."""

import re

import numpy as np
import pytest

import aolab

BUFFERS = {"visibility": np.ones((1, 1)), "viewZ": np.ones((1, 1)), "image": np.ones((1, 1, 3), np.uint8)}
FRAME = aolab.Frame(BUFFERS, timings={}, info={"size": (1, 1)})


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: FRAME.save(5), "path = 5 is not a path: give a text or a pathlib.Path"),
        (lambda: FRAME.save_buffers(None), "path = None is not a path"),
        (lambda: FRAME.complete("visability"), "no buffer 'visability'; did you mean 'visibility'?"),
        (lambda: aolab.Environment.load(5), "path = 5 is not a path"),
        (lambda: aolab.Environment.constant("red"), "constant: rgb = 'red' is not a number or three numbers"),
        (lambda: aolab.microscope(5, (0, 0)), "microscope: 5 is not a frame; aolab.render and aolab.reference return"),
        (lambda: aolab.glyph("s3ho", (0, 0)), "glyph: 's3ho' is not a frame"),
        (lambda: aolab.contact_sheet(5), "pictures = 5 is not a list of pictures"),
        (lambda: aolab.Flipbook(5), "pictures = 5 is not a list of pictures"),
        (lambda: aolab.animate("boxes", out=5), "out = 5 is not a path"),
        (lambda: aolab.reference("boxes", error="a"), "error = 'a' is not a share in (0, 1)"),
    ],
)
def test_a_wrong_type_is_named(call, message):
    with pytest.raises(aolab.Error, match=re.escape(message)):
        call()


@pytest.mark.parametrize(
    ("module", "written", "meant"),
    [
        ("ssdo", "indirect", "bounces"),
        ("s3ho", "bounces", "indirect"),
        ("ssao", "samples", "directions"),
        ("ssao", "intensity", "power"),
        ("rsm", "samples", "rsm_samples"),  # it has no directions: the nearest name
    ],
)
def test_a_word_of_the_same_meaning_is_suggested(module, written, meant):
    with pytest.raises(aolab.ParameterError, match=f"{module} has no parameter '{written}'; did you mean '{meant}'"):
        aolab.render("boxes", module, **{written: 1})


@pytest.mark.parametrize("name", ["radius", "layers"])
def test_a_module_does_not_change(name):
    module = aolab.SSAO(occluders="layers")
    with pytest.raises(
        aolab.ParameterError, match=rf"ssao: {name} cannot be changed; write module.replace\({name}=3\)"
    ):
        setattr(module, name, 3)
    assert getattr(module.replace(**{name: 3}), name) == 3


def test_an_unknown_name_of_the_package_gets_the_nearest():
    with pytest.raises(AttributeError, match="aolab has no 'rendr'; did you mean 'render'"):
        aolab.rendr  # noqa: B018  # pyright: ignore[reportAttributeAccessIssue]
    assert not hasattr(aolab, "_nothing")
