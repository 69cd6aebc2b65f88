"""The names that the pipeline reserves are the names that it gives: no more, and no fewer."""

import pytest

from aolab import DirectionalLight, PointLight
from aolab.modules.filters import FILTERS
from aolab.modules.names import OWNERS, reserved
from aolab.modules.occluders import OCCLUDERS
from aolab.pipeline import pass_runner, rasterizer


def given(lab, scene, monkeypatch, module: str, **settings) -> dict[str, set[str]]:
    """{owner: names of its uniforms and constants} over all passes of one frame."""
    found: dict[str, set[str]] = {}
    joined = pass_runner.joined

    def watched(bindings, place):
        bindings = list(bindings)
        for one in bindings:
            found.setdefault(one.owner, set()).update(one.uniforms, one.constants)
        return joined(bindings, place)

    monkeypatch.setattr(pass_runner, "joined", watched)
    monkeypatch.setattr(rasterizer, "joined", watched)
    lab.render(scene, module, **settings).complete()
    return found


@pytest.mark.filterwarnings("ignore:.*:aolab.errors.Notice")
def test_reserved_names_are_those_that_are_given(lab, boxes, monkeypatch):
    scene = boxes.replace(lights=(DirectionalLight((0.3, -1, 0.2)), PointLight((0, 3, 1))))
    found: dict[str, set[str]] = {}
    for settings in (
        {"occluders": "layers"},
        {"occluders": "height"},
        {"occluders": "views", "view_layers": 2},
        {"filter": "bilateral", "scale": 0.5},
        {"occluders": "voxels", "filter": "wendland"},
    ):
        frame = given(lab, scene, monkeypatch, "ssdo", bounces=1, **settings)
        for owner, names in frame.items():
            found.setdefault(owner, set()).update(names)
    for module in ("rsm", "instant_radiosity"):
        for owner, names in given(lab, scene, monkeypatch, module).items():
            found.setdefault(owner, set()).update(names)
    owners = reserved()
    shared = {"the view", "the lights", "the environment", "the mesh", "the samples", "the small view"}
    shared |= {"the reflective shadow maps", "the virtual lights"}
    for owner in shared | {kind.label() for kind in OCCLUDERS.values()}:
        for name in found.get(owner, ()):
            assert name in owners, (owner, name)
    drawn = {name for names in found.values() for name in names}
    choices = [*OCCLUDERS.values(), *FILTERS.values()]
    words = {name for one in choices for name, field in one.model_fields.items() if isinstance(field.default, str)}
    assert set(owners) - drawn == words, "reserved, but nothing gives it"


def test_no_name_has_two_owners():
    """A module could satisfy only one of them."""
    names = [name for names in OWNERS.values() for name in names]
    names += [name for kind in OCCLUDERS.values() for name in (*kind.model_fields, *kind.uniforms)]
    assert len(names) == len(set(names))
