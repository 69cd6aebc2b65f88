"""Occluders: peeled depth layers of the camera, with solids between them."""

import moderngl

from ...gl.bindings import Bindings
from ...scene.view import View
from ..buffers import BACKGROUND_Z, SURFACES
from ..parameters import parameter
from ..passes import Pass
from .base import Drawing, Hidden, OccluderKind, Occluders, Textures
from .open_meshes import name_open_meshes

MOST = 4  # layers in the four channels of `layersZ`
DEPTHS = {"viewZ": SURFACES["viewZ"].format}
G_BUFFER = {name: buffer.format for name, buffer in SURFACES.items()}


class Layers(OccluderKind):
    """Up to `layers` depth layers, peeled (Everitt 2001); peeling stops early where nothing is left."""

    name = "layers"
    shader = "occluders/layers.glsl"

    layers: int = parameter(4, "Depth layers of the camera: two make a solid.", ge=2, le=MOST)

    def draw(self, drawing: Drawing, view: View, surfaces: Textures, sends: bool) -> Occluders:
        name_open_meshes(drawing.scene)
        behind = drawing.peeled(surfaces["viewZ"], self.layers - 1, [view], G_BUFFER if sends else DEPTHS)
        textures = packed(drawing, surfaces["viewZ"], behind)
        if not sends:
            return Occluders(self.bindings(textures))
        # samplers must be bound: of a layer that is not there, the shader reads nothing
        for number, layer in enumerate([*behind, *[surfaces] * (MOST - 1 - len(behind))], start=1):
            textures |= {f"viewNormal{number}": layer["viewNormal"], f"sender{number}": layer["albedo"]}
        bindings = self.bindings(textures)
        hidden = [Hidden(f"sender{number}", layer, [view], bindings) for number, layer in enumerate(behind, start=1)]
        return Occluders(bindings, hidden)


def packed(drawing: Drawing, nearest: moderngl.Texture, behind: list[Textures]) -> Textures:
    """`layersZ`: the depths of up to four layers in one texture, so that a tap reads them all."""
    depths = [nearest, *(layer["viewZ"] for layer in behind)]
    padded = depths + [nearest] * (MOST - len(depths))  # samplers must be bound; `count` layers are read
    inputs = Bindings("the layers", {f"layer{number}": texture for number, texture in enumerate(padded)})
    step = Pass(
        "pack layers",
        "pipeline/pack_layers.frag",
        {"layersZ": "RGBA32F"},
        {"count": len(depths)},
        outside={"layersZ": BACKGROUND_Z},
    )
    return drawing.run(step, [inputs], nearest.size)
