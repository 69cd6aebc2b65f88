"""Shadow maps: every light's tiles in one depth atlas, drawn again only when lights or geometry change."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, sqrt

import moderngl
import numpy as np

from ..errors import ParameterError, SceneError
from ..gl import context
from ..gl.texture import make, refuse_exhaustion
from ..maths.transforms import look_along, orthographic, perspective
from ..modules import Module
from ..modules.parameters import AUTO
from ..modules.passes import GeometryPass
from ..scene.lights import MAX_SHADOW_TILES, DirectionalLight, Light, PointLight, SpotLight
from ..scene.scene import Scene
from ..scene.view import Projection
from .rasterizer import Rasterizer

_SHADOWS = GeometryPass("shadows", "pipeline/shadow.frag", {}, vertex="pipeline/shadow.vert")

# pixels a side of a tile, by the number of tiles that it is for. SSDO (2009) used 512
TILE_SIZES = {4: 2048, 36: 1024, 256: 512}
CONSTANT_BIAS = 4.0  # glPolygonOffset, in the least steps of depth

# right-handed looks of a point light's six faces, in the order of `cubeFace` in glsl/lib/light.glsl
_CUBE = (
    ((1, 0, 0), (0, 1, 0)),
    ((-1, 0, 0), (0, 1, 0)),
    ((0, 1, 0), (0, 0, 1)),
    ((0, -1, 0), (0, 0, 1)),
    ((0, 0, 1), (0, 1, 0)),
    ((0, 0, -1), (0, 1, 0)),
)


@dataclass(frozen=True)
class ShadowMaps:
    """The shadow maps of all lights: tiles of `atlas`, a depth texture.

    `table` has a row for each tile: the four columns of its clip_from_world; then its corner x, y and its side, in
    pixels, and its bias at the distance 1 for a slope of 1, in scene units (glsl/lib/shadow_tiles.glsl).
    """

    atlas: moderngl.Texture
    table: moderngl.Texture
    rows: np.ndarray  # (tiles, 5, 4) float32: those of `table`
    first_tile: tuple[int, ...]  # of each light; -1 for a light without shadow


def light_projections(light: Light, scene: Scene) -> list[tuple[np.ndarray, np.ndarray]]:
    """(view_from_world, clip_from_view) of each tile that the light needs: one, or six for a point light.

    The world is that of the shaders, whose origin is `Scene.shader_origin`.
    """
    centre, radius = scene.centre - scene.shader_origin, scene.radius * 1.001
    if isinstance(light, DirectionalLight):
        direction = np.asarray(light.direction) / np.linalg.norm(light.direction)
        return [(look_along(centre - direction * radius, direction), orthographic(radius, radius, 0, 2 * radius))]
    position = np.asarray(light.position, float) - scene.shader_origin
    far = float(np.linalg.norm(position - centre)) + radius
    near = far * 1e-3
    if isinstance(light, SpotLight):
        tan = float(np.tan(np.radians(light.outer + 1)))
        return [(look_along(position, np.asarray(light.direction)), perspective(tan, tan, near, far))]
    return [(look_along(position, np.array(look), np.array(up)), perspective(1, 1, near, far)) for look, up in _CUBE]


@dataclass(frozen=True)
class ShadowSettings:
    """`resolution`: pixels a side of a tile, None by `TILE_SIZES`; `slope_bias`: in texels times tan α; 0 is none."""

    resolution: int | None = None
    slope_bias: float = 3.0

    @classmethod
    def of(cls, module: Module) -> "ShadowSettings":
        """The settings that a module states: its bias is in halves of a texel."""
        resolution = None if module.shadow_resolution == AUTO else module.shadow_resolution
        return cls(resolution, 0.0 if module.shadow_bias == "none" else module.shadow_bias / 2)


def draw_shadows(rasterizer: Rasterizer, settings: ShadowSettings) -> ShadowMaps:
    """Draw the shadow maps of all lights. Raises `SceneError` for more tiles than an atlas has room for."""
    scene = rasterizer.scene
    projections: list[tuple[np.ndarray, np.ndarray]] = []
    first_tile = []
    for light in scene.lights:
        first_tile.append(len(projections) if light.shadow else -1)
        projections += light_projections(light, scene) if light.shadow else []
    count = len(projections)
    if count > MAX_SHADOW_TILES:
        points = sum(isinstance(light, PointLight) for light in scene.lights)
        raise SceneError(
            f"scene '{scene.name}': its {len(scene.lights)} lights ({points} of them points, six tiles each) need "
            f"{count} shadow tiles; the limit is {MAX_SHADOW_TILES}. Set shadow=False on the lesser lights"
        )
    auto = next(size for most, size in TILE_SIZES.items() if count <= most) if count else 1
    atlas, table, rows = draw_tiles(
        rasterizer, projections, (settings.resolution or auto) if count else 1, settings.slope_bias
    )
    return ShadowMaps(atlas, table, rows, tuple(first_tile))


def draw_tiles(
    rasterizer: Rasterizer, projections: Sequence[tuple[np.ndarray, np.ndarray]], tile: int, slope_bias: float
) -> tuple[moderngl.Texture, moderngl.Texture, np.ndarray]:
    """The atlas of the depths that the projections see, `tile` pixels a side each, its table and rows (`ShadowMaps`).

    Raises `ParameterError` for an atlas that is larger than the driver allows.
    """
    gl, count = context.get(), len(projections)
    columns = max(1, ceil(sqrt(count)))
    width, height = columns * tile, max(1, ceil(count / columns)) * tile
    limit = gl.info["GL_MAX_TEXTURE_SIZE"]
    if width > limit:
        raise ParameterError(
            f"{count} shadow maps of {tile} pixels a side need an atlas of {width}x{height}; this driver has at most "
            f"{limit}x{limit}. At most {(limit // tile) ** 2} such maps fit, or {count} of {limit // columns} pixels"
        )
    atlas = gl.depth_texture((width, height))
    refuse_exhaustion(f"shadow maps of {width}x{height}")
    atlas.compare_func = "<="
    atlas.filter = (moderngl.LINEAR, moderngl.LINEAR)
    atlas.repeat_x = atlas.repeat_y = False
    corners = [(index % columns * tile, index // columns * tile) for index in range(count)]
    views = [
        Projection(view, clip, (tile, tile), corner, (width, height))
        for corner, (view, clip) in zip(corners, projections, strict=True)
    ]
    if views:
        gl.polygon_offset = slope_bias, CONSTANT_BIAS if slope_bias else 0.0
        rasterizer.triangles(_SHADOWS, views, depth=atlas)
        gl.polygon_offset = 0.0, 0.0
    table = np.zeros((max(1, count), 5, 4), np.float32)  # GL has no empty texture
    for row, (view, clip) in enumerate(projections):
        table[row, :4] = (clip @ view).T
        texel = 2 / clip[0, 0] / tile  # its width, at the distance 1 if the rays are not parallel
        table[row, 4] = *corners[row], tile, slope_bias * texel
    return atlas, make((5, len(table)), "RGBA32F", table.tobytes()), table
