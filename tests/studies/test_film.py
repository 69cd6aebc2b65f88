"""Films: the camera's way, the formats, and what is refused."""

import itertools
import json

import numpy as np
import pytest
from PIL import Image

import aolab
from aolab.errors import Error, FileError, ParameterError
from aolab.scene.camera import Camera
from aolab.studies.film import along, parse_range, read_path

SMALL = {"size": (64, 36), "seconds": 0.5, "fps": 8, "radius": 0.3}


def pictures(path) -> list[np.ndarray]:
    with Image.open(path) as film:
        found = []
        for number in range(film.n_frames):
            film.seek(number)
            found.append(np.asarray(film.convert("RGB")))
    return found


def test_an_orbit_shows_what_a_turned_camera_sees(tmp_path):
    out = aolab.animate("boxes", out=tmp_path / "%02d.png", orbit=True, **SMALL)
    assert out == tmp_path / "%02d.png"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["00.png", "01.png", "02.png", "03.png"]
    camera = aolab.load("boxes").camera
    eye, target = np.asarray(camera.eye), np.asarray(camera.target)
    half = target + (eye - target) * (-1, 1, -1)  # half a turn around the vertical
    there = aolab.render("boxes", radius=0.3, size=(64, 36), camera=Camera(tuple(half), camera.target, fov=camera.fov))
    seen = np.asarray(Image.open(tmp_path / "02.png"))
    assert np.abs(seen.astype(int) - there.image).mean() < 1


@pytest.mark.parametrize("suffix", ["webp", "gif"])
def test_formats_that_loop(tmp_path, suffix):
    out = aolab.animate("toasters", out=tmp_path / f"film.{suffix}", vary={"time": (0, 4)}, **SMALL)
    found = pictures(out)
    assert len(found) == 4
    assert found[0].shape == (36, 64, 3)
    assert np.abs(found[0].astype(int) - found[2]).mean() > 1  # the scene moves


def test_mp4_holds_the_pictures(tmp_path):
    av = pytest.importorskip("av")
    out = aolab.animate("boxes", out=tmp_path / "film.mp4", orbit=90, **{**SMALL, "size": (65, 37)})
    with av.open(out) as film:
        frames = [frame.to_ndarray(format="rgb24") for frame in film.decode(video=0)]
        assert float(film.streams.video[0].average_rate) == 8
    first = aolab.render("boxes", radius=0.3, size=(65, 37)).image
    assert len(frames) == 4
    assert frames[0].shape == (38, 66, 3)
    assert np.abs(frames[0][:37, :65].astype(int) - first).mean() < 8  # H.264 with halved chroma


def test_two_modules_share_the_picture_and_a_parameter_of_both_changes(tmp_path):
    aolab.animate(
        "boxes", "ssao", beside="none", out=tmp_path / "%d.png", buffer="visibility", size=(64, 36), seconds=0.25, fps=8
    )
    seen = np.asarray(Image.open(tmp_path / "0.png"))
    ssao, none = (aolab.render("boxes", name, size=(64, 36))["visibility"] for name in ("ssao", "none"))
    expected = np.nan_to_num(np.where(np.arange(64) < 32, ssao, none), nan=1) * 255
    away = np.abs(np.arange(64) - 31.5) > 1
    assert np.abs(seen[:, away, 0] - expected[:, away]).max() <= 1


def test_a_path_goes_through_its_cameras(tmp_path):
    cameras = [Camera((0, 1, 4), (0, 0, 0)), Camera((2, 1, 3), (0, 0, 0), fov=30), Camera((4, 2, 0), (0, 1, 0))]
    for index, camera in enumerate(cameras):
        found = along(cameras, index / 2)
        assert np.allclose([*found.eye, *found.target, found.fov], [*camera.eye, *camera.target, camera.fov])
    steps = [np.asarray(along(cameras, t).eye) for t in np.linspace(0, 1, 41)]
    assert max(np.linalg.norm(b - a) for a, b in itertools.pairwise(steps)) < 0.3  # no jump
    file = tmp_path / "path.json"
    file.write_text(json.dumps([{"eye": c.eye, "target": c.target, "fov": c.fov} for c in cameras]))
    assert read_path(file) == cameras


@pytest.mark.parametrize(
    ("arguments", "error", "words"),
    [
        ({"out": "film.avi"}, FileError, "cannot write film.avi: a film is one of .mp4, .webp, .gif"),
        ({"out": "%s.png"}, FileError, "no folder|not a pattern|cannot write"),
        ({"out": "nowhere/film.gif"}, FileError, "the folder nowhere does not exist"),
        ({"vary": {"tyme": (0, 1)}}, ParameterError, "neither the scene nor every module has 'tyme'.*time"),
        ({"seconds": 0}, ParameterError, "seconds = 0 is not a number above 0"),
        ({"seconds": "a"}, ParameterError, "seconds = 'a' is not a number above 0"),
        ({"orbit": "left"}, ParameterError, "orbit = 'left' is not True, False or a number of degrees"),
        ({"path": 5}, ParameterError, "path = 5 is not a list of cameras"),
        ({"vary": {"radius": 5}}, ParameterError, r"vary = {'radius': 5} is not {parameter: \(first, last\)}"),
        ({"fps": 0}, ParameterError, "fps = 0 is not a whole number"),
        ({"path": [Camera((0, 0, 1), (0, 0, 0))]}, ParameterError, "a path needs at least two"),
    ],
)
def test_refused_before_any_work(arguments, error, words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    arguments = {"out": "film.gif", **arguments}
    if arguments["out"] == "%s.png":
        arguments["out"] = "%z.png"
    with pytest.raises(error, match=words):
        aolab.animate("toasters", size=(64, 36), **arguments)


def test_a_range_in_words():
    assert parse_range("time=0:6") == ("time", (0.0, 6.0))
    with pytest.raises(Error, match="is not NAME=FIRST:LAST"):
        parse_range("time=6")
