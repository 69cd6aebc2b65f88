"""The lab between frames: the same seed gives the same frame, frames keep what they hold, nothing piles up."""

import gc
import json
import os

import numpy as np
import pytest
import small_scenes
from PIL import Image

import aolab
from aolab import Camera, DirectionalLight, Lab, ParameterError
from aolab.modules import MODULES
from aolab.scene.cones import Cones

BUFFERS = ("viewZ", "viewNormal", "albedo", "visibility_raw", "visibility", "direct", "ambient", "radiance", "image")


def same(one: aolab.Frame, other: aolab.Frame) -> bool:
    return all(np.array_equal(one[name], other[name], equal_nan=name.startswith("vis")) for name in one.buffers)


# --- determinism


@pytest.mark.parametrize("settings", [{}, {"filter": "bilateral", "scale": 0.5}, {"accumulate": 3}])
def test_the_same_seed_gives_the_same_frame(lab, boxes, settings):
    first = lab.render(boxes, "ssao", seed=5, **settings)
    lab.render(boxes, "none", size=(33, 7))
    assert same(lab.render(boxes, "ssao", seed=5, **settings), first)
    assert same(Lab().render(boxes, "ssao", seed=5, size=lab.size, **settings), first)


def test_other_seeds_are_other_sample_sets(lab, boxes):
    frames = [lab.render(boxes, "ssao", seed=seed, filter="none")["visibility"] for seed in range(4)]
    for i in range(4):
        for j in range(i):
            assert (frames[i] != frames[j])[np.isfinite(frames[i])].mean() > 0.01


def test_accumulating_averages_the_frames_of_successive_seeds(lab, boxes):
    settings = {"filter": "none", "radius": 1.0}
    alone = [lab.render(boxes, "ssao", seed=seed, **settings)["visibility"] for seed in range(3, 7)]
    together = lab.render(boxes, "ssao", seed=3, accumulate=4, **settings)["visibility"]
    np.testing.assert_allclose(together, np.mean(alone, axis=0), atol=1e-3)  # each alone is a half float


def test_accumulating_converges(lab, boxes):
    settings = {"filter": "none", "radius": 1.0, "directions": 4}
    truth = lab.render(boxes, "ssao", seed=1000, accumulate=256, **settings)["visibility"]
    error = {
        count: np.sqrt(np.nanmean((lab.render(boxes, "ssao", accumulate=count, **settings)["visibility"] - truth) ** 2))
        for count in (1, 4, 16, 64)
    }
    assert error[4] < 0.65 * error[1]  # independent sets halve it
    assert error[16] < 0.65 * error[4]
    assert error[64] < 0.75 * error[16]


# --- frames


def test_a_frame_keeps_its_content_while_others_are_rendered(lab, boxes, plane):
    """Buffers are read when asked for: other frames, sizes and modules come between, and must not draw over them."""
    held = lab.render(boxes, "ssao", seed=1)
    expected = lab.render(boxes, "ssao", seed=1)
    reference = {name: expected[name].copy() for name in expected.buffers}
    for seed in range(6):
        lab.render(plane, "ssao", seed=seed, accumulate=2, scale=0.5)
        lab.render(boxes, "none", size=(20, 30))
    for name in BUFFERS:
        np.testing.assert_array_equal(held[name], reference[name], err_msg=name)


def test_many_frames_may_be_held(lab, boxes):
    frames = [lab.render(boxes, "ssao", seed=seed) for seed in range(5)]
    for seed, frame in enumerate(frames):
        assert same(frame, lab.render(boxes, "ssao", seed=seed))


def test_textures_of_dropped_frames_are_used_again(boxes):
    lab = Lab((32, 24))
    textures = set()
    for seed in range(10):
        frame = lab.render(boxes, "ssao", seed=seed)
        textures |= {texture.glo for texture in frame.textures.values()}  # type: ignore[union-attr]
        del frame
        gc.collect()
    assert len(textures) <= 2 * len(BUFFERS)


def test_a_module_that_fails_loses_nothing(lab, boxes):
    """Textures that were taken before the failure come back."""

    class Broken(aolab.Module):
        shader = "out float visibility;\nvoid main() { visibility = missing; }\n"

    fresh = Lab((16, 16))
    for _ in range(8):
        with pytest.raises(aolab.ShaderError, match="missing"):
            fresh.render(boxes, Broken())
    assert sum(len(free) for free in fresh._pool._free.values()) == 4  # one G-buffer and its depth
    assert same(fresh.render(boxes, "ssao"), lab.render(boxes, "ssao", size=(16, 16)))


