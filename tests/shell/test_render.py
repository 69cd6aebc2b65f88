"""`aolab render` and `aolab reference`: their files, and their refusals before the work."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from aolab import Lab
from aolab.pictures.buffers import BACKGROUND
from aolab.pictures.metadata import read_png, save_png

SMALL = ("--size", "24x16")


def pixels(path: Path | str) -> np.ndarray:
    with Image.open(path) as image:
        return np.asarray(image)


# --- what it writes


def test_a_scene_is_enough(aolab):
    done = aolab("render", "boxes", *SMALL)
    assert (done.code, done.out, done.err) == (0, "out.png\n", "")
    assert pixels("out.png").shape == (16, 24, 3)
    assert pixels("out.png").std() > 5


def test_every_option_arrives(aolab):
    done = aolab(
        *("render", "boxes?swap=true", "--module", "ssao", "--set", "radius=0.7", "--set", "filter=bilateral"),
        *("--occluders", "depth", "--size", "20x10", "--seed", "3", "--accumulate", "2", "--eye", "1,3,6"),
        *("--target", "0,0.5,0", "--fov", "40", "--exposure", "1.5", "--tone-map", "linear", "-o", "a.png"),
    )
    assert done.code == 0, done.err
    info = read_png("a.png")
    assert info["scene"] == "boxes?swap=true"
    assert info["module"] == "ssao"
    assert (info["parameters"]["radius"], info["parameters"]["filter"]) == (0.7, "bilateral")
    assert (info["size"], info["seed"], info["accumulate"]) == ([20, 10], 3, 2)
    assert (info["camera"]["eye"], info["camera"]["target"], info["camera"]["fov"]) == ([1, 3, 6], [0, 0.5, 0], 40)
    assert (info["exposure"], info["tone_map"]) == (1.5, "linear")


def test_a_part_of_the_camera_may_be_given(aolab):
    aolab("render", "boxes", *SMALL, "-o", "a.png")
    aolab("render", "boxes", *SMALL, "--eye", "1,3,6", "-o", "b.png")
    plain, moved = read_png("a.png")["camera"], read_png("b.png")["camera"]
    assert moved == {**plain, "eye": [1, 3, 6]}


def test_like_makes_a_picture_again_to_the_pixel(aolab):
    settings = ("--set", "radius=0.9", "--seed", "4", "--eye", "2,3,6", "--fov", "35", "--tone-map", "linear")
    aolab("render", "boxes?swap=1", *settings, "--size", "40x30", "-o", "a.png")
    done = aolab("render", "--like", "a.png", "-o", "b.png")
    assert done.code == 0, done.err
    np.testing.assert_array_equal(pixels("a.png"), pixels("b.png"))
    assert read_png("a.png") == read_png("b.png")


def test_like_takes_other_options_on_top(aolab):
    aolab("render", "boxes", *SMALL, "--set", "radius=0.9", "--set", "steps=3", "--eye", "2,3,6", "-o", "a.png")
    aolab("render", "--like", "a.png", "--set", "radius=0.5", "--seed", "9", "-o", "b.png")
    info = read_png("b.png")
    assert (info["parameters"]["radius"], info["parameters"]["steps"], info["seed"]) == (0.5, 3, 9)
    assert info["camera"]["eye"] == [2, 3, 6]
    aolab("render", "--like", "a.png", "--module", "none", "-o", "c.png")
    assert "radius" not in read_png("c.png")["parameters"]


def test_statistics_and_buffers_have_the_names_of_the_design(aolab):
    done = aolab("render", "boxes", *SMALL, "-o", "a.png", "--stats", "a.json", "--buffers", "a.npz", "--seed", "2")
    assert done.code == 0, done.err
    stats = json.loads(Path("a.json").read_text())
    keys = {"renderer", "size", "module", "parameters", "timings", "frame_ms", "triangles", "seed"}
    assert keys <= set(stats)
    assert (stats["size"], stats["module"], stats["seed"]) == ([24, 16], "ssao", 2)
    assert {"g_buffer", "ssao", "direct", "ambient", "compose"} <= set(stats["timings"])
    assert all(milliseconds >= 0 for milliseconds in stats["timings"].values())
    assert "shadows" not in stats["timings"]  # a warm frame: the shadow maps were there
    with np.load("a.npz") as buffers:
        assert {"viewZ", "viewNormal", "albedo", "visibility", "visibility_raw", "direct", "ambient", "image"} <= set(
            buffers
        )
        np.testing.assert_array_equal(buffers["image"], pixels("a.png"))
        np.testing.assert_array_equal(np.isnan(buffers["visibility"]), buffers["viewZ"] == -np.inf)


def test_a_model_file_is_a_scene(aolab, tmp_path):
    import trimesh

    trimesh.creation.box().export(tmp_path / "box.ply")
    done = aolab("render", "box.ply", *SMALL)
    assert done.code == 0, done.err
    assert read_png("out.png")["scene"] == "box.ply"


def test_notes_go_to_stderr_and_into_the_stats(aolab, tmp_path):
    (tmp_path / "two.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\n")
    done = aolab("render", "two.obj", *SMALL, "--stats", "a.json")
    assert done.code == 0
    assert done.err.startswith("aolab: note: ")
    assert "dropped 1 of 2 triangles" in done.err
    assert any("dropped 1 of 2 triangles" in note for note in json.loads(Path("a.json").read_text())["notes"])


def test_like_with_another_occluder_kind_drops_the_parameters_of_the_old_kind(aolab):
    aolab("render", "boxes", *SMALL, "--occluders", "views", "--set", "views=2", "-o", "a.png")
    done = aolab("render", "--like", "a.png", "--occluders", "layers", "-o", "b.png")
    assert done.code == 0, done.err
    parameters = read_png("b.png")["parameters"]
    assert parameters["layers"] == 4
    assert "views" not in parameters


# --- shaders and modules of one's own

STUDENT = """
from pathlib import Path

