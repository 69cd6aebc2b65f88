"""`aolab.explore` in a real JupyterLab, in headless Chromium: a slider, a drag, a click, an error, a menu."""

import json
import os
import re
import socket
import subprocess
import sys
import time
import urllib.request
from collections.abc import Callable, Iterator
from pathlib import Path

import nbformat
import pytest

pytestmark = [pytest.mark.browser, pytest.mark.slow]

CELL = """import aolab
explorer = aolab.explore("boxes", "ssao", size=(160, 90), accumulate=1)
explorer"""
PATIENCE = 120_000  # milliseconds: a busy machine needs a minute to start a kernel


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """The address of a JupyterLab with one notebook, explore.ipynb."""
    folder = tmp_path_factory.mktemp("jupyterlab")
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(CELL)])
    notebook.metadata["kernelspec"] = {"name": "python3", "display_name": "Python 3", "language": "python"}
    nbformat.write(notebook, folder / "explore.ipynb")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    settings = [f"--port={port}", f"--ServerApp.root_dir={folder}", "--IdentityProvider.token=", "--no-browser"]
    private = {name: str(folder / name) for name in ("JUPYTER_CONFIG_DIR", "JUPYTER_RUNTIME_DIR", "IPYTHONDIR")}
    path = os.pathsep.join([str(Path(__file__).parents[2]), os.environ.get("PYTHONPATH", "")])
    log = (folder / "log").open("w")
    running = subprocess.Popen(
        [sys.executable, "-m", "jupyterlab", "--allow-root", *settings],
        cwd=folder,
        env={**os.environ, **private, "PYTHONPATH": path},
        stdout=subprocess.DEVNULL,
        stderr=log,
    )
    address = f"http://127.0.0.1:{port}"
    try:
        for _ in range(240):
            assert running.poll() is None, (folder / "log").read_text()
            try:
                urllib.request.urlopen(f"{address}/api", timeout=5).close()
                break
            except OSError:
                time.sleep(0.5)
        yield address
    finally:
        running.terminate()
        running.wait(timeout=60)
        log.close()


@pytest.fixture(scope="module")
def page(chromium, server: str):
    """The notebook's page, with its cell run."""
    page = chromium.new_page(viewport={"width": 1300, "height": 900})
    page.set_default_timeout(PATIENCE)
    page.goto(f"{server}/lab/tree/explore.ipynb")
    page.locator(".jp-Notebook .cm-content").first.click()
    page.locator(".jp-Notebook-ExecutionIndicator[data-status=idle]").wait_for(state="attached")
    page.keyboard.press("Shift+Enter")
    page.get_by_label("Render. Arrow keys").wait_for()
    return page


@pytest.fixture
def picture(page) -> Callable[[], str]:
    """The pixels of the render on the page, as a data URL, once no frame is in flight."""

    def seen() -> str:
        image = page.get_by_label("Render. Arrow keys").locator("img")
        return image.evaluate(
            """async (image) => {
                await image.decode();
                const canvas = Object.assign(document.createElement("canvas"), { width: 160, height: 90 });
                canvas.getContext("2d").drawImage(image, 0, 0, 160, 90);
                return canvas.toDataURL();
            }"""
        )

    return seen


def until(page, changed: Callable[[], bool], what: str) -> None:
    for _ in range(PATIENCE // 200):
        if changed():
            return
        page.wait_for_timeout(200)
    raise AssertionError(f"not within {PATIENCE / 1000:g} s: {what}")


def test_a_slider_changes_the_picture(page, picture):
    before = picture()
    slider = page.get_by_role("slider", name="power")
    slider.focus()
    page.keyboard.press("End")
    until(
        page,
        lambda: "power=8" in page.get_by_role("textbox", name="code").input_value(),
        "the code has the slider's value",
    )
    until(page, lambda: picture() != before, "the picture changes")


def test_a_drag_orbits_the_camera(page, picture):
    before, code = picture(), page.get_by_role("textbox", name="code").input_value()
    box = page.get_by_label("Render. Arrow keys").locator("img").bounding_box()
    page.mouse.move(box["x"] + 80, box["y"] + 45)
    page.mouse.down()
    for step in range(1, 9):
        page.mouse.move(box["x"] + 80 + 5 * step, box["y"] + 45)
    page.mouse.up()
    until(page, lambda: "Camera(" in page.get_by_role("textbox", name="code").input_value(), "the code has the camera")
    until(page, lambda: picture() != before, "the picture changes")
    assert page.get_by_role("textbox", name="code").input_value() != code


def test_a_click_shows_the_samples_of_the_pixel(page):
    page.get_by_label("Render. Arrow keys").locator("img").click(position={"x": 80, "y": 70})
    page.get_by_text("directions open").wait_for()
    told = page.get_by_text("directions open").inner_text()
    assert re.match(r"pixel \((79|80), (69|70)\) of ssao", told), told  # the page's layout has fractions of pixels


def test_menus_choose_module_and_buffer(page, picture):
    page.get_by_label("module", exact=True).select_option("ssdo")
    page.get_by_role("slider", name="environment_lod").wait_for()
    until(
        page,
        lambda: '"ssdo"' in page.get_by_role("textbox", name="code").input_value().replace("'", '"'),
        "the code has the module",
    )
    before = picture()
    page.get_by_label("buffer", exact=True).select_option("visibility")
    until(page, lambda: picture() != before, "the picture changes")
    page.get_by_alt_text("colour bar").wait_for()


def test_the_notebook_has_a_picture_for_viewers_without_widgets(page, server):
    page.keyboard.press("Control+s")

    def saved() -> bool:
        with urllib.request.urlopen(f"{server}/api/contents/explore.ipynb?content=1", timeout=10) as answer:
            outputs = json.load(answer)["content"]["cells"][0]["outputs"]
        return any("image/png" in output.get("data", {}) for output in outputs)

    until(page, saved, "the saved notebook has a PNG")