def test_sizes_may_change_back_and_forth_and_leave_nothing_behind(lab, boxes):
    fresh = Lab()
    for _ in range(6):
        for size in ((40, 30), (17, 5), (1, 1)):
            assert same(fresh.render(boxes, "ssao", size=size), lab.render(boxes, "ssao", size=size))
    assert len(fresh._pool._framebuffers) < 20
    assert {size for (size, _), free in fresh._pool._free.items() if free} == {(1, 1)}


@pytest.mark.parametrize("size", [(1, 1), (1, 7), (7, 1), (17, 9), (33, 64)])
@pytest.mark.parametrize("module", MODULES)
def test_any_size(lab, boxes, module, size):
    for settings in ({"filter": "box4"}, {"filter": "bilateral", "scale": 0.3}):
        frame = lab.render(boxes.replace(lights=(DirectionalLight((1, -2, -1)),)), module, size=size, **settings)
        assert frame.size == size
        assert frame.image.shape == (size[1], size[0], 3)
        for name in frame.buffers:
            assert np.isfinite(frame[name][frame.mask] if frame[name].shape[:2] == frame.mask.shape else 0).all(), name


def test_a_frame_records_its_settings(lab, boxes):
    camera = Camera((0, 4, 4), (0, 0, 0), fov=30)
    settings = {"seed": 3, "accumulate": 2, "exposure": 1.5, "tone_map": "linear"}
    frame = lab.render(boxes, "ssao", camera=camera, **settings, radius=0.7).complete()
    info = frame.info
    assert (info["module"], info["seed"], info["accumulate"], info["size"]) == ("ssao", 3, 2, [64, 48])
    assert (info["exposure"], info["tone_map"], info["parameters"]["radius"]) == (1.5, "linear", 0.7)
    assert Camera(**info["camera"]) == camera
    assert info["triangles"] == 2 + 3 * 12
    assert info["renderer"]
    assert json.loads(json.dumps(info)) == info | {"camera": {**info["camera"], **_lists(info["camera"])}}
    assert frame.frame_ms >= sum(frame.timings.values()) > 0
    assert {"g_buffer", "ssao", "filter visibility", "direct", "ambient", "compose"} <= set(frame.timings)
    assert repr(frame) == f"<Frame 64x48 ssao: {', '.join(frame.buffers)}>"
    assert sorted(BUFFERS) == frame.buffers


def _lists(values: dict) -> dict:
    return {key: list(value) for key, value in values.items() if isinstance(value, tuple)}


def test_a_frame_shows_itself_in_a_notebook(lab, boxes):
    import io

    frame = lab.render(boxes)
    np.testing.assert_array_equal(np.asarray(Image.open(io.BytesIO(frame._repr_png_()))), frame.image)


def test_an_unknown_buffer_is_refused_with_the_known_ones(lab, plane):
    frame = lab.render(plane, "none")
    with pytest.raises(ParameterError, match="no buffer '5'; known: "):
        frame[5]
    with pytest.raises(ParameterError, match=r"no buffer 'visibilty'; did you mean 'visibility'\? .*albedo"):
        frame["visibilty"]


def test_buffers_are_saved_by_name(lab, boxes, tmp_path):
    frame = lab.render(boxes, "ssao")
    frame.save_buffers(tmp_path / "all.npz")
    with np.load(tmp_path / "all.npz") as saved:
        assert sorted(saved) == frame.buffers
        assert all(np.array_equal(saved[name], frame[name], equal_nan=True) for name in saved)


# --- what is asked for


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"size": (0, 5)}, r"size = 0x5: each side must be from 1 to \d+ pixels"),
        ({"size": (1.5, 2)}, r"size = \(1\.5, 2\) is not two whole numbers"),
        ({"size": (5,)}, r"size = \(5,\) is not two whole numbers"),
        ({"seed": -1}, r"seed = -1 is not a whole number from 0 on"),
        ({"accumulate": 0}, r"accumulate = 0 is not a whole number from 1 to 16384"),
        ({"accumulate": 1.5}, r"accumulate = 1.5 is not"),
        ({"exposure": 0}, r"exposure = 0 is not a number above 0"),
        ({"exposure": float("nan")}, r"exposure = nan"),
        ({"exposure": "bright"}, r"exposure = 'bright' is not a number above 0"),
        ({"camera": (0, 1, 4)}, r"camera = \(0, 1, 4\) is not an aolab.Camera"),
        ({"last": 5}, r"last: 5 was not rendered by a lab"),
        ({"tone_map": "aces"}, r"tone_map = 'aces' is not one of: filmic, linear"),
        ({"module": "sao"}, r"no module 'sao'; did you mean 'ssao'\?"),
        ({"radus": 1}, r"ssao has no parameter 'radus'; did you mean 'radius'\?"),
        ({"radius": -1}, r"ssao: radius = -1 is not valid: float or auto, > 0, in scene units"),
        ({"radius": float("nan")}, r"ssao: radius = nan is not valid"),
        ({"radius": float("inf")}, r"ssao: radius = inf is not valid"),
        ({"directions": 0}, r"ssao: directions = 0 is not valid: int, ≥ 1, ≤ 256"),
        ({"directions": 2.5}, r"ssao: directions = 2.5 is not valid"),
        ({"filter": "blur"}, r"ssao: filter = 'blur' is not valid: none or box4 or bilateral"),
        ({"directions": 0, "bias": 3}, r"directions = 0 is not valid.*; ssao: bias = 3 is not valid: .*in radii"),
    ],
)
def test_scenes_and_settings_that_cannot_be_rendered_are_refused(lab, plane, arguments, message):
    with pytest.raises(ParameterError, match=message):
        lab.render(plane, **arguments)


