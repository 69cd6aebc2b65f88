"""Plans are kept from frame to frame, and nothing in them is out of date."""

from dataclasses import replace

import numpy as np
import pytest
import small_scenes

import aolab
from aolab import Lab, Module, ShaderError
from aolab.modules.occluders.base import OccluderKind
from aolab.pipeline import plan


@pytest.fixture
def made(monkeypatch) -> list[Module]:
    """The modules of the plans that a lab makes in this test."""
    found = []

    class Watched(plan.Plan):
        def __init__(self, module, *others):
            found.append(module)
            super().__init__(module, *others)

    monkeypatch.setattr("aolab.pipeline.lab.Plan", Watched)
    return found


UV, AT_UV = "uniform sampler2D uv;\n", "texelFetch(uv, ivec2(0), 0).x"  # drawn for those who read it


def flat(value: str) -> str:
    return f"out float visibility;\nvoid main() {{ visibility = {value}; }}\n"


def level(frame: aolab.Frame) -> float:
    """The visibility, which is the same in all of the surfaces' pixels."""
    return np.unique(frame["visibility"][frame.mask]).item()


# --- kept


def test_a_steady_frame_has_the_plan_of_the_last(gl, boxes, made):
    lab = Lab((16, 12))
    for _ in range(2):
        lab.render(boxes, "ssao", radius=0.5, camera=boxes.camera.orbited(1.0))
        lab.render(boxes, aolab.SSAO(radius=0.5), size=(20, 16), seed=3, accumulate=2).complete()
    assert made == [aolab.SSAO(radius=0.5)]


def test_another_module_or_scene_has_another_plan(gl, boxes, made):
    lab, twice = Lab((16, 12)), boxes.replace(name="twice")
    for scene, options in ((boxes, {}), (boxes, {"steps": 2}), (twice, {"steps": 2}), (boxes, {})):
        lab.render(scene, "ssao", **options)
    assert [module.steps for module in made] == [4, 2, 2, 4]


# --- not out of date


def test_the_radius_is_that_of_the_scene(lab, boxes):
    large = aolab.Scene([aolab.Instance(one.mesh, np.diag((9, 9, 9, 1))) for one in boxes.instances])
    radii = [lab.render(scene, "ssao").info["parameters"]["radius"] for scene in (boxes, large, boxes)]
    assert radii[0] == radii[2]
    assert radii[1] > 5 * radii[0]


def test_sample_sets_are_those_of_the_seed(lab, boxes):
    first, *others = (lab.render(boxes, "ssao", seed=seed)["visibility_raw"] for seed in (1, 2, 1))
    assert (first != others[0]).any()
    np.testing.assert_array_equal(first, others[1])


def test_a_frame_whose_settings_are_changed_leaves_those_of_the_next(lab, boxes):
    before = lab.render(boxes, "ssao", radius=0.5)
    before.info["parameters"]["radius"] = before.info["camera"]["fov"] = before.info["question"]["radius"] = None
    after = lab.render(boxes, "ssao", radius=0.5).info
    assert after["parameters"]["radius"] == after["question"]["radius"] == 0.5
    assert after["camera"]["fov"]


def test_each_frame_has_the_notices_of_its_module(lab, boxes):
    *others, last = boxes.instances
    mesh = replace(last.mesh, material=aolab.Material(emission=(1.0, 1.0, 1.0)))
    glowing = boxes.replace(instances=(*others, aolab.Instance(mesh)))
    for _ in range(2):
        with pytest.warns(aolab.Notice, match="instant_radiosity"):
            frame = lab.render(glowing, "instant_radiosity", bounce_lights=4)
        assert any("instant_radiosity" in note for note in frame.notes)


def test_a_class_of_the_users_own_may_change(lab, plane):
    class Own(Module):
        name = "own"
        shader = flat("0.5")

    module = Own()
    assert level(lab.render(plane, module)) == 0.5
    Own.shader = flat("0.25")
    assert level(lab.render(plane, module)) == 0.25


def test_a_choice_of_the_users_own_may_change(lab, boxes):
    def text(blocked: str) -> str:
        return f"""
        #include "occluders/surfaces.glsl"
        {UV}
        struct Occluder {{ vec3 viewPos; }};
        bool isBlocked(Receiver receiver, vec3 samplePos, float thickness, out Occluder occluder) {{
            return {blocked};
        }}
        """

    class Even(OccluderKind):
        name = "even"
        shader = text("false").replace(UV, "")

    module = aolab.SSAO(occluders=Even(), filter="none")
    assert level(lab.render(boxes, module)) == 1
    Even.shader = text(f"{AT_UV} < 100.0")
    assert level(lab.render(boxes, module)) == 0


def test_a_shader_that_is_mended_may_read_other_buffers(gl, shaders):
    """No reload: none of its programs was ever compiled."""
    lab, scene, shader = Lab((16, 12)), small_scenes.boxes(), shaders / "none.frag"
    shader.write_text(flat("one"))
    with pytest.raises(ShaderError, match="one"):
        lab.render(scene, "none")
    shader.write_text(UV + flat(f"0.0075 * max({AT_UV}, 100.0)"))
    assert level(lab.render(scene, "none")) == 0.75


def test_a_shader_that_is_reloaded_may_read_other_buffers(gl, shaders):
    lab, scene, shader = Lab((16, 12), watch=True), small_scenes.boxes(), shaders / "none.frag"
    assert level(lab.render(scene, "none")) == 1
    shader.write_text(UV + flat(f"0.0075 * max({AT_UV}, 100.0)"))
    assert level(lab.render(scene, "none")) == 0.75
