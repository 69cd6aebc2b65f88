"""The question that a module answers."""

import pytest

import aolab
from aolab.modules import MODULES


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"radius": 0}, r"radius = 0 is not a length above 0"),
        ({"radius": "auto"}, r"radius = 'auto' is not a length above 0"),
        ({"falloff": -0.1}, r"falloff = -0\.1 is outside \[0, 1\]"),
        ({"falloff": "wenland"}, r"falloff = 'wenland' is unknown; did you mean 'wendland'"),
        ({"measure": "cubic"}, r"measure = 'cubic' is unknown; known: classical, exponential, linear, sqrt, wendland"),
        ({"sigma": 0.0}, r"sigma = 0\.0 is not a number above 0"),
        ({"spread": 1.5}, r"spread = 1\.5 is outside \(0, 1\]"),
        ({"bounces": 2.5}, r"bounces = 2\.5 is not a whole number"),
    ],
)
def test_values_out_of_range_are_named(fields, message):
    with pytest.raises(aolab.ParameterError, match=message):
        aolab.Question(**fields)


def test_a_change_keeps_the_rest_and_names_what_it_does_not_know():
    question = aolab.Question(2.0, 0.5).replace(spread=0.25)
    assert question == aolab.Question(2.0, 0.5, spread=0.25)
    with pytest.raises(aolab.ParameterError, match="a question has no 'spraed'; did you mean 'spread'"):
        question.replace(spraed=0.5)


@pytest.mark.parametrize("name", MODULES)
def test_every_module_has_a_question_once_it_is_resolved(name, boxes):
    module = MODULES[name]().resolved(boxes)
    question = module.question()
    assert question.limited_senders
    assert question.radius == getattr(module, "radius", None)
    own = {"hao": "wendland"}.get(name, 0.0)  # of modules without such a parameter
    assert question.falloff == getattr(module, "measure", getattr(module, "falloff", own))


def test_a_frame_carries_the_question(lab, boxes):
    frame = lab.render(boxes, "ssao", radius=0.4, falloff=0.2)
    assert aolab.Question(**frame.info["question"]) == aolab.Question(0.4, 0.2, limited_senders=True)
