"""The interface of an occluder kind: its parameters, its GLSL, and the textures that it draws for that."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, Protocol

import moderngl

from ...gl.bindings import Bindings
from ...gl.texture import Size
from ...scene.scene import Scene
from ...scene.view import View
from ..parameters import Choice
from ..passes import GeometryPass, Pass

Textures = dict[str, moderngl.Texture]


class Drawing(Protocol):
    """The means of an occluder kind: it draws surfaces of the scene, and runs passes. `pipeline.Rasterizer` is one."""

    @property
    def scene(self) -> Scene: ...

    def surfaces(self, views: Sequence[View], name: str, formats: Mapping[str, str]) -> Textures:
        """The G-buffer (viewZ, and viewNormal and albedo where `formats` has them) of all `views`, in one texture each.

        The views are tiles of one size of atlas. `name` is for the timings.
        """
        ...

    def peeled(
        self, nearest: moderngl.Texture, count: int, views: Sequence[View], formats: Mapping[str, str]
    ) -> list[Textures]:
        """Up to `count` further depth layers behind `nearest` (viewZ), as `surfaces`; fewer where nothing is left."""
        ...

    def reliefs(self) -> Bindings:
        """The scene's height maps, for shaders with lib/relief.glsl."""
        ...

    def draw(self, step: GeometryPass, view: View, bindings: Iterable[Bindings] = ()) -> Textures:
        """The outputs of a pass over the scene's triangles; `view` is the camera's."""
        ...

    def run(self, step: Pass, bindings: Iterable[Bindings], size: Size) -> Textures:
        """The outputs of a pass over a whole picture of `size`."""
        ...

    def kept(self, name: str, key: object, make: Callable[[], Textures]) -> Textures:
        """The textures that `make` returns, kept between frames under `name` while `key` stays equal.

        Other textures that `make` draws are scratch.
        """
        ...


@dataclass(frozen=True)
class Hidden:
    """Surfaces that the camera does not see but that send light: G-buffers of `views`, tiles of the same textures.

    `occluders` are the blockers that the estimate tests for these surfaces, in the space of their views. Once the
    surfaces are lit, the light that leaves them is bound as the texture `sender`.
    """

    sender: str
    surfaces: Textures
    views: Sequence[View]
    occluders: Bindings


@dataclass(frozen=True)
class Occluders:
    """All that a kind has drawn: `bindings` for the shaders that ask for blockers, and `hidden` senders."""

    bindings: Bindings
    hidden: Sequence[Hidden] = ()


class OccluderKind(Choice):
    """A kind of data that is asked whether a point is blocked. A subclass states its parameters, and these facts:

    `name` (lower case), and `shader`, a file under glsl/ or GLSL text. The shader starts with
    `#include "occluders/surfaces.glsl"` and has:

    - `struct Occluder`, with `vec3 viewPos`, the view-space point that blocks, and whatever else finds it again;
    - `bool isBlocked(Receiver receiver, vec3 samplePos, float thickness, out Occluder occluder)`: whether the
      view-space point `samplePos` is blocked for the receiver (lib/receiver.glsl), and by which occluder;
    - `vec3 occluderNormal(Occluder occluder)`, its unit normal in view space;
    - `vec3 occluderRadiance(Occluder occluder)`, the light that leaves it.

    `draw` returns the textures and uniforms that the shader reads beyond the camera's G-buffer. The kind's numbers are
    uniforms and constants of its shader. `uniforms` lists the names of further ones, so that no module's
    parameter takes them.
    """

    axis: ClassVar[str] = "occluders"
    shader: ClassVar[str] = ""
    uniforms: ClassVar[tuple[str, ...]] = ()

    def draw(self, drawing: Drawing, view: View, surfaces: Textures, sends: bool) -> Occluders:
        """Draw for a frame seen from `view`, whose G-buffer is `surfaces`.

        With `sends`, the module reads normals and light of occluders; without it, depths are enough.
        """
        return Occluders(self.bindings())

    def glsl(self) -> str:
        """The file or the text that stands for `#include "occluders.glsl"`."""
        return self.shader

    def bindings(self, textures: Textures | None = None, uniforms: Mapping[str, object] | None = None) -> Bindings:
        """These textures and uniforms, with the kind's parameters and its shader."""
        numbers = self.numbers()
        includes = {"occluders.glsl": self.glsl()}
        return Bindings(self.label(), textures or {}, {**numbers, **(uniforms or {})}, numbers, includes)
