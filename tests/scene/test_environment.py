"""Environments: the map's convention, their irradiance against brute force, repairs, files, and the GLSL twin."""

import numpy as np
import OpenEXR
import pytest
from PIL import Image

from aolab.errors import FileError, Notice, SceneError
from aolab.gl.source import assemble
from aolab.scene.environment import HALF_MAX, Environment, averaged, direction_from_uv, uv_from_direction

AXES = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]], float)


def random_directions(count: int) -> np.ndarray:
    directions = np.random.default_rng(5).normal(size=(count, 3))
    return directions / np.linalg.norm(directions, axis=1, keepdims=True)


NORMALS = np.concatenate([AXES, random_directions(20)])


def texel_directions(height: int, width: int) -> np.ndarray:
    u, v = np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height)
    return direction_from_uv(np.stack([u, v], axis=-1))


def brute_force_irradiance(radiance: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """∫ L max(n·ω, 0) dω as a sum over the map's texels, without spherical harmonics."""
    height, width = radiance.shape[:2]
    directions = texel_directions(height, width)
    solid_angles = np.sin(np.pi * (np.arange(height) + 0.5) / height) * 2 * np.pi**2 / (height * width)
    cosines = np.maximum(np.einsum("hwd,nd->nhw", directions, normals), 0)
    return np.einsum("nhw,hwc,h->nc", cosines, radiance, solid_angles)


# --- the convention


@pytest.mark.parametrize(
    ("direction", "uv"),
    [
        ((0, 0, -1), (0.5, 0.5)),
        ((1, 0, 0), (0.75, 0.5)),
        ((-1, 0, 0), (0.25, 0.5)),
        ((0, np.sqrt(0.5), -np.sqrt(0.5)), (0.5, 0.25)),
        ((0, -np.sqrt(0.5), -np.sqrt(0.5)), (0.5, 0.75)),
    ],
)
def test_directions_have_the_documented_uv(direction, uv):
    np.testing.assert_allclose(uv_from_direction(np.array(direction)), uv, atol=1e-12)
    np.testing.assert_allclose(direction_from_uv(np.array(uv)), direction, atol=1e-12)


def test_up_is_the_first_row_and_down_the_last():
    assert uv_from_direction(np.array([0, 1, 0]))[1] == 0
    assert uv_from_direction(np.array([0, -1, 0]))[1] == 1


def test_direction_and_uv_round_trip():
    directions = random_directions(500).reshape(5, 100, 3)
    np.testing.assert_allclose(direction_from_uv(uv_from_direction(directions)), directions, atol=1e-7)


UV_SHADER = """
#include "lib/environment.glsl"
in vec3 direction;
out vec2 uv;
void main() { uv = environmentUv(direction); }
"""


def test_glsl_uv_equals_numpy(gl):
    program = gl.program(vertex_shader=assemble(UV_SHADER).text, varyings=["uv"])
    poles = np.array([[1e-3, 1, 0], [0, -1, 1e-3]]) / np.sqrt(1 + 1e-6)
    directions = np.concatenate([random_directions(500), AXES, poles]).astype("f4")
    gl.simple_framebuffer((1, 1)).use()  # transform feedback needs a complete framebuffer, even if unused
    result = gl.buffer(reserve=len(directions) * 2 * 4)
    gl.vertex_array(program, [(gl.buffer(directions.tobytes()), "3f", "direction")]).transform(result, mode=gl.POINTS)
    difference = np.frombuffer(result.read(), "f4").reshape(-1, 2) - uv_from_direction(directions)
    difference[:, 0] -= np.rint(difference[:, 0])  # u = 0 and u = 1 are the same column
    difference[np.abs(directions[:, 1]) == 1, 0] = 0  # at the poles every u is correct
    np.testing.assert_allclose(difference, 0, atol=1e-6)  # a 200th of a texel of a 4096-wide map


# --- irradiance


@pytest.mark.parametrize("radiance", [(1.0, 1.0, 1.0), (0.1, 0.7, 1000.0), (0.0, 0.0, 0.0)])
def test_constant_environment_casts_pi_times_its_radiance(radiance):
    expected = np.pi * np.float32(radiance).astype(float)
    np.testing.assert_allclose(
        Environment.constant(radiance).irradiance(NORMALS), np.tile(expected, (26, 1)), rtol=1e-13
    )


@pytest.mark.parametrize("size", [(1, 1), (3, 5), (300, 601), (1024, 2048)])
def test_constant_maps_of_any_size_are_exact(size):
    environment = Environment(np.full((*size, 3), 0.1, np.float32))
    np.testing.assert_allclose(environment.irradiance(NORMALS), np.pi * np.float64(np.float32(0.1)), rtol=1e-6)


def test_irradiance_of_a_linear_gradient_is_exact():
    """L = 1 + d·a gives E(n) = π + 2π/3 n·a: bands 0 and 1 represent it completely."""
    axis = np.array([0.3, -0.5, 0.6])
    radiance = 1 + texel_directions(128, 256) @ axis
    environment = Environment(np.repeat(radiance[..., None], 3, axis=2))
    expected = np.pi + 2 * np.pi / 3 * NORMALS @ axis
    np.testing.assert_allclose(environment.irradiance(NORMALS)[:, 1], expected, rtol=2e-4)


def test_irradiance_of_a_cosine_lobe_is_near_brute_force():
    """Towards the lobe's axis E = 2π/3. The error of three bands is at most 1 % of the greatest irradiance."""
    towards = np.array([0.6, 0.48, -0.64])
    lobe = np.maximum(texel_directions(128, 256) @ towards, 0)[..., None] * [1.0, 0.5, 2.0]
    found = Environment(lobe).irradiance(NORMALS)
    expected = brute_force_irradiance(lobe, NORMALS)
    np.testing.assert_allclose(found, expected, atol=0.01 * expected.max())
    assert Environment(lobe).irradiance(towards)[0] == pytest.approx(2 * np.pi / 3, rel=0.01)


def test_irradiance_of_the_sky_is_near_brute_force():
    """The error of three bands is at most 3/32 of ∫ L dω; for a sky with a sun it is below 2 % on average."""
    sky = Environment.sky(sun_direction=(1, 2, 0.5))
    normals = random_directions(200)
    expected = brute_force_irradiance(sky.radiance, normals)
    error = np.abs(sky.irradiance(normals) - expected)
    total = sky.irradiance_sh[0] / np.pi * np.sqrt(4 * np.pi)
    assert (error < 3 / 32 * total).all()
    assert error.mean() < 0.02 * expected.mean()


@pytest.mark.parametrize(
    ("height", "width"), [(700, 1501), (1024, 2048)]
)  # one size is a multiple of the projection's size
def test_large_maps_are_averaged_not_sampled(height, width):
    """Stripes of single rows and columns, finer than the projection's cells, vanish from a gradient's irradiance."""
    axis = np.array([0.3, -0.5, 0.6])
    stripes = np.add.outer((-1.0) ** np.arange(height), (-1.0) ** np.arange(width))
    radiance = 3 + texel_directions(height, width) @ axis + stripes
    environment = Environment(np.repeat(radiance[..., None], 3, axis=2))
    expected = 3 * np.pi + 2 * np.pi / 3 * NORMALS @ axis
    np.testing.assert_allclose(environment.irradiance(NORMALS)[:, 2], expected, rtol=1e-3)


@pytest.mark.parametrize(("size", "most"), [((16, 32), (4, 8)), ((15, 31), (4, 8)), ((9, 5), (2, 5))])
def test_an_averaged_map_sends_as_much_light_as_the_whole_one(size, most):
    """A row near a pole covers less of the sphere than one at the horizon: each counts by its own solid angle."""
    radiance = np.random.default_rng(6).random((*size, 3)).astype(np.float32)
    rows = -np.diff(np.cos(np.pi * np.arange(size[0] + 1) / size[0])) * 2 * np.pi / size[1]
    values, directions, solid_angles = averaged(radiance, most)
    assert values.shape[:2] == tuple(np.minimum(size, most))
    total = np.einsum("hwc,hw->c", values, solid_angles)
    if size[1] % most[1] == 0:  # else columns of a cell differ in number by one
        np.testing.assert_allclose(total, np.einsum("hwc,h->c", radiance, rows), rtol=1e-5)
    one_column = np.broadcast_to(radiance[:, :1], radiance.shape)
    whole = np.einsum("hwc,h->c", one_column, rows)
    np.testing.assert_allclose(np.einsum("hwc,hw->c", averaged(one_column, most)[0], solid_angles), whole, rtol=1e-5)
    np.testing.assert_allclose(solid_angles.sum(), 4 * np.pi, rtol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(directions, axis=2), 1, atol=1e-12)


def test_irradiance_is_never_negative():
    spot = np.zeros((64, 128, 3))
    spot[10, 20] = 1000
    environment = Environment(spot)
    assert (environment.irradiance(NORMALS) >= 0).all()
    assert (environment.irradiance(NORMALS) == 0).any()


# --- the sky


def test_the_sky_is_blue_above_and_exposes_a_surface_well():
    sky = Environment.sky()
    assert sky.radiance.dtype == np.float32
    top, bottom = sky.radiance[0, 0], sky.radiance[-1, 0]
    assert top[2] > top[1] > top[0]
    assert bottom[2] < bottom[1] < bottom[0]
    reflected = 0.7 * sky.irradiance(np.array([0.0, 1.0, 0.0])) / np.pi
    assert 0.4 < reflected.mean() < 0.8


@pytest.mark.parametrize("angle", [0.53, 6.0, 30.0])
def test_the_flux_of_the_sun_follows_from_its_radiance_and_angle(angle):
    towards = np.array([1.0, 1.0, -1.0])
    with_sun = Environment.sky(sun_direction=tuple(towards), sun_radiance=(100, 50, 10), sun_angle=angle).radiance
    sun = with_sun.astype(float) - Environment.sky().radiance
    solid_angles = np.sin(np.pi * (np.arange(128) + 0.5) / 128) * 2 * np.pi**2 / sun[..., 0].size
    expected = 2 * np.pi * (1 - np.cos(np.radians(angle) / 2)) * np.array([100, 50, 10])
    np.testing.assert_allclose(np.einsum("hwc,h->c", sun, solid_angles), expected, rtol=1e-3)
    row, column = np.unravel_index(sun[..., 0].argmax(), sun.shape[:2])
    assert texel_directions(128, 256)[row, column] @ towards / np.sqrt(3) > np.cos(np.radians(max(angle / 2, 1.5)))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"sun_direction": (0, 0, 0)}, r"sun_direction = \(0, 0, 0\) is not a direction"),
        ({"sun_direction": (0, 1)}, r"sun_direction = \(0, 1\) is not a direction"),
        ({"sun_direction": (0, np.nan, 1)}, "is not a direction"),
        ({"sun_direction": (0, 1, 0), "sun_angle": 0}, r"sun_angle = 0 is outside \(0, 180\] degrees"),
    ],
)
def test_a_sun_that_makes_no_sense_is_refused(changes, message):
    with pytest.raises(SceneError, match=message):
        Environment.sky(**changes)


