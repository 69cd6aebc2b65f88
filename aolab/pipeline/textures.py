"""Textures of materials on the GPU, with mip levels that keep the area of cut-out surfaces."""

import moderngl
import numpy as np

from ..errors import notice
from ..gl import context, raw
from ..gl.texture import refuse_exhaustion
from ..pictures.images import linear_from_srgb
from ..scene.mesh import Texture

GL_SRGB8_ALPHA8 = 0x8C43
GL_RGBA8 = 0x8058


def upload(texture: Texture, cutoff: float | None, colors: bool = True) -> moderngl.Texture:
    """The texture, 8 bits sRGB, or linear numbers without `colors`.

    `cutoff` is the alpha below which the texture has holes, None where it has none.

    A picture that is larger than the driver allows is drawn smaller, with a `Notice`. Raises `GpuMemoryError`.
    """
    from PIL import Image  # here: most scenes have no textures

    gl = context.get()
    limit = gl.info["GL_MAX_TEXTURE_SIZE"]
    pixels = texture.pixels
    height, width = pixels.shape[:2]
    if max(width, height) > limit:
        scale = limit / max(width, height)
        size = max(1, int(width * scale)), max(1, int(height * scale))
        notice(
            f"texture '{texture.name}' of {width}x{height} is over the driver's {limit}: drawn at {size[0]}x{size[1]}"
        )
        pixels = np.asarray(Image.fromarray(pixels).resize(size, Image.Resampling.BOX))
        height, width = pixels.shape[:2]
    flipped = np.ascontiguousarray(pixels[::-1])  # GL's first row is the bottom one
    uploaded = gl.texture(
        (width, height), 4, flipped.tobytes(), internal_format=GL_SRGB8_ALPHA8 if colors else GL_RGBA8
    )
    refuse_exhaustion(f"texture '{texture.name}' of {width}x{height}")
    near = moderngl.NEAREST if texture.nearest else moderngl.LINEAR
    if texture.mipmaps:
        uploaded.build_mipmaps()
        if cutoff is not None:
            for level, smaller in enumerate(covering_levels(flipped, cutoff), start=1):
                uploaded.write(smaller.tobytes(), level=level)
        far = moderngl.NEAREST_MIPMAP_LINEAR if texture.nearest else moderngl.LINEAR_MIPMAP_LINEAR
    else:
        far = near
    uploaded.filter = (far, near)
    uploaded.repeat_x, uploaded.repeat_y = (wrap == "repeat" for wrap in texture.wrap)
    for axis, wrap in enumerate(texture.wrap):
        if wrap == "mirror":
            raw.mirror(uploaded, axis)
    return uploaded


def covering_levels(pixels: np.ndarray, cutoff: float) -> list[np.ndarray]:
    """The mip levels from 1 on of a cut-out texture (H, W, 4) uint8, each (h, w, 4) uint8.

    Their alpha is the share of the texels below that are not cut: the mean of alpha itself would fall under the cutoff
    nearly everywhere, and a leaf vanish in the distance. Their colour is the mean, linear, of the texels that are seen.
    """
    height, width = pixels.shape[:2]
    kept = (pixels[..., 3] >= cutoff * 255).astype(np.float32)
    color = linear_from_srgb(pixels[..., :3])
    planes = [color[..., channel] * kept for channel in range(3)]
    levels = []
    size = width, height
    while max(size) > 1:
        size = max(1, size[0] // 2), max(1, size[1] // 2)
        kept = _halved(kept, size)
        planes = [_halved(plane, size) for plane in planes]
        seen = np.stack(planes, axis=-1) / np.maximum(kept, 1e-6)[..., None]
        levels.append(np.dstack([_srgb(seen), np.rint(kept * 255).astype(np.uint8)]))
    return levels


def _halved(plane: np.ndarray, size: tuple[int, int]) -> np.ndarray:
    from PIL import Image

    return np.asarray(Image.fromarray(plane).resize(size, Image.Resampling.BOX))


def _srgb(linear: np.ndarray) -> np.ndarray:
    """Linear to sRGB, uint8 (IEC 61966-2-1)."""
    linear = linear.clip(0, 1)
    encoded = np.where(linear <= 0.0031308, linear * 12.92, 1.055 * linear ** (1 / 2.4) - 0.055)
    return np.rint(encoded * 255).astype(np.uint8)
