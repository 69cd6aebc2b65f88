"""`aolab view`: keys, drags and the panel change the picture; a window on an X server shows it."""

import os
import shutil
import struct
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import aolab
from aolab.modules import MODULES
from aolab.notebook.viewer import CHOSEN, LINE, MARGIN, Viewer

SIZE = (200, 120)


@pytest.fixture
def viewer(boxes) -> Viewer:
    return Viewer(boxes, aolab.SSAO(radius=0.4), SIZE, rays=4)


def below(picture: np.ndarray) -> np.ndarray:
    """The picture without its lines of text."""
    return picture[60:]


def test_the_picture_is_the_render(viewer, boxes):
    frame = aolab.render(boxes, "ssao", radius=0.4, size=SIZE)
    np.testing.assert_array_equal(below(viewer.picture()), below(frame.image))
    assert not viewer.stale


def test_keys_choose_module_and_buffer(viewer, boxes):
    viewer.picture()
    viewer.press("m")
    assert viewer.stale
    names = list(MODULES)
    following = names[names.index("ssao") + 1]
    viewer.picture()
    assert (viewer.module_name, viewer.module.radius) == (following, 0.4)  # a parameter of both stays
    viewer.press("m", shift=True)
    assert viewer.module_name == "ssao"
    viewer.buffer = "viewZ"
    viewer.press("b")
    assert viewer.buffer == "visibility"
    expected = aolab.render(boxes, "ssao", radius=0.4, size=SIZE)["visibility"]
    seen = below(viewer.picture())[..., 0] / 255
    np.testing.assert_allclose(seen, np.nan_to_num(below(expected), nan=seen.max()), atol=0.3)
    viewer.press("unknown")
    assert not viewer.stale


def test_the_truth_and_the_error(viewer, boxes):
    viewer.buffer = "visibility"
    result = below(viewer.picture())
    viewer.press("t")
    truth = below(viewer.picture())
    viewer.press("t")
    error = below(viewer.picture())
    assert viewer.view == "error"
    assert np.abs(truth.astype(int) - result).max() > 10
    assert (error[..., 0] != error[..., 2]).any()  # both signs have their colour
    viewer.press("t")
    np.testing.assert_array_equal(below(viewer.picture()), result)


def test_a_drag_orbits_and_r_returns(viewer, boxes):
    start = below(viewer.picture())
    viewer.drag(100, -20)
    assert viewer.moving
    viewer.rest()
    viewer.scroll(2)
    camera = boxes.camera.orbited(-40, -8, zoom=1.21)
    np.testing.assert_allclose(viewer.camera.eye, camera.eye, atol=1e-6)
    turned = below(viewer.picture())
    np.testing.assert_array_equal(
        turned, below(aolab.render(boxes, "ssao", radius=0.4, size=SIZE, camera=camera).image)
    )
    viewer.press("r")
    np.testing.assert_array_equal(below(viewer.picture()), start)


def test_the_panel_changes_a_parameter(viewer):
    without = viewer.picture()
    before = dict(viewer.parameters)
    viewer.press("right")  # no panel, no effect
    assert viewer.parameters == before
    viewer.press("p")
    assert (viewer.picture() != without).any()
    names = [one["name"] for one in viewer._controls]
    for _ in range(names.index("radius")):
        viewer.press("down")
    viewer.press("right")
    assert viewer.parameters["radius"] > 0.4
    viewer.press("left")
    viewer.press("left")
    assert viewer.parameters["radius"] < 0.4
    for _ in range(names.index("occluders") - names.index("radius")):
        viewer.press("down")
    viewer.press("right")
    assert viewer.parameters["occluders"] == "layers"
    assert "layers" in [one["name"] for one in viewer._controls]  # its own parameters appear


def test_every_parameter_of_every_module_can_be_changed(viewer):
    viewer.press("p")
    for _ in MODULES:
        for _ in viewer._controls:
            viewer.press("right")
            assert viewer.module
            viewer.press("down")
        viewer.press("m")


@pytest.mark.parametrize(("module", "name"), [("ssao", "radius"), ("instant_radiosity", "vpl_clamp")])
def test_a_length_that_is_auto_steps_to_a_number(boxes, module, name):
    viewer = Viewer(boxes, aolab.modules.find(module, MODULES), SIZE)
    viewer.press("p")
    for _ in range([one["name"] for one in viewer._controls].index(name)):
        viewer.press("down")
    assert (f"> {name} = auto", CHOSEN) in viewer._panel_lines(40)
    viewer.press("right")
    assert viewer.parameters[name] > 0
    assert any(text.startswith(f"> {name} = ") and text.endswith(" scene units") for text, _ in viewer._panel_lines(40))