# --- rotation


def test_rotation_by_a_quarter_turn_rolls_the_map():
    radiance = np.random.default_rng(0).random((4, 8, 3), np.float32)
    np.testing.assert_array_equal(Environment(radiance).rotated(90).radiance, np.roll(radiance, -2, axis=1))
    np.testing.assert_array_equal(Environment(radiance).rotated(-450).radiance, np.roll(radiance, 2, axis=1))


@pytest.mark.parametrize("degrees", [90, 37.3])
def test_rotation_is_right_handed_about_y(degrees):
    radiance = 1 + texel_directions(64, 128) @ np.array([0.0, 0.3, -0.9])
    rotated = Environment(np.repeat(radiance[..., None], 3, axis=2)).rotated(degrees)
    angle = np.radians(degrees)
    towards = np.array([-0.9 * np.sin(angle), 0.3, -0.9 * np.cos(angle)])
    expected = np.pi + 2 * np.pi / 3 * NORMALS @ towards
    np.testing.assert_allclose(rotated.irradiance(NORMALS)[:, 0], expected, rtol=2e-3)


def test_rotation_by_nan_is_refused():
    with pytest.raises(SceneError, match="cannot be rotated by nan degrees"):
        Environment.constant(1.0).rotated(np.nan)


# --- bad input


