"""Textures: the driver's limits, and what happens when its memory ends."""

import numpy as np
import pytest

from aolab import GpuMemoryError, ParameterError
from aolab.gl import texture
from aolab.gl.texture import FORMATS


@pytest.mark.parametrize("format", FORMATS)
def test_a_texture_is_read_back_upside_up(gl, format):
    """GL's first row is the bottom one; an array's is the top one."""
    components, dtype = FORMATS[format]
    values = np.arange(3 * 5 * components).reshape(3, 5, components) % 200
    stored = values.astype(
        {"f1": np.uint8, "nu2": np.uint16, "f2": np.float16, "f4": np.float32, "u4": np.uint32}[dtype]
    )
    read = texture.read(texture.make((5, 3), format, stored[::-1].tobytes()))
    assert read.dtype == {"f1": np.uint8, "nu2": np.uint16, "f2": np.float32, "f4": np.float32, "u4": np.uint32}[dtype]
    assert read.flags.c_contiguous
    np.testing.assert_array_equal(read, values[..., 0] if components == 1 else values)


def test_channels_may_be_fewer_than_stored(gl):
    values = np.arange(2 * 2 * 4, dtype=np.float32).reshape(2, 2, 4)
    made = texture.make((2, 2), "RGBA32F", values[::-1].tobytes())
    np.testing.assert_array_equal(texture.read(made, 3), values[..., :3])
    np.testing.assert_array_equal(texture.read(made, 1), values[..., 0])


def test_an_unknown_format_is_refused_with_the_nearest(gl):
    with pytest.raises(ParameterError, match=r"texture format 'R64F' is unknown; did you mean 'R\d\dF'\?"):
        texture.make((1, 1), "R64F")


def test_sizes_beyond_the_drivers_limit_are_refused_and_name_it(lab, plane, gl):
    limit = gl.info["GL_MAX_TEXTURE_SIZE"]
    for size in ((limit + 1, 1), (1, limit + 1)):
        with pytest.raises(
            ParameterError, match=rf"size = {size[0]}x{size[1]}: each side must be from 1 to {limit} pixels"
        ):
            lab.render(plane, size=size)


@pytest.mark.parametrize("upright", [False, True])
def test_the_longest_image_works(lab, boxes, gl, upright):
    limit = gl.info["GL_MAX_TEXTURE_SIZE"]
    size = (1, limit) if upright else (limit, 1)
    frame = lab.render(boxes, "ssao", size=size)
    assert frame.image.shape[:2] == size[::-1]
    assert frame.mask.any()
    assert 0 <= np.nanmin(frame["visibility"]) <= np.nanmax(frame["visibility"]) <= 1


# a driver on the CPU takes the process's memory, so a limit on that is one on the "GPU's"
EXHAUSTED = """
import resource, sys
import numpy as np, trimesh
import aolab

lab, scene = aolab.Lab((32, 24)), aolab.load(trimesh.creation.box())
before = lab.render(scene).image
held = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
more = held + {megabytes} * 2**20
resource.setrlimit(resource.RLIMIT_AS, (more, more))
limit = aolab.gl.context.get().info["GL_MAX_TEXTURE_SIZE"]
try:
    frame = lab.render(scene, size={size})
    print("drawn", int(frame.image.max()))
except aolab.GpuMemoryError as error:
    print("refused", error)
np.testing.assert_array_equal(lab.render(scene).image, before)
print("usable")
"""


@pytest.mark.parametrize("megabytes", [20, 60, 130, 300])
def test_exhausted_memory_is_an_error_and_never_a_black_picture(python, gl, megabytes):
    """2048² pixels need about 250 MB: the memory ends at another place each time, or holds."""
    pytest.importorskip("resource", reason="limits on memory are POSIX's")
    if "llvmpipe" not in gl.info["GL_RENDERER"]:
        pytest.skip("the driver's memory is not this process's")
    done = python(EXHAUSTED.format(megabytes=megabytes, size=(2048, 2048)))
    assert done.returncode == 0, done.stderr
    outcome, usable = done.stdout.splitlines()
    assert usable == "usable"
    assert outcome.startswith("refused") or int(outcome.split()[1]) > 50
    if megabytes <= 60:
        assert "memory" in outcome
    if megabytes <= 20:
        assert "2048x2048" in outcome


def test_the_largest_image_is_drawn_or_refused(python, gl):
    pytest.importorskip("resource", reason="limits on memory are POSIX's")
    if "llvmpipe" not in gl.info["GL_RENDERER"]:
        pytest.skip("the driver's memory is not this process's")
    done = python(EXHAUSTED.format(megabytes=1500, size="(limit, limit)"))
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("refused the driver ran out of memory for a 16384x16384 ")
    assert done.stdout.endswith("usable\n")


def test_memory_errors_are_pythons_memory_errors():
    assert issubclass(GpuMemoryError, MemoryError)