def test_an_error_is_written_in_the_picture(viewer):
    viewer.parameters["radius"] = -1
    picture = viewer.picture()
    assert picture.shape == (120, 200, 3)
    assert picture[: LINE + MARGIN].any()
    assert not picture[-10:].any()


def test_the_picture_is_saved(viewer, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    viewer.press("s")
    np.testing.assert_array_equal(below(np.asarray(Image.open("view-1.png"))), below(viewer.picture()))


def without_display(monkeypatch):
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)


@pytest.mark.slow
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="other systems have a display")
def test_a_machine_without_a_display_gets_a_sentence(monkeypatch):
    pytest.importorskip("glfw")
    without_display(monkeypatch)
    done = subprocess.run([sys.executable, "-m", "aolab.shell.cli", "view", "boxes"], capture_output=True, text=True)
    assert done.returncode == 2
    assert "no window can be opened here" in done.stderr
    assert "`aolab render` writes a picture" in done.stderr
    assert "Traceback" not in done.stderr


SCRIPT = """
import sys
import glfw, numpy as np
import aolab
from aolab.notebook.viewer import Viewer
from aolab.notebook.window import Window

viewer = Viewer(aolab.load("boxes"), aolab.SSAO(radius=0.4), (200, 120))
window = Window(viewer)
def shown(name):
    window.draw()
    np.save(name, viewer.picture())
    print(name, flush=True)
    sys.stdin.readline()  # until the screen was read
shown("first.npy")
for key in (glfw.KEY_M,):
    window._key(window._window, key, glfw.get_key_scancode(key), glfw.PRESS, 0)
window._button(window._window, 0, glfw.PRESS, 0)
window._move(window._window, *(place + 50 for place in glfw.get_cursor_pos(window._window)))
window._button(window._window, 0, glfw.RELEASE, 0)
shown("second.npy")
window._key(window._window, glfw.KEY_ESCAPE, 0, glfw.PRESS, 0)
window.run()
print(viewer.module_name, flush=True)
"""


def screen(folder: Path) -> np.ndarray:
    """(H, W, 3) uint8: the pixels of Xvfb's screen, a file in XWD format."""
    data = (folder / "Xvfb_screen0").read_bytes()
    head = struct.unpack(">25I", data[:100])
    start, width, height, row, colors = head[0], head[4], head[5], head[12], head[19]
    pixels = np.frombuffer(data, np.uint8, row * height, start + 12 * colors).reshape(height, row // 4, 4)
    return pixels[:, :width, 2::-1]


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("Xvfb") is None, reason="no Xvfb: an X server without a screen")
def test_a_window_shows_the_picture(tmp_path):
    pytest.importorskip("glfw")
    read, write = os.pipe()
    command = [
        "Xvfb",
        "-displayfd",
        str(write),
        "-screen",
        "0",
        "200x120x24",
        "-fbdir",
        str(tmp_path),
        "-nolisten",
        "tcp",
    ]
    server = subprocess.Popen(command, pass_fds=[write], stderr=subprocess.DEVNULL)
    try:
        environment = {**os.environ, "DISPLAY": f":{os.read(read, 20).decode().strip()}"}
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
        with subprocess.Popen([sys.executable, "-c", SCRIPT], cwd=tmp_path, env=environment, **pipes) as child:
            for name in ("first.npy", "second.npy"):
                assert child.stdout.readline().strip() == name
                expected = np.load(tmp_path / name)
                deadline = time.monotonic() + 10
                while _differs(screen(tmp_path), expected) and time.monotonic() < deadline:
                    time.sleep(0.05)
                assert not _differs(screen(tmp_path), expected)
                child.stdin.write("\n")
                child.stdin.flush()
            assert child.stdout.readline().strip() != "ssao"
        assert child.returncode == 0
        assert np.abs(np.load(tmp_path / "first.npy").astype(int) - np.load(tmp_path / "second.npy")).mean() > 5
    finally:
        server.kill()
        server.wait()
        os.close(read)
        os.close(write)


def _differs(seen: np.ndarray, expected: np.ndarray) -> bool:
    """Without the lines of facts, whose milliseconds change."""
    return bool((below(seen) != below(expected)).any())
