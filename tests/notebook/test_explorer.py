"""`aolab.explore`: the browser sends wishes, Python answers with pictures. The browser's side: test_jupyterlab.py."""

import asyncio
import threading
from io import BytesIO

import numpy as np
import pytest
from PIL import Image

import aolab
from aolab import Camera, ParameterError
from aolab.modules import MODULES
from aolab.modules.parameters import own_first
from aolab.notebook.controls import controls

pytestmark = pytest.mark.slow

SIZE = (64, 48)


@pytest.fixture(scope="module")
def explorer(boxes):
    return aolab.explore(boxes, "ssao", size=SIZE, accumulate=2, radius=0.5)


def ask(explorer, **wish):
    """Set a wish as the browser does; returns the reply."""
    number = explorer.wish["number"] + 1
    explorer.set_state({"wish": {"number": number, "module": "ssao", "parameters": {}, **wish}})
    assert explorer.reply["number"] == number
    return explorer.reply


def pixels(explorer) -> np.ndarray:
    return np.asarray(Image.open(BytesIO(explorer.picture)).convert("RGB"))


def test_it_starts_with_the_picture_of_its_arguments(boxes, lab):
    explorer = aolab.explore(boxes, "ssao", size=SIZE, accumulate=2, radius=0.5)
    assert (pixels(explorer) == lab.render(boxes, "ssao", size=SIZE, accumulate=2, radius=0.5).image).all()
    assert explorer.module.radius == 0.5


@pytest.mark.parametrize("module", MODULES)
def test_every_parameter_has_a_control_whose_ends_are_valid(boxes, module):
    cls = MODULES[module]
    found = controls(cls, boxes)
    assert [control["name"] for control in found] == own_first(cls)
    for control in found:
        where = {control["with"][0]: control["with"][1]} if control["with"] else {}
        if control["kind"] == "choice":
            values = control["choices"]
        elif control["kind"] == "bool":
            values = [False, True]
        elif control["kind"] == "text":
            values = [control["default"]]
        else:
            cast = int if control["kind"] == "int" else float
            values = [cast(control["low"]), cast(control["high"])]
            assert control["low"] <= control["resolved"] <= control["high"], control
        for value in values:
            cls(**{**where, control["name"]: value})  # raises if the value is out of range


def test_a_moving_image_is_a_jpeg_of_fewer_pixels_and_everything_else_a_png(explorer, monkeypatch):
    monkeypatch.setattr("aolab.notebook.explorer.MOVING_MS", 1e-3)
    for _ in range(2):
        ask(explorer, moving=True)
    assert explorer.picture[:3] == b"\xff\xd8\xff"
    assert pixels(explorer).shape == (12, 16, 3)
    ask(explorer, moving=True, buffer="visibility")
    assert explorer.picture[:4] == b"\x89PNG"
    ask(explorer)
    assert explorer.picture[:4] == b"\x89PNG"
    assert pixels(explorer).shape == (48, 64, 3)


def test_an_error_is_shown_and_the_picture_stays(explorer):
    ask(explorer)
    before = explorer.picture
    reply = ask(explorer, parameters={"radius": -1})
    assert "radius = -1 is not valid" in reply["error"]
    assert explorer.picture == before
    assert not ask(explorer)["error"]


def test_parameters_of_another_choice_are_left_out(explorer):
    reply = ask(explorer, parameters={"layers": 3})
    assert not reply["error"]
    ask(explorer, parameters={"layers": 3, "occluders": "layers"})
    assert explorer.module.layers == 3


def test_the_camera_orbits(explorer, boxes):
    ask(explorer, azimuth=90, elevation=0)
    home = boxes.camera
    assert explorer.camera == home.orbited(90)
    assert np.linalg.norm(np.subtract(explorer.camera.eye, home.target)) == pytest.approx(
        np.linalg.norm(np.subtract(home.eye, home.target))
    )


