"""Occluders: the height maps of surfaces, alone or together with the camera's depth."""

from dataclasses import replace

from ...errors import notice
from ...scene.view import View
from ..parameters import parameter
from .base import Drawing, OccluderKind, Occluders, Textures


class Height(OccluderKind):
    """The relief of the receiver's own surface: its material's height map (Umenhoffer et al. 2009, figure 3).

    A point is blocked if it lies below the relief. The relief needs no geometry, and is finer than a pixel's depth.
    With `depth_too`, other surfaces block as well, by the camera's depth.
    """

    name = "height"
    shader = "occluders/height.glsl"

    depth_too: bool = parameter(True, "The camera's depth blocks, too: the visibilities of both are multiplied.")

    def draw(self, drawing: Drawing, view: View, surfaces: Textures, sends: bool) -> Occluders:
        if not drawing.scene.height_maps:
            notice(
                f"scene '{drawing.scene.name}' has no height map: occluders='height' "
                + ("finds the camera's depth alone" if self.depth_too else "finds nothing, and all is open")
                + "; set Material.height"
            )
        reliefs = drawing.reliefs()
        own = self.bindings(dict(reliefs.textures), reliefs.uniforms)
        return Occluders(replace(own, constants={**own.constants, **reliefs.constants}))
