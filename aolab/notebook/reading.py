"""`aolab.glyph`: the glyph of a pixel, computed from a frame's buffers and from the light of its scene."""

import operator
from collections.abc import Iterator, Mapping

import numpy as np

from ..errors import ParameterError
from ..gl.texture import Size
from ..maths.harmonics import hanning, light_lobe, rotate, zonal_lobe
from ..modules import MODULES, S3HO
from ..modules.s3ho import BOUNCE, SENDERS, unpacked
from ..pipeline.frame import Frame, check_frame
from ..scene.camera import Camera
from ..scene.lights import DirectionalLight
from ..scene.scene import Scene
from ..scene.view import View
from ..truth.lighting import towards_light
from ..truth.points import window
from .glyph import Glyph

HARMONICS = [f"sh{i}" for i in range(4)]
SENDER_LIFT = 0.08  # radii; as in glsl/s3ho.indirect.frag


def glyph(frame: Frame, pixel: tuple[int, int]) -> Glyph:
    """Occlusion and light at `pixel` (column, row) of a frame's image, counted from the top left.

    The frame needs spherical harmonics: `aolab.render(scene, "s3ho")`, relit or not, or
    `aolab.reference(scene, buffers=("sh0", "sh1", "sh2", "sh3"))`. Raises `ParameterError` for any other frame, and for
    a pixel outside the image or in the background.
    """
    scene = lit_scene(frame)
    column, row = inside(pixel, frame.size)
    here = Frame(_Texels(frame, column, row), {}, frame.info, derived=frame.derived)
    if not here.mask[0, 0]:
        raise ParameterError(f"glyph: pixel ({column}, {row}) is in the background; frame.mask is True at surfaces")
    position = _position(frame.camera, frame.size, (column, row), float(here["viewZ"][0, 0]))
    parameters = frame.info["parameters"]
    window = parameters.get("light_window", S3HO().light_window)
    bounce = bounce_light = None
    if set(SENDERS) <= set(frame.buffers):
        bounce = _bounce(here)
        bounce_light = _light(scene, position + parameters["radius"] * _to_senders(here, bounce), window)
    return Glyph(
        pixel=(column, row),
        position=position,
        normal=here.world_normal()[0, 0],
        coefficients=np.concatenate([here[name][0, 0] for name in HARMONICS]).astype(np.float64),
        light=_light(scene, position, window),
        bounce=bounce,
        bounce_light=bounce_light,
        camera=frame.camera,
    )


class _Texels(Mapping[str, np.ndarray]):
    """One pixel of each texture. A frame made of them derives `sh0` to `sh3` for this pixel only."""

    def __init__(self, frame: Frame, column: int, row: int) -> None:
        self._frame, self._pixel = frame, (slice(row, row + 1), slice(column, column + 1))

    def __getitem__(self, name: str) -> np.ndarray:
        return self._frame[name][self._pixel]

    def __iter__(self) -> Iterator[str]:
        return iter(self._frame.textures)

    def __len__(self) -> int:
        return len(self._frame.textures)


def lit_scene(frame: Frame) -> Scene:
    """The frame's scene. Raises `ParameterError` if the frame lacks the scene or a buffer that glyphs need."""
    check_frame(frame, "glyph")
    if missing := [name for name in HARMONICS if name not in frame.buffers]:
        modules = ", ".join(name for name, module in MODULES.items() if "sh0" in module.derived)
        raise ParameterError(
            f"glyph: this frame, of {frame.info.get('module')}, has no {', '.join(missing)}; they are buffers of the "
            f"modules {modules}, and of aolab.reference(scene, buffers={tuple(HARMONICS)})"
        )
    if frame.scene is None:
        raise ParameterError("glyph: this frame has no scene, so its light is unknown; render the frame with a lab")
    return frame.scene


def inside(pixel: tuple[int, int], size: Size, caller: str = "glyph") -> tuple[int, int]:
    """`pixel` as Python integers (column, row); NumPy integers are accepted. Raises `ParameterError` if outside."""
    width, height = size
    try:
        column, row = map(operator.index, pixel)
        found = 0 <= column < width and 0 <= row < height
    except (TypeError, ValueError):
        column, row, found = 0, 0, False
    if not found:
        raise ParameterError(
            f"{caller}: pixel = {pixel!r} is not a (column, row) of this image, {width}x{height}: "
            f"columns are 0 to {width - 1}, rows 0 to {height - 1}, from the top left"
        )
    return column, row


def _position(camera: Camera, size: Size, pixel: tuple[int, int], view_z: float) -> np.ndarray:
    """The world-space point (3,) at depth `view_z` on the ray through the centre of `pixel` (column, row)."""
    view = View(camera, size, np.zeros((2, 3)))  # the bounds only determine clip planes, which are not used here
    position = view.positions(window(view, np.array(pixel[1] * size[0] + pixel[0])), view_z)
    world_from_view = np.linalg.inv(camera.view_from_world)
    return world_from_view[:3, :3] @ position + world_from_view[:3, 3]


def _light(scene: Scene, position: np.ndarray, window: float) -> np.ndarray:
    """(16, 3): c_Lin at world-space `position` (3,), Eq. 4, as in glsl/s3ho.direct.glsl and s3ho.ambient.glsl."""
    assert scene.environment is not None  # Scene sets it
    total = scene.environment.radiance_sh.copy()
    lobe = light_lobe(hanning(window))
    for light in scene.lights:
        # relative to `position` as the origin, where float32 is most precise
        towards, _, share = towards_light(light, np.zeros((1, 3), np.float32), position)
        color = light.irradiance if isinstance(light, DirectionalLight) else light.intensity
        total += np.outer(zonal_lobe(lobe, towards[0]), float(share[0]) * np.asarray(color))
    return total


def _bounce(here: Frame) -> np.ndarray:
    """c_SSGI (16, 3), world space: nine coefficients, then zeros."""
    texels = np.concatenate([here[name][0] for name in BOUNCE])  # (7, 4)
    seen = np.zeros((16, 3))
    seen[:9] = unpacked(texels)
    return rotate(seen.T, here.camera.view_from_world[:3, :3].T).T


def _to_senders(here: Frame, bounce: np.ndarray) -> np.ndarray:
    """(3,) world space, in radii: from the pixel to its senders' mean position, as in glsl/s3ho.indirect.frag."""
    *offset, weight = here["sender_offset"][0, 0].astype(np.float64)
    if weight <= 0:
        return np.zeros(3)
    world_from_view = here.camera.view_from_world[:3, :3].T
    y, z, x = bounce[1:4].sum(axis=1) * (-1, 1, -1)  # band 1 of a lobe around n is -n.y, n.z, -n.x times a factor
    normal = np.array((x, y, z))
    return world_from_view @ (np.array(offset) / weight) + SENDER_LIFT * normal / max(np.linalg.norm(normal), 1e-10)
