"""Shadow maps: every light's tiles in one depth atlas, drawn again only when lights or geometry change."""

from dataclasses import dataclass
from math import ceil, sqrt

import moderngl
import numpy as np

from ..errors import SceneError
from ..gl import context
from ..gl.texture import attach, refuse_exhaustion
from ..scene.lights import DirectionalLight, Light, PointLight, SpotLight
from ..scene.scene import Scene
from ..scene.view import matrix_bytes
from .geometry import Geometry
from .pass_runner import Painter

FINE, COARSE = 2048, 1024  # pixels a side of a light's map: fine for up to four of them. SSDO (2009) used 512
MAX_TILES = 32  # mat4 uniforms: OpenGL 3.3 grants 1024 floats, and these take 512
SLOPE_BIAS, CONSTANT_BIAS = 3.0, 4.0  # glPolygonOffset: the filter reaches 1.25 texels in x and in y

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
    """`atlas` is a depth texture; tile i covers `tiles[i]` (corner x, y and size, in uv), seen by `matrices[i]`."""

    atlas: moderngl.Texture
    matrices: np.ndarray  # (tiles, 4, 4) clip_from_world
    tiles: np.ndarray  # (tiles, 3)
    first_tile: tuple[int, ...]  # a light; -1 casts no shadow


def look_along(position: np.ndarray, direction: np.ndarray, up: np.ndarray | None = None) -> np.ndarray:
    """(4, 4) view_from_world of a light at `position` that looks along `direction`."""
    backward = -np.asarray(direction, float) / np.linalg.norm(direction)
    right = np.cross(np.eye(3)[np.argmin(np.abs(backward))] if up is None else up, backward)
    right /= np.linalg.norm(right)
    matrix = np.eye(4)
    matrix[:3, :3] = right, np.cross(backward, right), backward
    matrix[:3, 3] = -matrix[:3, :3] @ position
    return matrix


def orthographic(radius: float, far: float) -> np.ndarray:
    """(4, 4) clip_from_view of a box of half width `radius`, from 0 to `far` along -z."""
    return np.array([[1 / radius, 0, 0, 0], [0, 1 / radius, 0, 0], [0, 0, -2 / far, -1], [0, 0, 0, 1]], float)


def perspective(half_angle: float, near: float, far: float) -> np.ndarray:
    """(4, 4) clip_from_view of a square pyramid; `half_angle` in degrees."""
    scale = 1 / np.tan(np.radians(half_angle))
    depth = -(far + near) / (far - near), -2 * far * near / (far - near)
    return np.array([[scale, 0, 0, 0], [0, scale, 0, 0], [0, 0, *depth], [0, 0, -1, 0]], float)


def light_matrices(light: Light, scene: Scene) -> list[np.ndarray]:
    """clip_from_world of each tile that the light needs: one, or six for a point light."""
    centre, radius = scene.bounds.mean(axis=0), scene.radius * 1.001
    if isinstance(light, DirectionalLight):
        direction = np.asarray(light.direction) / np.linalg.norm(light.direction)
        return [orthographic(radius, 2 * radius) @ look_along(centre - direction * radius, direction)]
    position = np.asarray(light.position, float)
    far = float(np.linalg.norm(position - centre)) + radius
    near = far * 1e-3
    if isinstance(light, SpotLight):
        return [perspective(light.outer + 1, near, far) @ look_along(position, np.asarray(light.direction))]
    faces = [look_along(position, np.array(look), np.array(up)) for look, up in _CUBE]
    return [perspective(45, near, far) @ face for face in faces]


def draw_shadows(painter: Painter, geometry: Geometry, scene: Scene) -> ShadowMaps:
    """Draw the shadow maps of all lights. Raises `SceneError` for more tiles than a shader can hold."""
    gl = context.get()
    matrices: list[np.ndarray] = []
    first_tile = []
    for light in scene.lights:
        first_tile.append(len(matrices) if light.shadow else -1)
        matrices += light_matrices(light, scene) if light.shadow else []
    if len(matrices) > MAX_TILES:
        points = sum(isinstance(light, PointLight) for light in scene.lights)
        raise SceneError(
            f"scene '{scene.name}': its {len(scene.lights)} lights ({points} of them points, six tiles each) need "
            f"{len(matrices)} shadow tiles; the limit is {MAX_TILES}. Set shadow=False on the lesser lights"
        )
    side = max(1, ceil(sqrt(len(matrices))))
    tile = (FINE if len(matrices) <= 4 else COARSE) if matrices else 1
    width = side * tile
    atlas = gl.depth_texture((width, width))
    refuse_exhaustion(f"shadow maps of {width}x{width}")
    atlas.compare_func = "<="
    atlas.filter = (moderngl.LINEAR, moderngl.LINEAR)
    atlas.repeat_x = atlas.repeat_y = False
    framebuffer = attach([], atlas)
    program = painter.programs.get("pipeline/shadow.frag", vertex="pipeline/shadow.vert")
    tiles = np.array([(i % side / side, i // side / side, 1 / side) for i in range(max(1, len(matrices)))])
    with painter.timer.measure("shadows"):
        framebuffer.clear(depth=1.0)
        framebuffer.use()
        gl.enable_only(moderngl.DEPTH_TEST)
        gl.polygon_offset = SLOPE_BIAS, CONSTANT_BIAS
        for index, matrix in enumerate(matrices):
            framebuffer.viewport = (index % side * tile, index // side * tile, tile, tile)
            uniforms = {"clip_from_world": matrix_bytes(matrix), "base_color": (1.0,) * 4, "alpha_cutoff": 0.0}
            program.set(uniforms)
            painter.bind_unit(program, "base_texture", 0)
            geometry.draw(scene, program)
        gl.polygon_offset = 0.0, 0.0
        gl.enable_only(moderngl.NOTHING)
    stacked = np.array(matrices) if matrices else np.eye(4)[None]
    return ShadowMaps(atlas, stacked, tiles, tuple(first_tile))