import aolab


class Mine(aolab.Module):
    title = "Mine"
    shader = Path("mine.frag")
    level: float = aolab.parameter(0.5, "The visibility.", ge=0, le=1)
"""
SHADER = "uniform float level;\nout float visibility;\nvoid main() { visibility = level; }\n"


@pytest.fixture
def student(tmp_path) -> Path:
    """A folder `hw` with a module and its shader beside it."""
    folder = tmp_path / "hw"
    folder.mkdir()
    (folder / "student.py").write_text(STUDENT)
    (folder / "mine.frag").write_text(SHADER)
    return folder


@pytest.mark.parametrize("name", ["hw/student.py:Mine", "hw/student.py"])
def test_a_module_in_a_file_is_rendered_and_can_be_repeated(aolab, student, name):
    done = aolab("render", "boxes", *SMALL, "--module", name, "--set", "level=0.25", "--buffers", "a.npz")
    assert done.code == 0, done.err
    with np.load("a.npz") as buffers:
        assert np.nanmax(np.abs(buffers["visibility"] - 0.25)) < 1e-3
    assert read_png("out.png")["module"] == "hw/student.py:Mine"
    assert aolab("render", "--like", "out.png", "-o", "again.png").code == 0
    np.testing.assert_array_equal(pixels("out.png"), pixels("again.png"))


def test_a_shader_takes_the_place_of_a_modules(aolab, student):
    (student / "half.frag").write_text("out float visibility;\nvoid main() { visibility = 0.5; }\n")
    options = ("--shader", "hw/half.frag", "--like-module", "ssao", "--set", "directions=4")
    done = aolab("render", "boxes", *SMALL, *options, "--buffers", "a.npz")
    assert done.code == 0, done.err
    with np.load("a.npz") as buffers:
        assert np.nanmax(np.abs(buffers["visibility"] - 0.5)) < 1e-3
    info = read_png("out.png")
    assert (info["module"], info["parameters"]["directions"]) == ("hw/half.frag:ssao", 4)
    assert aolab("render", "--like", "out.png", "-o", "again.png").code == 0
    np.testing.assert_array_equal(pixels("out.png"), pixels("again.png"))


def test_an_error_in_a_shader_of_ones_own_names_its_file_and_line(aolab, student):
    (student / "bad.frag").write_text("out float visibility;\nvoid main() { visibility = oops; }\n")
    done = aolab("render", "boxes", *SMALL, "--shader", "hw/bad.frag")
    assert (done.code, done.err.count("\n")) == (2, 1)
    assert "hw/bad.frag:2: " in done.err


def test_a_file_is_described_as_a_module(aolab, student):
    done = aolab("modules", "hw/student.py:Mine")
    assert "hw/student.py:Mine: Mine\n\nparameters:\n  level = 0.5  (float, ≥ 0, ≤ 1)\n" in done.out


# --- buffers


def test_a_picture_shows_any_buffer_and_its_scale_is_printed(aolab):
    done = aolab("render", "boxes", *SMALL, "--buffer", "visibility", "-o", "ao.png", "--buffers", "a.npz")
    assert (done.code, done.out) == (0, "ao.png: visibility, black 0 to white 1\n")
    with np.load("a.npz") as buffers:
        visibility = buffers["visibility"]
    seen = pixels("ao.png")
    where = np.isfinite(visibility)
    np.testing.assert_array_equal(seen[where], np.rint(visibility[where] * 255)[:, None].repeat(3, axis=1))
    assert (seen[~where] == BACKGROUND).all()
    info = read_png("ao.png")
    assert (info["buffer"], info["scale"]) == ("visibility", "black 0 to white 1")
    assert aolab("render", "--like", "ao.png", "-o", "again.png").code == 0
    np.testing.assert_array_equal(seen, pixels("again.png"))


def test_buffers_are_layers_of_an_exr(aolab):
    import OpenEXR

    assert aolab("render", "boxes", *SMALL, "--buffers", "a.exr", "--buffers", "a.exr").code == 0
    (part,) = OpenEXR.File("a.exr", separate_channels=True).parts
    assert {"visibility.Y", "viewNormal.X", "ambient.R", "image.B"} <= set(part.channels)


# --- the reference


def test_the_reference_has_radius_and_falloff_of_the_module(aolab):
    usual = ("reference", "boxes", *SMALL, "--rays", "4")
    assert aolab(*usual, "--set", "radius=0.5").out == "reference.png\n"
    settings = read_png("reference.png")["parameters"]
    assert (settings["rays"], settings["radius"], settings["falloff"]) == (4, 0.5, 0.3)
    assert aolab(*usual, "--radius", "0.7", "--set", "falloff=0.1", "-o", "b.png").code == 0
    settings = read_png("b.png")["parameters"]
    assert (settings["radius"], settings["falloff"]) == (0.7, 0.1)
    assert aolab(*usual, "--module", "none", "-o", "c.png").code == 0
    assert read_png("c.png")["parameters"]["radius"] is None


def test_the_reference_of_a_picture_and_of_a_reference(aolab):
    aolab("render", "boxes", *SMALL, "--set", "radius=0.6", "--eye", "1,3,6", "-o", "a.png")
    assert aolab("reference", "--like", "a.png", "--rays", "4", "-o", "b.png").code == 0
    info = read_png("b.png")
    assert (info["parameters"]["radius"], info["camera"]["eye"], info["size"]) == (0.6, [1, 3, 6], [24, 16])
    assert aolab("reference", "--like", "b.png", "-o", "again.png").code == 0
    np.testing.assert_array_equal(pixels("b.png"), pixels("again.png"))
    refused = aolab("render", "--like", "b.png")
    assert (refused.code, refused.err.count("\n")) == (2, 1)
    assert "the picture was ray-traced: use `aolab reference --like`" in refused.err


def test_a_buffer_of_the_reference_that_is_not_traced_by_default(aolab):
    done = aolab("reference", "boxes", *SMALL, "--rays", "4", "--buffer", "sh0", "-o", "a.png")
    assert done.out.startswith("a.png: sh0, channel 1 of 4, violet ")


# --- the camera and the metadata


def test_the_axis_of_a_file_that_points_up(aolab):
    """The same as the parameter behind its name; and --like repeats it."""
    aolab("render", "knot.glb", *SMALL, "--up-axis", "z", "-o", "a.png")
    aolab("render", "knot.glb?up_axis=z", *SMALL, "-o", "b.png")
    aolab("render", "--like", "a.png", "-o", "c.png")
    aolab("render", "knot.glb", *SMALL, "-o", "d.png")
    a, b, c, d = (pixels(f"{name}.png") for name in "abcd")
    assert np.array_equal(a, b)
    assert np.array_equal(a, c)
    assert not np.array_equal(a, d)


def test_up_turns_the_camera(aolab):
    aolab("render", "boxes", *SMALL, "--up", "0,1,0", "-o", "a.png")
    aolab("render", "boxes", *SMALL, "--up", "0,-1,0", "-o", "b.png")
    assert read_png("b.png")["camera"]["up"] == [0, -1, 0]
    upright, turned = pixels("a.png").astype(int), pixels("b.png")[::-1, ::-1].astype(int)
    assert np.abs(upright - turned).mean() < 12 < np.abs(upright - upright[::-1]).mean()


DAMAGED = {
    "size of one number": {"size": [1]},
    "size of text": {"size": "abc"},
    "camera of a number": {"camera": 3},
    "camera that looks nowhere": {"camera": {"eye": [0, 0, 0], "target": [0, 0, 0]}},
    "parameters in a list": {"parameters": [1]},
    "a parameter of a wrong type": {"parameters": {"radius": {}}},
    "a seed of text": {"seed": "x"},
    "a scene of a number": {"scene": 3},
    "a scene made in Python": {"scene": None},
    "no module": {"module": None},
    "an unknown module": {"module": "gone"},
    "an exposure of text": {"exposure": "x"},
    "a huge number": {"accumulate": 1e300},
}


@pytest.mark.parametrize("case", DAMAGED)
def test_metadata_of_wrong_types_is_refused_in_one_line(aolab, case):
    aolab("render", "boxes", "--size", "8x8", "-o", "a.png")
    save_png("b.png", pixels("a.png"), read_png("a.png") | DAMAGED[case])
    done = aolab("render", "--like", "b.png", "-o", "c.png")
    assert (done.code, done.err.count("\n")) == (2, 1), done.err
    assert not Path("c.png").exists()


@pytest.mark.parametrize("settings", [{"rays": "x"}, {"radius": {}}, {"measure": "x"}, {"gone": 1}, {"engine": 3}])
def test_settings_of_a_reference_of_wrong_types_are_refused_in_one_line(aolab, settings):
    aolab("reference", "boxes", "--size", "8x8", "--rays", "2", "-o", "a.png")
    info = read_png("a.png")
    info["parameters"] |= settings
    save_png("b.png", pixels("a.png"), info)
    done = aolab("reference", "--like", "b.png", "-o", "c.png")
    assert (done.code, done.err.count("\n")) == (2, 1), done.err
    assert next(iter(settings)) in done.err


@pytest.mark.parametrize("info", [3, [], "x", None, {}])
def test_metadata_that_is_no_object_or_empty_is_refused_in_one_line(aolab, info):
    save_png("b.png", np.zeros((2, 2, 3), np.uint8), info)
    done = aolab("render", "--like", "b.png")
    assert (done.code, done.err.count("\n")) == (2, 1)
    assert "b.png: its aolab metadata is " in done.err


# --- how it refuses

REFUSED = {
    "unknown scene": (("boxs",), r"no scene 'boxs'.*did you mean 'boxes'"),
    "unknown scene parameter": (("boxes?swop=1",), r"scene 'boxes' has no parameter 'swop'; did you mean 'swap'"),
    "missing file": (("nothing.glb",), r"no(t| ).*nothing\.glb"),
    "no scene": ((), r"which scene\? .*aolab scenes"),
    "unknown module": (("boxes", "--module", "sao"), r"no module 'sao'; did you mean 'ssao'"),
    "unknown parameter": (("boxes", "--set", "radus=1"), r"ssao has no parameter 'radus'; did you mean 'radius'"),
    "out of range": (("boxes", "--set", "directions=0"), r"ssao: directions = 0 is not valid: int, ≥ 1, ≤ 256"),
    "out of range, with a unit": (("boxes", "--set", "bias=-1"), r"bias = -1 is not valid: float, ≥ 0, ≤ 1, in radii"),
    "not a number": (("boxes", "--set", "radius=far"), r"radius = 'far' is not valid: float or auto, > 0, in scene"),
    "not finite": (("boxes", "--set", "radius=Infinity"), r"radius = inf is not valid"),
    "no value": (("boxes", "--set", "radius"), r"--set radius: write KEY=VALUE"),
    "unknown occluders": (("boxes", "--occluders", "deep"), r"occluders = 'deep' is not valid: depth"),
    "size of one number": (("boxes", "--size", "100"), r"size = '100' is not WIDTHxHEIGHT, as in 1280x720"),
    "size of zero": (("boxes", "--size", "0x10"), r"size = 0x10: each side must be from 1 to \d+ pixels"),
    "size beyond the limit": (("boxes", "--size", "99999x1"), r"size = 99999x1: each side must be from 1 to \d+"),
    "negative seed": (("boxes", *SMALL, "--seed", "-1"), r"seed = -1 is not a whole number from 0 on"),
    "an axis that is none": (("knot.glb", "--up-axis", "x"), r"up_axis = 'x' is not valid"),
    "an axis of a scene of code": (("boxes", "--up-axis", "z"), r"scene 'boxes' has no parameter 'up_axis'"),
    "accumulate for ever": (("boxes", *SMALL, "--accumulate", "9" * 30), r"accumulate = 9+ is not a whole number from"),
    "a number of 5000 digits": (("boxes", *SMALL, "--set", f"radius={'9' * 5000}"), r"radius = '9+\.\.\.9+' is not"),
    "accumulate nothing": (
        ("boxes", *SMALL, "--accumulate", "0"),
        r"accumulate = 0 is not a whole number from 1 to 16",
    ),
    "eye of two numbers": (("boxes", "--eye", "1,2"), r"--eye 1,2 is not three numbers X,Y,Z"),
    "eye on the target": (("boxes", "--eye", "1,1,1", "--target", "1,1,1"), r"eye and target are both"),
    "fov of a half circle": (("boxes", "--fov", "180"), r"fov = 180(\.0)? is outside \(0, 180\) degrees"),
    "exposure of zero": (("boxes", *SMALL, "--exposure", "0"), r"exposure = 0\.0 is not a number above 0"),
    "unknown tone map": (("boxes", *SMALL, "--tone-map", "aces"), r"tone_map = 'aces' is not one of: filmic, linear"),
    "like a missing file": (("--like", "nothing.png"), r"no file nothing\.png"),
    "picture of another kind": (("boxes", "-o", "a.jpg"), r"cannot write a\.jpg: images are written as \.png"),
    "no folder": (("boxes", "-o", "missing/a.png"), r"cannot write missing/a\.png: the folder missing does not exist"),
    "no folder for buffers": (("boxes", "--buffers", "missing/a.npz"), r"cannot write missing/a\.npz: the folder"),
    "no folder for stats": (("boxes", "--stats", "missing/a.json"), r"cannot write missing/a\.json: the folder"),
    "unknown option": (("boxes", "--colour", "red"), r"[Nn]o such option:? '?--colour"),
    "option without its value": (("boxes", "--size"), r"[Oo]ption '?--size'? requires an argument"),
    "seed that is no number": (("boxes", "--seed", "x"), r"Invalid value for '--seed'"),
    "two files of one name": (("boxes", "-o", "a.png", "--stats", "./a.png"), r"cannot write two things to one file"),
    "size of many digits": (("boxes", "--size", f"{'9' * 5000}x9"), r"size = '9{40}' is not WIDTHxHEIGHT"),
    "a name of many letters": (("x" * 300,), r"File name too long"),
    "a module of many letters": (("boxes", "--module", "x" * 300), r"no module 'x{80}\.\.\.'"),
    "an output of many letters": (("boxes", "-o", "x" * 300 + ".png"), r"the name has more than 255 bytes"),
    "up of two numbers": (("boxes", "--up", "1,2"), r"--up 1,2 is not three numbers X,Y,Z"),
    "up along the view": (("boxes", "--up", "0,0,1", "--eye", "0,0,5", "--target", "0,0,0"), r"up = .* is parallel"),
    "buffers of another kind": (("boxes", "--buffers", "a.txt"), r"a\.txt: buffers are written as \.npz or \.exr"),
    "unknown buffer": (("boxes", *SMALL, "--buffer", "visibilty"), r"no buffer 'visibilty'; did you mean 'visibility'"),
    "a file that is missing": (("boxes", "--module", "a.py:Mine"), r"no file a\.py"),
    "a shader that is missing": (("boxes", "--shader", "a.frag"), r"no file a\.frag"),
    "a shader as the module": (("boxes", "--module", "a.frag"), r"'a\.frag' is a shader: write a\.frag:MODULE"),
    "a declaration without a shader": (("boxes", "--like-module", "ssao"), r"--like-module ssao needs --shader"),
    "two declarations": (
        ("boxes", "--shader", "a.frag", "--like-module", "ssao", "--module", "ssdo"),
        r"give --like-module or --module, not both",
    ),
    "two scenes": (("boxes", "cornell"), r"unexpected .cornell.: a command takes one scene"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_an_impossible_request_is_refused_in_one_line(aolab, case, tmp_path):
    arguments, message = REFUSED[case]
    done = aolab("render", *arguments)
    assert done.code == 2
    assert done.out == ""
    assert done.err.startswith("aolab: ")
    assert done.err.count("\n") == 1
    assert re.search(message, done.err), done.err
    assert list(tmp_path.iterdir()) == []  # nothing was written


@pytest.mark.parametrize("option", ["-o", "--buffers", "--stats"])
def test_a_file_that_cannot_be_written_is_refused_before_the_work(aolab, option, monkeypatch):
    def work(*_: object, **__: object) -> None:
        raise AssertionError("rendered first")

    monkeypatch.setattr(Lab, "render", work)
    name = {"-o": "a.png", "--buffers": "a.npz", "--stats": "a.json"}[option]
    assert aolab("render", "boxes", option, f"missing/{name}").code == 2


def test_an_old_picture_survives_a_failure_to_write(aolab, monkeypatch):
    assert aolab("render", "boxes", *SMALL, "-o", "a.png").code == 0
    before = Path("a.png").read_bytes()

    def full(self: Image.Image, file, *_: object, **__: object) -> None:
        file.write(b"half")
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(Image.Image, "save", full)
        done = aolab("render", "cornell", *SMALL, "-o", "a.png")
    assert (done.code, done.err) == (2, "aolab: cannot write a.png: No space left on device\n")
    assert Path("a.png").read_bytes() == before
    assert [path.name for path in Path().iterdir()] == ["a.png"]
    assert aolab("render", "cornell", *SMALL, "-o", "a.png").code == 0
    assert Path("a.png").read_bytes() != before


def test_a_shader_that_does_not_compile_is_an_error_of_the_shell_too(aolab, shaders):
    (shaders / "none.frag").write_text("// broken\nvoid main() { oops; }\n")
    done = aolab("render", "boxes", *SMALL, "--module", "none")
    assert done.code == 2
    assert "glsl/none.frag:2: " in done.err
    assert done.err.count("\n") == 1
    assert "Traceback" not in done.err