@pytest.mark.parametrize("shape", [(4, 8), (4, 8, 4), (0, 8, 3), (3,)])
def test_wrong_shapes_are_refused(shape):
    with pytest.raises(SceneError, match=r"environment 'environment': radiance has shape .*, not \(H, W, 3\)"):
        Environment(np.ones(shape))


def test_radiance_that_is_not_numeric_is_refused():
    with pytest.raises(SceneError, match="not an array of numbers"):
        Environment(np.full((1, 2, 3), "blue"))


def test_bad_pixels_are_repaired_and_counted():
    radiance = np.ones((2, 4, 3))
    radiance[0, 0] = np.nan
    radiance[0, 1, 2] = np.inf
    radiance[1, 2:, 0] = -3
    radiance[1, 0] = 7
    with pytest.warns(Notice, match="of 8 pixels, 1 NaN, 2 negative, 1 infinite: .* infinite 7") as notices:
        environment = Environment(radiance, "meadow.exr")
    assert "meadow.exr" in str(notices[0].message)
    assert notices[0].filename == __file__
    np.testing.assert_array_equal(environment.radiance[0, 0], 0)
    np.testing.assert_array_equal(environment.radiance[0, 1], (1, 1, 7))
    np.testing.assert_array_equal(environment.radiance[1, 2:], [[0, 1, 1], [0, 1, 1]])


