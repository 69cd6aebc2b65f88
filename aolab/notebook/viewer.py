"""The state of a window over a scene: keys and drags change the wish, `picture` renders it."""

import textwrap
import time
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image, ImageDraw

from ..errors import Error, Notice
from ..gl.texture import Size
from ..measures import compare
from ..modules import MODULES, Module, find
from ..modules.parameters import AUTO
from ..pictures.buffers import buffer_pixels, first_buffer, scale_of
from ..pictures.font import caption_font
from ..pipeline.api import shared_lab
from ..pipeline.frame import Frame
from ..scene.camera import Camera
from ..scene.scene import Scene
from ..truth import reference
from .controls import controls, of_choices

VIEWS = ("result", "truth", "error")
MOVING_SHARE = 0.5  # of width and height, while the camera is dragged
STEPS = 20  # from one end of a parameter's range to the other
DEGREES = 0.4  # of orbit a pixel of drag
ZOOM = 1.1  # a step of the wheel
KEYS = {
    "m": "the next module (with shift: the one before)",
    "b": "the next buffer (with shift: the one before)",
    "t": "result, ray-traced truth, error",
    "p": "the panel of parameters; up and down choose, left and right change",
    "r": "the camera and the parameters of the start",
    "s": "save the picture",
    "h": "these keys",
    "q": "close",
}
LINE, MARGIN, LETTER = 16, 8, 7  # pixels; LETTER: the mean width of one
Line = tuple[str, tuple[int, ...]]
INK, FAINT, CHOSEN, PAPER = (255, 255, 255), (190, 190, 190), (255, 210, 90), (0, 0, 0, 150)