def test_numpys_numbers_are_numbers(lab, plane):
    settings = {"directions": np.int64(8), "radius": np.float32(0.5), "seed": np.int64(2), "accumulate": np.int32(2)}
    frame = lab.render(plane, size=tuple(np.array([16, 8])), **settings)
    json.dumps(frame.info)
    assert frame.size == (16, 8)


def test_a_module_is_a_name_a_class_or_an_instance(lab, boxes):
    by_name = lab.render(boxes, "ssao", directions=8)
    assert same(lab.render(boxes, aolab.SSAO, directions=8), by_name)
    assert same(lab.render(boxes, aolab.SSAO(directions=8)), by_name)
    assert same(lab.render(boxes, aolab.SSAO(directions=4), directions=8), by_name)


def test_render_without_a_lab_is_a_lab_of_its_own(boxes, lab):
    frame = aolab.render(boxes, "ssao", size=lab.size, seed=2, directions=8)
    assert same(frame, lab.render(boxes, "ssao", seed=2, directions=8))
    assert aolab.render("boxes", "none", size=(8, 6)).info["scene"] == "boxes"


def test_the_scene_may_be_a_mesh_of_trimesh(lab):
    import trimesh

    frame = lab.render(trimesh.creation.box(), "ssao")
    assert frame.mask.any()


def test_meshes_and_environments_that_nobody_holds_are_freed(boxes):
    import weakref

    lab = Lab((16, 16))
    scene = small_scenes.boxes()
    mesh = weakref.ref(scene.instances[0].mesh)
    lab.render(scene, "none")
    del scene
    lab.render(boxes, "none")  # the shadow maps' key holds the last scene's instances until now
    gc.collect()
    assert mesh() is None


# --- relighting

SUN = aolab.Environment.sky(sun_direction=(1.0, 1.0, 0.3))


@pytest.mark.parametrize("name", MODULES)
def test_a_relit_frame_is_what_a_fresh_one_would_be(lab, boxes, name):
    lamp = DirectionalLight((-1, -2, -1))
    first = lab.render(boxes, name, seed=3)
    relit = lab.relight(first, environment=SUN, lights=[lamp], exposure=0.5, tone_map="linear")
    fresh = lab.render(boxes.replace(environment=SUN, lights=(lamp,)), name, seed=3, exposure=0.5, tone_map="linear")
    assert relit.buffers == fresh.buffers
    for buffer in fresh.buffers:
        np.testing.assert_allclose(relit[buffer], fresh[buffer], atol=1e-3, err_msg=buffer)
    assert {**relit.info, "scene": None} == {**fresh.info, "scene": None}
    assert np.abs(relit["ambient"] - first["ambient"]).max() > 0.1


@pytest.mark.parametrize(("name", "again"), [("ssao", set()), ("ssbn", set()), ("s3ho", set()), ("ssdo", {"ssdo"})])
def test_relighting_runs_what_light_has_a_part_in(lab, boxes, name, again):
    """SSDO looks the environment up for each direction: its estimate is of that light alone."""
    first = lab.render(boxes, name, filter="none")
    relit = lab.relight(first, environment=SUN)
    assert set(relit.timings) - {"shadows", "albedo"} == {"direct", "ambient", "compose", *again}


def test_light_that_is_not_given_stays(lab, boxes):
    lit = boxes.replace(environment=SUN, lights=(DirectionalLight((-1, -2, -1)),))
    first = lab.render(lit, "s3ho", exposure=0.25)
    same = lab.relight(first)
    np.testing.assert_array_equal(same.image, first.image)
    dark = lab.relight(first, lights=[])
    assert dark["direct"].max() == 0
    np.testing.assert_array_equal(dark["ambient"], first["ambient"])
    again = lab.relight(dark, environment=aolab.Environment.constant(0))
    assert again["ambient"].max() == 0 == again["direct"].max()


