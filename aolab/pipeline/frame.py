"""The result of a render: every buffer by name, read on demand, and the image."""

import warnings
import weakref
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from os import PathLike
from time import perf_counter
from typing import TYPE_CHECKING, Any, Self, TypeVar

import moderngl
import numpy as np

from ..errors import Notice, ParameterError, suggestion
from ..gl.texture import Pool, read
from ..gl.thread import handed
from ..modules.buffers import BUFFERS, Buffer
from ..pictures import display
from ..pictures.buffer_files import save_buffers
from ..pictures.metadata import save_png
from ..scene.camera import Camera
from ..scene.scene import Scene

if TYPE_CHECKING:
    from PIL import Image

Holder = TypeVar("Holder")
Textures = Mapping[str, moderngl.Texture | np.ndarray]


@dataclass(frozen=True, eq=False)
class Later:
    """The buffers `names` of a frame that wait until one of them is read; `make` computes them all, and their passes'
    milliseconds. Of two with the same buffer, the first is the short way to it.
    """

    names: Sequence[str]
    make: Callable[["Frame"], tuple[Textures, dict[str, float]]]


@dataclass(eq=False)
class Frame:
    """One rendered frame.

    `frame["visibility"]` is a NumPy array, (H, W) or (H, W, channels) float32, top row first; `frame.buffers` lists
    the names. `image` is (H, W, 3) uint8 sRGB. `timings` is {pass: ms}, `frame_ms` the whole call. `info` has the
    settings: renderer, module, parameters, camera, size, seed, ...; `notes` the repairs and omissions. A frame keeps
    its textures until it is dropped, so that frames may be kept and compared; each costs 80 to 300 bytes a pixel.

    The lighting (`direct`, `ambient`, `radiance`, ...) is computed when its first buffer is read; of most methods, a
    pass of its own computes `image` alone. The passes are in `timings`, and their time in `frame_ms`, from then on.
    `complete()` computes all buffers at once, `complete("image")` the picture.
    """

    made: Mapping[str, moderngl.Texture | np.ndarray]  # by name; without the buffers that wait
    timings: dict[str, float]
    info: dict[str, Any]
    frame_ms: float = 0.0
    notes: list[str] = field(default_factory=list)
    # read off other buffers: each a function of the frame and of "" or "_raw"
    derived: Mapping[str, tuple[Callable[[Self, str], np.ndarray], str]] = field(default_factory=dict)
    table: Mapping[str, Buffer] = field(default_factory=lambda: BUFFERS, repr=False)  # describes the buffers
    scene: Scene | None = field(default=None, repr=False)  # as it was lit
    kept: Any = field(default=None, repr=False)  # for its lab, to light it again
    lit: Any = field(default=None, repr=False)  # after its lighting, all that has lit it
    later: Sequence[Later] = field(default=(), repr=False)
    _arrays: dict[str, np.ndarray] = field(default_factory=dict, repr=False)

    @property
    def buffers(self) -> list[str]:
        """The names of all buffers."""
        return sorted({*self.made, *self.derived, *(name for one in self.later for name in one.names)})

    @property
    def textures(self) -> Textures:
        """All buffers that are not derived, by name: textures of the lab, or arrays."""
        return self.complete().made

    def complete(self, *names: str) -> Self:
        """Compute the buffers that wait until they are read: those of these names, or all.

        `complete("image")` computes the picture alone, in a single pass where the method has one.
        Raises the errors of `Lab.render`, and `ParameterError` for an unknown name.
        """
        for name in names:
            self._check_name(name)
        wanted = {*(names or self.buffers)}
        while one := self._next(wanted):
            handed(self._compute)(one)
        return self

    def _next(self, wanted: set[str]) -> Later | None:
        """Of all that waits, the part with the most of the `wanted` buffers; None if they are all there."""
        waiting = wanted - self.made.keys()
        useful = [one for one in self.later if waiting.intersection(one.names)]
        return max(useful, key=lambda one: len(waiting.intersection(one.names)), default=None)

    def _compute(self, one: Later) -> None:
        """Compute the buffers of `one`."""
        if one not in self.later:  # another thread was faster
            return
        start = perf_counter()
        with noting(self.notes):
            made, timings = one.make(self)
        self.made = {**made, **self.made}
        self.later = [other for other in self.later if other is not one and not self.made.keys() >= {*other.names}]
        for name, milliseconds in timings.items():
            self.timings[name] = self.timings.get(name, 0.0) + milliseconds
        self.frame_ms += (perf_counter() - start) * 1e3

    @property
    def size(self) -> tuple[int, int]:
        """(width, height) in pixels."""
        return tuple(self.info["size"])  # type: ignore[return-value]

    def __getitem__(self, name: str) -> np.ndarray:
        self._check_name(name)
        if name not in self._arrays:
            if name in self.derived:
                make, raw = self.derived[name]
                pixels = make(self, raw)
            else:
                pixels = self.channels(name)
            if about := self.table.get(name.removesuffix("_raw")):
                if pixels.ndim == 3 and pixels.shape[2] > about.channels:
                    pixels = np.ascontiguousarray(pixels[..., : about.channels])
                if about.background is not None and np.isnan(about.background) and pixels.shape == self["viewZ"].shape:
                    pixels = np.where(np.isfinite(self["viewZ"]), pixels, np.float32(np.nan))
            self._arrays[name] = pixels
        return self._arrays[name]

    def _check_name(self, name: str) -> None:
        if name not in self.buffers:
            raise ParameterError(f"this frame has no buffer '{name}'{suggestion(name, self.buffers)}")

    def channels(self, name: str) -> np.ndarray:
        """A texture with every channel that it has, (H, W) or (H, W, channels); `frame[name]` leaves padding out."""
        source = self.complete(name).made[name]
        return source if isinstance(source, np.ndarray) else handed(read)(source)

    def once(self, name: str, make: Callable[[], np.ndarray]) -> np.ndarray:
        """The result of `make`, computed at the first call with this name: for values that several buffers share."""
        if name not in self._arrays:
            self._arrays[name] = make()
        return self._arrays[name]

    @property
    def camera(self) -> Camera:
        """The camera that it was taken with."""
        return Camera(**self.info["camera"])

    def world_normal(self, like: str = "viewNormal") -> np.ndarray:
        """(H, W, 3): the unit normals in world space, 0 in the background; at the size of the buffer `like`.

        That may be smaller where a raw estimate was made at a lower `scale`: then those of the nearest pixels.
        """
        normal = self["viewNormal"]
        sizes = zip(normal.shape[:2], self[like].shape[:2], strict=True)
        rows, columns = ((np.arange(few) + 0.5) * (many / few) for many, few in sizes)
        # counted from the lowest row, as in glsl/pipeline/shrink.frag: halfway, the nearest are two
        nearest = normal[::-1][rows.astype(int)[:, None], columns.astype(int)][::-1]
        return nearest @ self.camera.view_from_world[:3, :3].astype(np.float32)

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
        """Write every buffer by name, as compressed .npz or, by the suffix of `path`, as multi-layer .exr.

        Replaces `path` atomically. The background is NaN in visibility.
        """
        directions = {name for name, about in self.table.items() if about.kind == "direction"}
        save_buffers(path, {name: self[name] for name in self.buffers}, directions)

    def stats(self) -> dict[str, Any]:
        """How it was made and what it cost, for `--stats`; times in milliseconds."""
        keys = ("renderer", "size", "module", "parameters", "triangles", "seed")
        known = {key: self.info[key] for key in keys if key in self.info}
        return {**known, "timings": self.timings, "frame_ms": self.frame_ms, "notes": self.notes}

    def show(self, buffer: str = "") -> "Image.Image":
        """A picture of a buffer, with a colour bar. The default is the image, or else the frame's first buffer."""
        return display.frame_picture(self, buffer)

    def keys(self) -> list[str]:
        """The names of the buffers, for `dict(frame)`."""
        return self.buffers

    def __iter__(self) -> Iterator[str]:
        return iter(self.buffers)

    def __contains__(self, name: object) -> bool:
        return name in self.buffers

    def _ipython_key_completions_(self) -> list[str]:
        return self.buffers

    def __getstate__(self) -> dict[str, Any]:
        """The state for pickle: every buffer as an array. The pickled frame can be compared, but not lit again."""
        arrays = {name: self[name] for name in self.buffers}
        return {
            **self.__dict__,
            "made": arrays,
            "derived": {},
            "kept": None,
            "lit": None,
            "later": (),
            "_arrays": dict(arrays),
        }

    def _repr_png_(self) -> bytes:
        return display.frame_png(self)

    def _repr_html_(self) -> str:
        return display.frame_html(self)

    def __repr__(self) -> str:
        width, height = self.size
        return f"<Frame {width}x{height} {self.info['module']}: {', '.join(self.buffers)}>"


@contextmanager
def noting(notes: list[str]) -> Iterator[None]:
    """Append each `Notice` of the block to `notes`; the notices are issued when the block ends."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", Notice)
        yield
    notes += [str(note.message) for note in caught]
    for note in caught:
        warnings.warn_explicit(note.message, note.category, note.filename, note.lineno)


def lend(holder: Holder, pool: Pool, lent: list[Any]) -> Holder:
    """Give the textures `lent` back to the pool when nobody keeps their holder."""
    weakref.finalize(holder, pool.give_back, lent)
    return holder


def check_frame(frame: object, what: str) -> None:
    """Raise `ParameterError` for anything but a frame; the message names `what` was called."""
    if not isinstance(frame, Frame):
        raise ParameterError(f"{what}: {frame!r:.80} is not a frame; aolab.render and aolab.reference return frames")
