"""What a render gives back: every buffer by name, read when asked for, and the image."""

import weakref
from collections.abc import Mapping
from dataclasses import dataclass, field
from io import BytesIO
from os import PathLike
from typing import Any

import moderngl
import numpy as np
from PIL import Image

from .errors import ParameterError, suggestion
from .gl.texture import Pool, read
from .metadata import save_png

# how many channels of a texture mean something; the others are padding
_RGB = ("viewNormal", "albedo", "direct", "ambient", "indirect", "irradiance", "bounce", "radiance", "image")
# scalars that have no value where nothing was drawn
_NAN_IN_BACKGROUND = ("visibility",)


@dataclass(eq=False)
class Frame:
    """One rendered frame.

    `frame["visibility"]` is a NumPy array, (H, W) or (H, W, channels) float32, top row first; `frame.buffers` lists
    the names. `image` is (H, W, 3) uint8 sRGB. `timings` is {pass: ms}, `frame_ms` the whole call. `info` says how it
    was made: renderer, module, parameters, camera, size, seed, ...; `notes` what was repaired or left out. A frame
    keeps its textures until it is dropped, so frames may be held and compared; each costs about 50 bytes a pixel.
    """

    textures: Mapping[str, moderngl.Texture | np.ndarray]
    timings: dict[str, float]
    info: dict[str, Any]
    frame_ms: float = 0.0
    notes: list[str] = field(default_factory=list)
    parts: Mapping[str, tuple[str, int]] = field(default_factory=dict)  # name: texture and channel
    _arrays: dict[str, np.ndarray] = field(default_factory=dict, repr=False)

    @property
    def buffers(self) -> list[str]:
        """The names that `frame[name]` knows."""
        return sorted({*self.textures, *self.parts})

    @property
    def size(self) -> tuple[int, int]:
        """(width, height) in pixels."""
        return tuple(self.info["size"])  # type: ignore[return-value]

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self.buffers:
            raise ParameterError(f"this frame has no buffer '{name}'{suggestion(name, self.buffers)}")
        if name not in self._arrays:
            whole, channel = self.parts.get(name, (name, None))
            source = self.textures[whole]
            pixels = source if isinstance(source, np.ndarray) else read(source)
            if channel is not None:
                pixels = pixels[..., channel]
            elif name.removesuffix("_raw") in _RGB:
                pixels = np.ascontiguousarray(pixels[..., :3])
            if name.removesuffix("_raw") in _NAN_IN_BACKGROUND and pixels.shape == self["viewZ"].shape:
                pixels = np.where(np.isfinite(self["viewZ"]), pixels, np.float32(np.nan))
            self._arrays[name] = pixels
        return self._arrays[name]

    @property
    def image(self) -> np.ndarray:
        """(H, W, 3) uint8, sRGB, top row first."""
        return self["image"]

    @property
    def mask(self) -> np.ndarray:
        """(H, W) bool: where a surface was drawn."""
        return np.isfinite(self["viewZ"])

    def save(self, path: str | PathLike[str]) -> None:
        """Write the image as PNG, with everything needed to make it again in its metadata; replaces atomically."""
        save_png(path, self.image, self.info)

    def save_buffers(self, path: str | PathLike[str]) -> None:
        """Write every buffer by name as a compressed .npz; replaces atomically. Background is NaN in visibility."""
        from .output import replacing

        with replacing(path) as file:
            np.savez_compressed(file, **{name: self[name] for name in self.buffers})  # type: ignore[arg-type]

    def stats(self) -> dict[str, Any]:
        """How it was made and what it cost, for `--stats`; times in milliseconds."""
        keys = ("renderer", "size", "module", "parameters", "triangles", "seed")
        known = {key: self.info[key] for key in keys if key in self.info}
        return {**known, "timings": self.timings, "frame_ms": self.frame_ms, "notes": self.notes}

    def _repr_png_(self) -> bytes:
        data = BytesIO()
        Image.fromarray(self.image).save(data, "PNG")
        return data.getvalue()

    def __repr__(self) -> str:
        width, height = self.size
        return f"<Frame {width}x{height} {self.info['module']}: {', '.join(self.buffers)}>"


def lend(frame: Frame, pool: Pool, lent: list[Any]) -> Frame:
    """Give the frame's textures back to the pool when nobody holds the frame."""
    weakref.finalize(frame, pool.give_back, lent)
    return frame