def test_the_code_renders_the_same_picture(lab):
    explorer = aolab.explore("boxes", "ssdo", size=SIZE, accumulate=2)
    reply = ask(explorer, module="ssdo", parameters={"radius": 0.3, "occluders": "layers"}, azimuth=10)
    frame = eval(reply["code"], {"aolab": aolab})  # ours
    difference = np.abs(frame.image.astype(int) - pixels(explorer))  # the code's camera is rounded
    assert np.median(difference) == 0


def test_truth_and_error_are_shown_on_demand(explorer):
    reply = ask(explorer, buffer="visibility", view="truth")
    assert "visibility: RMSE 0." in reply["text"]
    truth = pixels(explorer)
    ask(explorer, buffer="visibility", view="error")
    assert (pixels(explorer) != truth).any()
    assert explorer.bar


@pytest.mark.parametrize("module", [name for name in MODULES if name not in ("none", "ssao")])
def test_a_clicked_pixel_of_every_module_shows_its_samples(explorer, module):
    reply = ask(explorer, module=module, parameters={}, pixel=[32, 40])
    assert f"pixel (32, 40) of {module}\n" in reply["samples"]
    assert "replay and shader differ by" in reply["samples"]
    assert explorer.samples[:4] == b"\x89PNG"


def test_a_clicked_pixel_shows_its_samples(explorer):
    assert "pixel (32, 40) of ssao" in ask(explorer, pixel=[32, 40])["samples"]
    assert explorer.samples[:4] == b"\x89PNG"
    reply = ask(explorer, module="none", pixel=[32, 40])
    assert "takes no samples" in reply["samples"]
    assert not reply["error"]


def test_the_latest_wish_of_another_thread_wins(boxes):
    async def notebook():
        explorer = aolab.explore(boxes, "ssao", size=SIZE)

        def callbacks():
            for number in range(1, 6):
                wish = {"number": number, "module": "ssao", "parameters": {"directions": number}}
                explorer.set_state({"wish": wish})

        frames = []
        explorer.observe(lambda change: frames.append(change["new"]["number"]), names="reply")
        thread = threading.Thread(target=callbacks)
        thread.start()
        thread.join()  # the loop stands still: all wishes arrive during one frame
        while not frames or frames[-1] < 5:
            await asyncio.sleep(0.01)
        return explorer, frames

    explorer, frames = asyncio.run(notebook())
    assert explorer.module.directions == 5
    assert frames == [5]


def test_your_own_module_is_in_the_menu(boxes):
    class Own(aolab.Module):
        name = "own"
        shader = "out float visibility;\nuniform float grey;\nvoid main() { visibility = grey; }"
        grey: float = aolab.parameter(0.5, "A constant.", ge=0, le=1)

    explorer = aolab.explore(boxes, Own, size=SIZE)
    assert explorer.statement["own"][0]["name"] == "grey"
    ask(explorer, module="own", parameters={"grey": 0.25}, buffer="visibility")
    assert explorer.frame["visibility"][explorer.frame.mask] == pytest.approx(0.25, abs=1e-3)


def test_viewers_without_widgets_get_a_picture(explorer):
    ask(explorer)
    data = explorer._repr_mimebundle_()[0]
    assert data["image/png"] == explorer.frame._repr_png_()
    assert "application/vnd.jupyter.widget-view+json" in data


def test_without_anywidget_the_error_names_the_package(boxes, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "aolab.notebook.explorer", None)
    with pytest.raises(ParameterError, match="pip install anywidget"):
        aolab.explore(boxes)


def test_a_camera_orbits_around_its_target():
    camera = Camera((0, 0, 4), (0, 0, 0))
    assert camera.orbited(azimuth=90).eye == pytest.approx((4, 0, 0))
    assert camera.orbited(elevation=30, zoom=2).eye == pytest.approx((0, 1, np.sqrt(3)))
    assert camera.orbited(elevation=500).eye[1] == pytest.approx(4 * np.sin(np.radians(89)))
