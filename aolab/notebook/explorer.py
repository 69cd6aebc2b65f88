"""The Python side of the widget `aolab.explore`. The browser side is explorer.js."""

import time
import warnings
from collections.abc import Mapping
from io import BytesIO
from pathlib import Path
from typing import Any

import anywidget
import numpy as np
import traitlets
from PIL import Image

from ..errors import Error, Notice
from ..gl.texture import Size
from ..gl.thread import post
from ..measures import compare
from ..modules import Module, find
from ..pictures.buffers import bar_picture, buffer_pixels, first_buffer, scale_of
from ..pictures.html import png
from ..pipeline.api import shared_lab
from ..pipeline.frame import Frame
from ..scene.camera import Camera
from ..scene.scene import Scene
from ..truth import reference
from .controls import controls, of_choices
from .microscope import microscope

MOVING_MS = 70.0  # a frame while a control moves: at most this, so that ten frames a second reach the browser
LEAST_SHARE = 0.25  # of the width and height, while moving
JPEG_QUALITY = 85
FASTEST = 1  # zlib's fastest level, for pictures that are replaced at once


class Explorer(anywidget.AnyWidget):
    """A live render. The browser sets `wish`; Python renders it and sets `reply`, `picture`, `bar` and `samples`.

    `wish`: number, module, parameters, buffer, view ("result", "truth" or "error"), azimuth, elevation, zoom, moving,
    pixel. If several wishes arrive during a frame, Python renders the latest only. `reply` has the wish's number, by
    which the browser learns that it may send another.
    """

    _esm = Path(__file__).with_name("explorer.js")

    statement = traitlets.Dict().tag(sync=True)
    wish = traitlets.Dict().tag(sync=True)
    reply = traitlets.Dict().tag(sync=True)
    picture = traitlets.Bytes().tag(sync=True)
    bar = traitlets.Bytes().tag(sync=True)
    samples = traitlets.Bytes().tag(sync=True)

    def __init__(
        self,
        scene: Scene,
        module: Module,
        modules: Mapping[str, type[Module]],
        size: Size,
        camera: Camera | None,
        accumulate: int,
        rays: int,
    ) -> None:
        name = module.name or type(module).__name__
        start = {key: value for key, value in module.values().items() if key in module.model_fields_set}
        super().__init__(
            statement={known: controls(one, scene) for known, one in modules.items()},
            wish={"number": 0, "module": name, "parameters": start},
        )
        assert scene.camera is not None  # Scene frames itself
        self.scene, self.size = scene, size
        self.frame: Frame | None = None
        self.code = ""
        self.module, self.camera = module, camera or scene.camera
        self._modules, self._home = modules, self.camera
        self._accumulate, self._rays = accumulate, rays
        self._truths: dict[str, Frame] = {}
        self._share, self._waiting = 1.0, False
        self._answer()
        self.observe(self._wished, names="wish")

    def _wished(self, _: object) -> None:
        """JupyterLab may call this in another thread, and again while the last wish is still being rendered."""
        if not self._waiting:
            self._waiting = True
            post(self._answer)

    def _answer(self) -> None:
        self._waiting = False
        wish = self.wish
        start = time.perf_counter()
        reply: dict[str, Any] = {"number": wish.get("number", 0), "error": "", "text": "", "timings": []}
        picture = bar = samples = None
        try:
            picture, bar, samples = self._render(wish, reply)
        except Error as error:
            reply["error"] = str(error)
        except (Exception, KeyboardInterrupt) as error:  # a callback's traceback would not reach the notebook
            reply["error"] = f"{type(error).__name__}: {error}"
        reply["ms"] = (time.perf_counter() - start) * 1e3
        with self.hold_sync():  # the browser receives all together
            if picture is not None:
                self.picture, self.bar = picture, bar or b""
            if samples is not None:
                self.samples = samples
            self.reply = reply

    def _render(self, wish: dict[str, Any], reply: dict[str, Any]) -> tuple[bytes, bytes, bytes | None]:
        moving = bool(wish.get("moving"))
        name = wish["module"]
        self.module = find(name, self._modules, **of_choices(self._modules[name], wish.get("parameters", {})))
        angles = (float(wish.get(key, 0)) for key in ("azimuth", "elevation"))
        self.camera = self._home.orbited(*angles, zoom=float(wish.get("zoom", 1)))
        width, height = self.size
        share = self._share if moving else 1.0
        size = max(1, round(width * share)), max(1, round(height * share))
        accumulate = 1 if moving else self._accumulate
        frame = shared_lab().render(self.scene, self.module, camera=self.camera, size=size, accumulate=accumulate)
        wanted = str(wish.get("buffer", ""))
        buffer = wanted if wanted in frame.buffers else first_buffer(frame.buffers)
        frame[buffer]  # computed now, so that the times include it
        if moving:  # the next moving frame is larger or smaller, as the time allows
            self._share = float(np.clip(share * (MOVING_MS / max(frame.frame_ms, 1)) ** 0.5, LEAST_SHARE, 1))
        else:
            self._share = min(self._share, (MOVING_MS * accumulate / max(frame.frame_ms, 1)) ** 0.5)
            self._share = max(self._share, LEAST_SHARE)
        self.frame = frame
        self.code = self._code()
        sides = "×".join(map(str, size))
        reply |= {
            "code": self.code,
            "buffer": buffer,
            "buffers": frame.buffers,
            "size": list(self.size),
            "timings": [[step, ms] for step, ms in frame.timings.items()],
            "text": f"{wish['module']}, {sides}: {frame.frame_ms:.0f} ms on {frame.info['renderer']}",
        }
        view = wish.get("view", "result")
        if view != "result" and not moving:
            picture, bar, text = self._against_truth(frame, buffer, view)
            reply["text"] += text
        else:
            picture, bar = _picture(frame, buffer, moving)
        pixel = wish.get("pixel")
        return picture, bar, self._samples(frame, pixel, reply) if pixel and not moving else None

    def _against_truth(self, frame: Frame, buffer: str, view: str) -> tuple[bytes, bytes, str]:
        """The truth, or the error, of a buffer; the reference is traced once for each camera, reach and buffer."""
        module = self.module if self.module.has_radius() else None
        reach = [str(getattr(self.module, name, "")) for name in ("radius", "falloff")]
        key = repr((buffer, self.camera, reach))
        if key not in self._truths:
            self._truths[key] = reference(
                self.scene,
                size=self.size,
                camera=self.camera,
                rays=self._rays,
                like=module,
                buffers=(buffer,),
                progress=False,
            )
        truth = self._truths[key]
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", Notice)
            compared = compare(frame, truth, buffer, flip=False)
        text = f"; {buffer}: RMSE {compared[buffer].rmse:.4g}, bias {compared[buffer].measures['all'].bias:+.4g}"
        text += "".join(f"; {note.message}" for note in caught)
        if view == "truth":
            return *_picture(truth, buffer, False), text
        error = compared[buffer].error
        scale = scale_of("error", error)
        assert scale is not None  # an error is one number a pixel
        return png(scale.pixels(error)), png(bar_picture(scale, max(self.size[1], 120))), text

    def _samples(self, frame: Frame, pixel: list[int], reply: dict[str, Any]) -> bytes:
        try:
            seen = microscope(frame, (int(pixel[0]), int(pixel[1])))
        except Error as error:
            reply["samples"] = str(error)
            return b""
        reply["samples"] = str(seen)
        return seen._repr_png_()

    def _code(self) -> str:
        scene = repr(self.scene.source) if self.scene.source else "scene"
        parts = [scene, repr(self.wish["module"]), f"size={self.size}"]
        if self.camera != self.scene.camera:
            eye, target = (tuple(round(part, 4) for part in one) for one in (self.camera.eye, self.camera.target))
            parts.append(f"camera=aolab.Camera(eye={eye}, target={target}, up={self.camera.up}, fov={self.camera.fov})")
        if self._accumulate > 1:
            parts.append(f"accumulate={self._accumulate}")
        stated = type(self.module).stated()
        values = self.module.values().items()
        parts += [f"{key}={value!r}" for key, value in values if value != stated[key].model_fields[key].default]
        return f"aolab.render({', '.join(parts)})"

    def _repr_mimebundle_(self, **kwargs: Any) -> Any:
        """The widget, and a PNG of the picture for viewers without widgets."""
        bundle = super()._repr_mimebundle_(**kwargs)
        data, metadata = bundle if isinstance(bundle, tuple) else (bundle, {})
        if data is not None and self.frame is not None:
            data = {**data, "image/png": self.frame._repr_png_()}
        return data, metadata


def _picture(frame: Frame, buffer: str, moving: bool) -> tuple[bytes, bytes]:
    """The bytes of a picture and of its colour bar. An image that moves is a JPEG; every other picture is a PNG."""
    values = frame[buffer]
    if values.ndim == 3 and values.shape[2] not in (1, 3):
        values = values[..., 0]
    scale = scale_of(buffer, values)
    pixels = buffer_pixels(buffer, values, scale)
    data = BytesIO()
    if moving and buffer == "image":
        Image.fromarray(pixels).save(data, "JPEG", quality=JPEG_QUALITY)
    else:
        Image.fromarray(pixels).save(data, "PNG", compress_level=FASTEST)
    return data.getvalue(), png(bar_picture(scale, max(frame.size[1], 120))) if scale else b""
