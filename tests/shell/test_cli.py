"""The shell: what it writes, and how it refuses: one line on stderr, exit code 2, nothing lost."""

import json
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from aolab import Lab
from aolab.modules import MODULES
from aolab.pictures.metadata import read_png
from aolab.shell import cli

SMALL = ("--size", "24x16")


@dataclass
class Outcome:
    code: int
    out: str
    err: str


@pytest.fixture
def aolab(gl, monkeypatch, capsys, tmp_path) -> Callable[..., Outcome]:
    """Runs a command in an empty folder: `aolab("render", "boxes")`."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments: str | Path) -> Outcome:
        monkeypatch.setattr(sys, "argv", ["aolab", *map(str, arguments)])
        with pytest.raises(SystemExit) as ended:
            cli.main()
        code = ended.value.code
        captured = capsys.readouterr()
        return Outcome(0 if code is None else int(code), captured.out, captured.err)

    return run


def pixels(path: Path | str) -> np.ndarray:
    with Image.open(path) as image:
        return np.asarray(image)


# --- what it writes


def test_the_least_that_one_can_say(aolab):
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


def test_a_part_of_the_camera_may_be_said(aolab):
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


def test_like_with_another_occluder_kind_drops_the_parameters_of_the_old_kind(aolab):
    aolab("render", "boxes", *SMALL, "--occluders", "views", "--set", "views=2", "-o", "a.png")
    done = aolab("render", "--like", "a.png", "--occluders", "layers", "-o", "b.png")
    assert done.code == 0, done.err
    parameters = read_png("b.png")["parameters"]
    assert parameters["layers"] == 4
    assert "views" not in parameters


def test_stats_and_buffers_are_written_as_the_design_says(aolab):
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


# --- lists


def test_modules_as_json_is_their_schema(aolab):
    done = aolab("modules", "--json")
    schemas = json.loads(done.out)
    assert list(schemas) == list(MODULES)
    for name, schema in schemas.items():
        assert schema == MODULES[name].model_json_schema()
        assert schema["type"] == "object"
        assert schema["additionalProperties"] is False
        for parameter in schema["properties"].values():
            assert parameter["description"]
            assert "default" in parameter
    directions = schemas["ssao"]["properties"]["directions"]
    assert (directions["type"], directions["minimum"], directions["maximum"]) == ("integer", 1, 256)
    assert schemas["ssao"]["properties"]["radius"]["unit"] == "scene units"
    assert list(json.loads(aolab("modules", "ssao", "--json").out)) == ["ssao"]


def test_modules_for_people(aolab):
    out = aolab("modules", "ssao").out
    for module in MODULES["ssao"].model_fields:
        assert f"\n  {module} = " in out
    default = MODULES["ssao"].model_fields["directions"].default
    assert f"  directions = {default}  (int, ≥ 1, ≤ 256)\n      Directions a pixel (N)" in out
    assert "none: " not in out
    assert all(f"{name}: " in aolab("modules").out for name in MODULES)


def test_scenes(aolab):
    scenes = json.loads(aolab("scenes", "--json").out)
    assert {"cornell", "boxes", "skyscrapers", "colonnade", "atrium", "toasters"} <= set(scenes)
    assert all(scene["summary"] for scene in scenes.values())
    assert scenes["boxes"]["parameters"] == {"swap": False, "light": 1.0, "ambient": 1.0}
    out = aolab("scenes").out
    assert all(name in out for name in scenes)


def test_help_is_no_error(aolab):
    assert aolab() == aolab("--help")
    for command in ((), ("render",), ("modules",), ("scenes",), ("doctor",), ("bench",)):
        done = aolab(*command, "--help")
        assert (done.code, done.err) == (0, "")
        assert "Usage: aolab" in done.out


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
    "accumulate nothing": (("boxes", *SMALL, "--accumulate", "0"), r"accumulate = 0 is not a whole number from 1 on"),
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
    "two scenes": (("boxes", "cornell"), r"unexpected extra argument.*cornell"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_cannot_be_done_is_refused_in_one_line(aolab, case, tmp_path):
    import re

    arguments, message = REFUSED[case]
    done = aolab("render", *arguments)
    assert done.code == 2
    assert done.out == ""
    assert done.err.startswith("aolab: ")
    assert done.err.count("\n") == 1
    assert re.search(message, done.err), done.err
    assert list(tmp_path.iterdir()) == []  # nothing was written


@pytest.mark.parametrize(
    "arguments", [("rendr",), ("modules", "sao"), ("bench", "--frames", "1"), ("bench", "--size", "x")]
)
def test_other_commands_refuse_alike(aolab, arguments):
    done = aolab(*arguments)
    assert (done.code, done.out) == (2, "")
    assert done.err.startswith("aolab: ")
    assert done.err.count("\n") == 1


@pytest.mark.parametrize("option", ["-o", "--buffers", "--stats"])
def test_what_cannot_be_written_is_said_before_the_work(aolab, option, monkeypatch):
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


def test_debug_shows_where_an_error_came_from(python):
    run = "import sys; sys.argv = ['aolab', *{!r}]; from aolab.shell.cli import main; main()"
    quiet = python(run.format(["render", "boxs"]))
    assert quiet.returncode == 2
    assert quiet.stderr.count("\n") == 1
    loud = python(run.format(["--debug", "render", "boxs"]))
    assert loud.returncode not in (0, None)
    assert "Traceback" in loud.stderr
    assert loud.stderr.rstrip().splitlines()[-1].startswith("aolab.errors.FileError: no scene 'boxs'")


def test_the_installed_command_is_this_one():
    from importlib.metadata import entry_points

    (script,) = (point for point in entry_points(group="console_scripts") if point.name == "aolab")
    assert script.load() is cli.main