def test_a_relit_frame_outlives_the_first_and_both_give_their_textures_back(boxes):
    lab = aolab.Lab((64, 48))
    first = lab.render(boxes, "s3ho")
    kept = first["sh1"]
    relit = lab.relight(first, environment=SUN)
    del first
    gc.collect()
    lab.render(boxes, "s3ho", radius=0.1)  # would draw over what was given back
    np.testing.assert_array_equal(relit["sh1"], kept)
    del relit
    gc.collect()
    free = sum(len(textures) for textures in lab._pool._free.values())
    lab.relight(lab.render(boxes, "s3ho"), environment=SUN)
    gc.collect()
    assert sum(len(textures) for textures in lab._pool._free.values()) == free


def test_a_frame_without_an_estimate_is_not_relit(lab, boxes):
    truth = aolab.reference(boxes, size=(16, 12), rays=2, buffers="visibility", cache=False)
    with pytest.raises(ParameterError, match="relight: this frame, of reference, was not rendered by a lab"):
        lab.relight(truth, environment=SUN)


def test_a_relit_scene_is_not_the_named_one_any_more(lab):
    """Its picture does not say that it could be made again from the name alone."""
    first = lab.render("boxes", "s3ho")
    assert first.info["scene"] == "boxes"
    assert lab.relight(first, exposure=2.0).info["scene"] == "boxes"
    assert lab.relight(first, environment=SUN).info["scene"] is None


@pytest.mark.parametrize(
    ("light", "message"),
    [
        ({"lights": DirectionalLight((0, -1, 0))}, "is not a sequence of lights"),
        ({"lights": ["sun"]}, "is not a sequence of lights"),
        ({"environment": "sky"}, "environment = 'sky' is not an Environment; make one with"),
        ({"environment": np.ones((2, 4, 3))}, "is not an Environment"),
    ],
)
def test_values_that_are_no_light_are_refused(lab, boxes, light, message):
    frame = lab.render(boxes, "s3ho")
    with pytest.raises(aolab.SceneError, match=message):
        lab.relight(frame, **light)
    with pytest.raises(ParameterError, match="relight: None was not rendered by a lab"):
        lab.relight(None)


def test_watching_sees_edits_of_lighting_shaders(shaders, boxes):
    lab = aolab.Lab((32, 24), watch=True)
    frame = lab.render(boxes, "s3ho")
    assert frame["ambient"].max() > 0.1
    path = shaders / "s3ho.ambient.glsl"
    path.write_text(path.read_text().replace("irradiance = max(irradiance, 0.0);", "irradiance = vec3(0.0);"))
    os.utime(path, (0, 0))
    assert lab.relight(frame)["ambient"].max() == 0


def test_a_table_of_an_environment_is_made_once(lab, boxes, monkeypatch):
    made = []
    table = Cones.__call__
    monkeypatch.setattr(Cones, "__call__", lambda self, environment: made.append(1) or table(self, environment))
    scene = boxes.replace(environment=SUN.rotated(17))
    first = lab.render(scene, "ssbn")
    lab.render(scene, "ssbn", radius=0.2)
    lab.relight(first, exposure=2.0)
    assert len(made) == 1
    lab.relight(first, environment=SUN.rotated(18))
    assert len(made) == 2


def test_normals_are_those_of_a_buffers_size(lab, boxes):
    frame = lab.render(boxes, "s3ho", scale=0.5)
    assert frame.world_normal().shape == (48, 64, 3)
    assert frame.world_normal("occlusion0_raw").shape == (24, 32, 3)
    assert frame.world_normal("sh0").shape == (48, 64, 3)
    with pytest.raises(ParameterError, match="no buffer 'shh'"):
        frame.world_normal("shh")


class Seen(aolab.Module):
    """The normals that an estimate reads, as its output."""

    name = "seen"
    outputs = {"seen": "RGBA32F"}  # noqa: RUF012
    shader = """
uniform sampler2D viewNormal;
out vec4 seen;
void main() { seen = texelFetch(viewNormal, ivec2(gl_FragCoord.xy), 0); }
"""


@pytest.mark.parametrize(
    ("size", "scale"), [((64, 48), 1.0), ((66, 48), 1 / 3), ((64, 48), 0.5), ((960, 540), 0.5), ((65, 47), 0.3)]
)
def test_normals_at_a_lower_scale_are_those_that_the_estimate_read(lab, ball, size, scale):
    """To the pixel, also at half the size, where two pixels are equally near."""
    frame = lab.render(ball, Seen(scale=scale, filter="none"), size=size)
    read = frame["seen_raw"][..., :3] @ frame.camera.view_from_world[:3, :3].astype(np.float32)
    np.testing.assert_allclose(frame.world_normal("seen_raw"), read, atol=1e-6)


@pytest.mark.parametrize("size", [64, "boxes", (0, 5)])
def test_a_lab_of_a_wrong_size_is_refused_when_it_is_made(size):
    with pytest.raises(ParameterError, match="size = "):
        aolab.Lab(size)