class Viewer:
    """A scene as keys, drags and wheel steps show it. `stale` is whether `picture` would return another picture."""

    def __init__(
        self,
        scene: Scene,
        module: Module,
        size: Size,
        camera: Camera | None = None,
        seed: int = 0,
        rays: int = 64,
    ) -> None:
        assert scene.camera is not None  # Scene frames itself
        self.scene, self.size, self.seed, self.rays = scene, size, seed, rays
        self._modules = dict(MODULES) | {module.label(): type(module)}
        values = {name: value for name, value in module.values().items() if name in module.model_fields_set}
        self._start = module.label(), values
        self._home = camera or scene.camera
        self.view, self.panel, self.help, self.moving = "result", False, False, False
        self.buffer, self.stale, self.closed = "image", True, False
        self._row, self._saved, self._buffers = 0, 0, ["image"]
        self._every: dict[str, dict[str, dict[str, Any]]] = {}  # the controls of each module, by name
        self._truth: tuple[Any, Frame] | None = None
        self._reset()

    def _reset(self) -> None:
        self.module_name, self.parameters = self._start[0], dict(self._start[1])
        self._azimuth = self._elevation = 0.0
        self._zoom = 1.0

    @property
    def camera(self) -> Camera:
        return self._home.orbited(self._azimuth, self._elevation, zoom=self._zoom)

    @property
    def module(self) -> Module:
        """The chosen module with the chosen parameters. Raises `ParameterError` for a value out of its range."""
        kind = self._modules[self.module_name]
        return find(kind, MODULES, **of_choices(kind, self.parameters))

    # --- input

    def press(self, key: str, shift: bool = False) -> None:
        """A key by its name: a letter, or up, down, left, right, escape. Other keys do nothing."""
        step = -1 if shift else 1
        if key == "m":
            names = list(self._modules)
            self.module_name = _next(names, self.module_name, step)
            self.parameters = {name: value for name, value in self.parameters.items() if name in self._stated}
            self._row = 0
        elif key == "b":
            self.buffer = _next(self._buffers, self.buffer, step)
        elif key == "t":
            self.view = _next(VIEWS, self.view, step)
        elif key == "p":
            self.panel = not self.panel
        elif key == "h":
            self.help = not self.help
        elif key == "r":
            self._reset()
        elif key == "s":
            self.save()
            return
        elif key in ("q", "escape"):
            self.closed = True
        elif key in ("up", "down") and self.panel:
            self._row = (self._row + (1 if key == "down" else -1)) % len(self._controls)
        elif key in ("left", "right") and self.panel:
            self._change(1 if key == "right" else -1)
        else:
            return
        self.stale = True

    def drag(self, right: float, down: float) -> None:
        """The camera orbits by a drag of so many pixels."""
        self._azimuth -= right * DEGREES
        self._elevation += down * DEGREES
        self.stale = self.moving = True

    def rest(self) -> None:
        """The drag ends: the next picture has the full resolution."""
        self.stale, self.moving = self.stale or self.moving, False

    def scroll(self, steps: float) -> None:
        """The camera comes nearer by steps of the wheel."""
        self._zoom *= ZOOM**steps
        self.stale = True

    def save(self) -> Path:
        """Write the picture to view-1.png, view-2.png, ... in the current folder."""
        self._saved += 1
        path = Path(f"view-{self._saved}.png")
        Image.fromarray(self.picture()).save(path)
        return path

    # --- parameters

    @property
    def _stated(self) -> Sequence[str]:
        return list(self._modules[self.module_name].stated())

    @property
    def _controls(self) -> list[dict[str, Any]]:
        """The controls of the parameters that exist with the chosen occluder kind and filter."""
        kind = self._modules[self.module_name]
        if self.module_name not in self._every:
            self._every[self.module_name] = {one["name"]: one for one in controls(kind, self.scene)}
        every = self._every[self.module_name]
        values = {name: one["default"] for name, one in every.items()} | self.parameters
        return [every[name] for name in of_choices(kind, values) if name in every]

    def _change(self, step: int) -> None:
        control = self._controls[self._row % len(self._controls)]
        value = self.parameters.get(control["name"], control["resolved"])
        if changed := _stepped(control, value, step):
            self.parameters[control["name"]] = changed[0]

    # --- pictures

    def picture(self) -> np.ndarray:
        """(H, W, 3) uint8: the buffer, with a line of facts, and the panel and the keys where they are on.

        An error or a `Notice` of the render is written in the picture.
        """
        self.stale = False
        start = time.perf_counter()
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", Notice)
            try:
                pixels, facts = self._pixels()
            except Error as error:
                pixels, facts = np.zeros((self.size[1], self.size[0], 3), np.uint8), str(error)
        facts = "; ".join([facts, *(str(note.message) for note in caught)])
        facts += f", {(time.perf_counter() - start) * 1e3:.0f} ms"
        image = Image.fromarray(pixels)
        if image.size != self.size:
            image = image.resize(self.size, Image.Resampling.BILINEAR)
        about = f"{self.module_name}, {self.buffer}, {self.view}: {facts}; h: keys"
        lines = [(line, INK) for line in textwrap.wrap(about, max(20, self.size[0] // LETTER))]
        if self.help:
            lines += [(f"{key}: {text}", FAINT) for key, text in KEYS.items()]
        if self.panel:
            lines += self._panel_lines((self.size[1] - MARGIN) // LINE - len(lines))
        return np.asarray(_written(image, lines))

    def _pixels(self) -> tuple[np.ndarray, str]:
        share = MOVING_SHARE if self.moving else 1.0
        size = max(1, round(self.size[0] * share)), max(1, round(self.size[1] * share))
        frame = shared_lab().render(self.scene, self.module, camera=self.camera, size=size, seed=self.seed)
        self._buffers = frame.buffers
        if self.buffer not in frame:
            self.buffer = first_buffer(frame.buffers)
        if self.view == "result" or self.moving:
            return _shown(self.buffer, frame[self.buffer]), f"{size[0]}×{size[1]}"
        truth = self._traced(frame)
        compared = compare(frame, truth, self.buffer, flip=False)[self.buffer]
        facts = f"RMSE {compared.rmse:.4g}"
        if self.view == "truth":
            return _shown(self.buffer, truth[self.buffer]), facts
        return _shown("error", compared.error), facts

    def _traced(self, frame: Frame) -> Frame:
        """The truth of the frame's question. The last one is kept."""
        key = repr((self.buffer, frame.info["camera"], frame.info["question"], frame.info["size"]))
        if self._truth is None or self._truth[0] != key:
            self._truth = key, reference(self.scene, like=frame, rays=self.rays, buffers=(self.buffer,))
        return self._truth[1]

    def _panel_lines(self, room: int) -> list[Line]:
        """The parameters and their values, as many as have room, the chosen one among them."""
        found = list[Line]()
        chosen = self._row % len(self._controls)
        for row, control in enumerate(self._controls):
            value = self.parameters.get(control["name"], control["default"])
            text = f"{value:.4g}" if isinstance(value, float) else str(value)
            text += f" {control['unit']}" if value != AUTO else ""
            mark, color = (">", CHOSEN) if row == chosen else ("  ", FAINT)
            found.append((f"{mark} {control['name']} = {text}", color))
        first = max(0, min(chosen - room // 2, len(found) - room))
        return found[first : first + max(1, room)]


def _next(names: Sequence[str], now: str, step: int) -> str:
    return names[(names.index(now) + step) % len(names)] if now in names else names[0]


def _stepped(control: dict[str, Any], value: Any, step: int) -> list[Any]:
    """The value one step further along its range, in a list; an empty list for a text, which has no steps."""
    kind = control["kind"]
    if kind == "bool":
        return [not value]
    if kind == "choice":
        choices = control["choices"]
        return [choices[(choices.index(value) + step) % len(choices)] if value in choices else choices[0]]
    if kind not in ("int", "float"):
        return []
    low, high = control["low"], control["high"]
    value = float(control["resolved"] if isinstance(value, str) else value)
    further = value * (high / low) ** (step / STEPS) if control["log"] else value + step * (high - low) / STEPS
    if kind == "int":
        further = max(value + 1, round(further)) if step > 0 else min(value - 1, round(further))
    bounded = min(max(further, low), high)
    return [int(bounded) if kind == "int" else float(bounded)]


def _shown(name: str, values: np.ndarray) -> np.ndarray:
    """(H, W, 3) uint8 of a buffer; of two, four or more channels, the first."""
    if values.ndim == 3 and values.shape[2] not in (1, 3):
        values = values[..., 0]
    return buffer_pixels(name, values, scale_of(name, values))


def _written(image: Image.Image, lines: Sequence[Line]) -> Image.Image:
    """The image under lines of text on a dark ground."""
    font = caption_font(12)
    draw = ImageDraw.Draw(image, "RGBA")
    width = max(draw.textlength(text, font) for text, _ in lines)
    draw.rectangle((0, 0, width + 2 * MARGIN, LINE * len(lines) + MARGIN), fill=PAPER)
    for number, (text, color) in enumerate(lines):
        draw.text((MARGIN, MARGIN // 2 + number * LINE), text, fill=color, font=font)
    return image
