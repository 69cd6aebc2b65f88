"""`aolab.glyph_picker`: a click in the browser sets a pixel, and Python sets the picture of its glyph."""

import asyncio
import base64
import html
import json
import shutil
import subprocess
import sys
import threading
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import aolab
from aolab import Camera, ParameterError

SKYLINE = Camera(eye=(0, 1, 6), target=(0, 1, 0))  # the plane below, the background above
GROUND, SKY = (30, 40), (10, 2)


@pytest.fixture(scope="module")
def frame(lab, plane):
    return lab.render(plane, "s3ho", camera=SKYLINE, directions=8)


def test_it_shows_the_image_and_how_to_use_it(frame):
    picker = aolab.glyph_picker(frame)
    assert (np.asarray(Image.open(BytesIO(picker.image))) == frame.image).all()
    assert "Click" in picker.message
    assert (picker.pixel, picker.picture, picker.glyph) == (None, b"", None)


def test_a_picked_pixel_shows_its_glyph(frame):
    picker = aolab.glyph_picker(frame)
    picker.set_state({"pixel": list(GROUND)})  # as the front end does
    assert picker.pixel == picker.glyph.pixel == GROUND
    assert Image.open(BytesIO(picker.picture)).size == picker.glyph.picture().size
    assert picker.message == "Pixel (30, 40): 100% open, irradiance 3.14, 3.14, 3.14."


def test_a_background_pixel_gives_a_message_and_no_glyph(frame):
    picker = aolab.glyph_picker(frame)
    picker.pixel = GROUND
    picker.pixel = SKY
    assert "pixel (10, 2) is in the background" in picker.message
    assert (picker.picture, picker.glyph) == (b"", None)
    picker.pixel = GROUND
    assert picker.picture


def test_a_click_in_another_thread_is_handled_in_the_thread_of_the_context(frame):
    async def notebook():
        picker = aolab.glyph_picker(frame)
        click = threading.Thread(target=picker.set_state, args=({"pixel": list(GROUND)},))
        click.start()
        await asyncio.to_thread(click.join)
        await asyncio.sleep(0)
        return picker

    picker = asyncio.run(notebook())
    assert picker.glyph is not None, picker.message


def test_a_frame_without_harmonics_is_refused_at_once(lab, plane):
    with pytest.raises(ParameterError, match="modules s3ho"):
        aolab.glyph_picker(lab.render(plane, "none"))


def test_without_anywidget_the_error_names_the_package(frame, monkeypatch):
    monkeypatch.setitem(sys.modules, "anywidget", None)
    monkeypatch.delitem(sys.modules, "aolab.notebook.widget", raising=False)
    with pytest.raises(ParameterError, match="pip install anywidget"):
        aolab.glyph_picker(frame)


# --- the browser side

PAGE = """<!doctype html><meta charset="utf-8"><div id="widget" style="width: 32px"></div><pre id="seen"></pre>
<script type="module">
const decoded = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
const module = new Blob([decoded("%MODULE%")], { type: "text/javascript" });
const { default: widget } = await import(URL.createObjectURL(module));  // as anywidget does

const png = new DataView(decoded("%IMAGE%").buffer), none = new DataView(new ArrayBuffer(0));
const state = { image: png, pixel: null, picture: none, message: "hint" }, listeners = {};
const model = {
  get: (name) => state[name],
  set: (name, value) => { state[name] = value; (listeners[`change:${name}`] ?? []).forEach((heard) => heard()); },
  save_changes: () => seen.pixels.push(state.pixel),
  on: (names, heard) => names.split(" ").forEach((name) => (listeners[name] ??= []).push(heard)),
  off: (names) => names.split(" ").forEach((name) => delete listeners[name]),
};
const seen = { pixels: [] };
const el = document.getElementById("widget");
const close = widget.render({ model, el });
const [image, picture] = el.querySelectorAll("img"), status = el.querySelector("[role=status]");
await image.decode();

function click(x, y) {  // CSS pixels from the image's corner
  const box = image.getBoundingClientRect();
  const place = { clientX: box.left + x, clientY: box.top + y, bubbles: true };
  document.elementFromPoint(place.clientX, place.clientY).dispatchEvent(new MouseEvent("click", place));
}
const press = (key, more) => image.parentElement.dispatchEvent(new KeyboardEvent("keydown", { key, ...more }));

seen.widths = [image.naturalWidth, image.getBoundingClientRect().width];
click(0, 0);
click(31, 23);
click(20, 5);
const box = image.getBoundingClientRect(), marker = el.querySelector("img + div").getBoundingClientRect();
seen.marker = [(marker.left + marker.right) / 2 - box.left, (marker.top + marker.bottom) / 2 - box.top];
el.style.cssText = "width: 64px; transform: scale(3); transform-origin: 0 0";
seen.widths.push(image.getBoundingClientRect().width);
click(191, 143);
press("ArrowDown");  // the image ends there
click(22, 90);
press("ArrowRight");
press("ArrowUp", { shiftKey: true });
press("ArrowLeft", { shiftKey: true });
press("ArrowLeft", { ctrlKey: true });

model.set("message", "<b>said</b>");
seen.unanswered = [picture.checkVisibility(), status.textContent];
model.set("picture", png);
await picture.decode();
seen.answered = [picture.checkVisibility(), picture.naturalWidth, picture.alt];
close();
seen.listeners = Object.keys(listeners);
document.getElementById("seen").textContent = JSON.stringify(seen);
</script>"""


def dumped(page: Path, profile: Path) -> str:
    """The page's document after its script has run, by headless Chromium."""
    names = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
    browser = next(filter(None, map(shutil.which, names)), None)
    if browser is None:
        pytest.skip(f"no browser: none of {', '.join(names)} is on the path")
    quiet = ["disable-gpu", "disable-quic", "no-first-run", "disable-background-networking", "disable-sync"]
    flags = [*quiet, "headless", "no-sandbox", "disable-component-update", f"user-data-dir={profile}"]
    done = subprocess.run(
        [browser, *(f"--{flag}" for flag in flags), "--virtual-time-budget=5000", "--dump-dom", page.as_uri()],
        capture_output=True, text=True, timeout=60, check=True,
    )  # fmt: skip
    return done.stdout


@pytest.mark.browser
def test_clicks_and_keys_in_a_browser(tmp_path, frame):
    script = (Path(aolab.__file__).parent / "notebook" / "widget.js").read_bytes()
    data = {"%MODULE%": script, "%IMAGE%": frame._repr_png_()}
    text = PAGE
    for place, value in data.items():
        text = text.replace(place, base64.b64encode(value).decode())
    page = tmp_path / "page.html"
    page.write_text(text)
    document = seen = ""
    for attempt in range(3):  # virtual time does not wait for a busy machine to decode an image
        document = dumped(page, tmp_path / f"profile{attempt}")
        seen = document.partition('<pre id="seen">')[2].partition("</pre>")[0]
        if seen:
            break
    assert seen, f"the page's script did not end:\n{document[-2000:]}"
    seen = json.loads(html.unescape(seen))
    assert seen["widths"] == [64, 32, 192]  # natural, shrunk, enlarged
    assert seen["pixels"] == [[0, 0], [62, 46], [40, 10], [63, 47], [63, 47], [7, 30], [8, 30], [8, 20], [0, 20]]
    assert seen["marker"] == [20.25, 5.25]  # the middle of pixel (40, 10) of the shrunk image
    assert seen["unanswered"] == [False, "<b>said</b>"]  # as text: a message cannot add elements to the page
    assert seen["answered"] == [True, 64, "<b>said</b>"]
    assert seen["listeners"] == []