@pytest.mark.parametrize("largest", [1e6, np.inf])
def test_infinite_pixels_stay_within_half_precision(largest):
    radiance = np.full((1, 2, 3), largest)
    radiance[0, 0] = 1e300  # infinite in float32
    with pytest.warns(Notice, match="infinite 65504"):
        environment = Environment(radiance)
    assert (environment.radiance[0, 0] == HALF_MAX).all()


def test_radiance_cannot_be_changed_behind_the_cached_irradiance():
    with pytest.raises(ValueError, match="read-only"):
        Environment.constant(1.0).radiance[:] = 2


# --- files


def test_exr_hdr_and_png_load_with_their_names(tmp_path):
    radiance = np.random.default_rng(0).random((4, 8, 3), np.float32) * 10
    write_exr(tmp_path / "field.exr", radiance)
    environment = Environment.load(tmp_path / "field.exr")
    np.testing.assert_array_equal(environment.radiance, radiance)
    assert environment.name == "field.exr"

    rgbe = np.broadcast_to(np.array([128, 64, 0, 130], np.uint8), (4, 8, 4))
    (tmp_path / "field.HDR").write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n" + rgbe.tobytes())
    np.testing.assert_array_equal(Environment.load(tmp_path / "field.HDR").radiance[3, 7], (2, 1, 0))

    Image.new("RGB", (8, 4), (255, 188, 0)).save(tmp_path / "field.png")
    pixel = Environment.load(str(tmp_path / "field.png")).radiance[0, 0]
    np.testing.assert_allclose(pixel, (1, 0.5029, 0), atol=1e-4)  # sRGB 188 is linear 0.5029 (IEC 61966-2-1)


@pytest.mark.parametrize("name", ["missing.hdr", "missing.exr", "missing.png"])
def test_a_missing_file_is_named(name, tmp_path):
    with pytest.raises(FileError, match=name):
        Environment.load(tmp_path / name)


# --- light probes


def write_exr(path, radiance: np.ndarray) -> None:
    with OpenEXR.File({"type": OpenEXR.scanlineimage}, {"RGB": radiance}) as file:
        file.write(str(path))


def angular_map(radiance, side: int) -> np.ndarray:
    """(side, side, 3): `radiance` of the direction -z, rotated by π r about y and by the pixel's angle about -z."""
    u, v = np.meshgrid((2 * np.arange(side) + 1) / side - 1, 1 - (2 * np.arange(side) + 1) / side)
    theta, phi = np.arctan2(v, u), np.pi * np.hypot(u, v)
    directions = np.stack([np.sin(phi) * np.cos(theta), np.sin(phi) * np.sin(theta), -np.cos(phi)], axis=-1)
    return np.where(phi[..., None] <= np.pi, radiance(directions), 0)


def test_a_light_probe_has_the_radiance_of_each_direction(tmp_path):
    def radiance(directions):
        return np.stack([1 + directions[..., 0], 1 + directions[..., 1], 1 + directions[..., 2]], axis=-1)

    write_exr(tmp_path / "probe.exr", angular_map(radiance, 128).astype(np.float32))
    probe = Environment.light_probe(tmp_path / "probe.exr")
    assert probe.name == "probe.exr"
    assert probe.radiance.shape == (128, 256, 3)
    expected = radiance(texel_directions(128, 256))
    off_the_rim = expected[..., 2] < 1.95  # the whole rim is the direction +z
    np.testing.assert_allclose(probe.radiance[off_the_rim], expected[off_the_rim], atol=0.03)
    np.testing.assert_allclose(probe.irradiance(np.eye(3)), radiance(np.eye(3) * 2 / 3) * np.pi, rtol=0.02)


def test_a_light_probe_is_square(tmp_path):
    write_exr(tmp_path / "wide.exr", np.ones((8, 16, 3), np.float32))
    with pytest.raises(SceneError, match=r"light probe 'wide.exr': it is 16x8, and an angular map is square"):
        Environment.light_probe(tmp_path / "wide.exr")
