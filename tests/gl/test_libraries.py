"""The shared GLSL against its NumPy twins and against its own properties."""

import numpy as np
import pytest

import aolab
from aolab.scene.view import View

RNG = np.random.default_rng(3)


def rows(*columns) -> np.ndarray:
    """(n, 4) float32 of up to four columns, or blocks of columns."""
    columns = [np.atleast_2d(np.asarray(column, np.float32).T).T for column in columns]
    x = np.concatenate(columns, axis=1)
    return np.pad(x, ((0, 0), (0, 4 - x.shape[1])))


def directions(count: int) -> np.ndarray:
    """(count, 3) unit vectors all around, the axes among them."""
    axes = np.concatenate([np.eye(3), -np.eye(3)])
    random = RNG.normal(size=(count - 6, 3))
    return np.concatenate([axes, random / np.linalg.norm(random, axis=1, keepdims=True)])


# --- space


@pytest.mark.parametrize("ortho", [None, 7.0], ids=["perspective", "orthographic"])
@pytest.mark.parametrize("size", [(1, 1), (1, 7), (640, 360), (33, 64)])
def test_pixels_become_positions_and_positions_pixels(glsl, size, ortho):
    camera = aolab.Camera((1, 2, 3), (0, 0, 0), fov=50, ortho=ortho)
    view = View(camera, size, np.array([[-1.0] * 3, [1.0] * 3]))
    pixel = RNG.random((500, 2)) * size
    view_z = -np.exp(RNG.uniform(np.log(1e-3), np.log(1e4), 500))

    def evaluate(expression: str, x: np.ndarray) -> np.ndarray:
        given = {name: view.uniforms[name] for name in ("ray_from_pixel", "pixel_from_ray")}
        return glsl("lib/space.glsl", f"result.xyz = {expression};", x, **view.constants, **given)[:, :3]

    position = evaluate("viewPosAt(x.xy, x.z, ray_from_pixel)", rows(pixel, view_z))
    scale = np.maximum(-view_z, 1)[:, None]
    np.testing.assert_allclose(position / scale, view.positions(pixel, view_z) / scale, rtol=1e-5, atol=1e-5)
    # the twin: the window coordinates of the position's projection are the pixel
    clip = np.append(position, np.ones((500, 1)), axis=1) @ camera.clip_from_view(size, view.bounds).T
    np.testing.assert_allclose((clip[:, :2] / clip[:, 3:] + 1) / 2 * size, pixel, atol=1e-5 * max(size))
    np.testing.assert_allclose(position[:, 2], view_z, rtol=1e-6)

    for again in (evaluate("vec3(pixelAt(x.xyz, pixel_from_ray), 0.0)", rows(position))[:, :2], view.pixels(position)):
        np.testing.assert_allclose(again, pixel, atol=1e-5 * max(size))

    # a point farther along the same ray: the eye sees it at the same pixel, in the direction of the ray
    behind = evaluate("onRayOf(x.xyz, 2.0 * x.z)", rows(position))
    np.testing.assert_allclose(behind[:, 2], 2 * view_z, rtol=1e-6)
    np.testing.assert_allclose(view.pixels(behind), pixel, atol=1e-5 * max(size))
    sight = evaluate("sightTo(x.xyz)", rows(position))
    way, sight = (vectors / np.linalg.norm(vectors, axis=1)[:, None] for vectors in (behind - position, sight))
    np.testing.assert_allclose(np.cross(sight, way), 0, atol=1e-4)


def test_a_point_behind_the_eye_lands_far_off_the_screen(glsl):
    behind = rows(RNG.uniform(1, 2, (20, 2)) * RNG.choice([-1, 1], (20, 2)), RNG.uniform(0, 5, 20))
    pixel = glsl("lib/space.glsl", "result.xy = pixelAt(x.xyz, a);", behind, a=(100, 100, 50, 50))
    assert (np.abs(pixel[:, :2]) > 1e6).all()
    assert np.isfinite(pixel).all()


def test_only_minus_infinity_is_background(glsl):
    x = rows([-np.inf, -1e15, -1.0, -1e-30])
    assert glsl("lib/space.glsl", "result.x = float(isBackground(x.x));", x)[:, 0].tolist() == [1, 0, 0, 0]


def test_lift_off_is_the_bias_or_a_pixel_at_the_farthest_point(glsl):
    x = rows([0.5, 0.0, 0.0], [2.0, 2.0, 0.0], [-10.0, -10.0, -10.0])
    lift = glsl("lib/space.glsl", "result.x = liftOff(x.x, x.y, vec3(0, 0, x.z), a);", x, a=(0.01, 0.01, 0, 0))
    np.testing.assert_allclose(lift[:, 0], [0.5, 0.12, 0.1], rtol=1e-6)


def test_lift_off_of_an_orthographic_picture_is_the_bias_or_a_pixel(glsl):
    x = rows([0.5, 0.0, 0.0], [2.0, 2.0, 0.0], [-10.0, -10.0, -10.0])
    text = "result.x = liftOff(x.x, x.y, vec3(0, 0, x.z), a);"
    lift = glsl("lib/space.glsl", text, x, orthographic=True, a=(0.01, 0.01, 0, 0))
    np.testing.assert_allclose(lift[:, 0], [0.5, 0.01, 0.01], rtol=1e-6)


# --- sampling


def test_each_block_of_4x4_pixels_holds_every_set_once(glsl):
    y, x = np.mgrid[0:12, 0:20]
    sets = glsl("lib/sampling.glsl", "result.x = float(interleavedSet(ivec2(x.xy)));", rows(x.ravel(), y.ravel()))
    sets = sets[:, 0].astype(int).reshape(12, 20)
    for top in range(9):  # any window of 4×4, aligned or not: the window of the filters
        for left in range(17):
            assert sorted(sets[top : top + 4, left : left + 4].ravel()) == list(range(16))


def test_sets_of_neighbours_differ_most(glsl):
    """A Bayer matrix: the 2×2 pixels of any aligned block hold one set out of each quarter of the range."""
    y, x = np.mgrid[0:8, 0:8]
    sets = glsl("lib/sampling.glsl", "result.x = float(interleavedSet(ivec2(x.xy)));", rows(x.ravel(), y.ravel()))
    quarters = (sets[:, 0].astype(int) // 4).reshape(4, 2, 4, 2).transpose(0, 2, 1, 3).reshape(-1, 4)
    assert (np.sort(quarters, axis=1) == [0, 1, 2, 3]).all()


@pytest.mark.parametrize("frame", ["frameAround(x.xyz)", "interleavedFrame(x.xyz, 5)"])
def test_frames_are_orthonormal_right_handed_and_hold_the_normal(glsl, frame):
    normal = directions(200)
    columns = [glsl("lib/sampling.glsl", f"result.xyz = ({frame})[{i}];", rows(normal))[:, :3] for i in range(3)]
    matrix = np.stack(columns, axis=-1)
    np.testing.assert_allclose(matrix.transpose(0, 2, 1) @ matrix, np.broadcast_to(np.eye(3), (200, 3, 3)), atol=2e-6)
    np.testing.assert_allclose(np.linalg.det(matrix), 1, atol=2e-6)
    np.testing.assert_allclose(matrix[..., 2], normal, atol=1e-6)


def test_the_16_sets_turn_the_kernel_by_16_angles(glsl):
    tangents = glsl(
        "lib/sampling.glsl", "result.xyz = interleavedFrame(vec3(0, 0, 1), int(x.x))[0];", rows(np.arange(16))
    )
    angle = np.degrees(np.arctan2(tangents[:, 1], tangents[:, 0])) % 360
    np.testing.assert_allclose(np.sort(angle), np.arange(16) * 22.5, atol=1e-3)


def test_offsets_stay_in_one_step_and_are_spread_evenly(glsl):
    offset = np.full(16, 0.37)
    moved = glsl("lib/sampling.glsl", "result.x = interleavedOffset(x.x, int(x.y));", rows(offset, np.arange(16)))[:, 0]
    np.testing.assert_allclose(np.sort(moved), np.sort((0.37 + np.arange(16) / 16) % 1), atol=1e-6)


# --- filter


@pytest.mark.parametrize("orthographic", [False, True])
def test_neighbours_are_measured_by_their_distance_off_the_tangent_plane(glsl, orthographic):
    normal, other = directions(60), RNG.normal(size=(60, 3)) - (0, 0, 8)
    ray = other[:, :2] if orthographic else other[:, :2] / -other[:, 2:]
    x = rows((normal[:, :2] * ray).sum(axis=1), normal[:, 2], other[:, 2])
    body = (
        "result.xy = alongNormals(vec2(x.x, 2.0 * x.x), vec2(x.y, 2.0 * x.y), x.z);"  # a normal, and twice the normal
    )
    along = glsl("lib/filter.glsl", body, x, orthographic=orthographic)
    np.testing.assert_allclose(along[:, 0], (normal * other).sum(axis=1), rtol=1e-4, atol=1e-5)
    np.testing.assert_allclose(along[:, 1], 2 * along[:, 0], rtol=1e-5)


def test_the_tolerance_is_a_share_of_the_distance_or_of_the_pictures_height(glsl):
    """The same at the distance from which a camera of 45 degrees shows the orthographic picture's height."""
    half = 3 * np.tan(np.radians(22.5))
    for orthographic in (False, True):
        tolerance = glsl(
            "lib/filter.glsl", "result.x = planeTolerance(x.x, x.y);", rows([-3.0], [half]), orthographic=orthographic
        )
        np.testing.assert_allclose(tolerance[0, 0], 0.002 * 3, rtol=1e-6)


# --- colour


def test_srgb_is_the_standard_curve(glsl):
    linear = np.concatenate([[0, 0.0031308, 0.0031309, 0.5, 1], RNG.random(100)])
    expected = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)  # IEC 61966-2-1
    srgb = glsl("lib/color.glsl", "result.rgb = srgbFromLinear(x.rgb);", rows(linear, linear, linear))
    np.testing.assert_allclose(srgb[:, :3], np.repeat(expected[:, None], 3, axis=1), atol=2e-6)


def test_the_filmic_curve_rises_from_black_to_white(glsl):
    radiance = np.array([0, *np.geomspace(0.001, 20, 400), 0.18])
    shown = glsl("lib/color.glsl", "result.rgb = filmic(x.rgb);", rows(radiance, radiance, radiance))[:, 0]
    assert shown[0] == 0
    assert shown[-2] == 1
    assert (np.diff(shown[:-1]) >= 0).all()
    # Narkowicz 2016, by hand at middle grey: 0.18 · 0.4818 / (0.18 · 1.0274 + 0.14)
    assert shown[-1] == pytest.approx(0.26695, abs=1e-4)


# --- lights


def test_the_cube_face_is_the_one_a_direction_passes(glsl):
    way = directions(300)
    faces = glsl("lib/light.glsl", "result.x = float(cubeFace(x.xyz));", rows(way))[:, 0].astype(int)
    axis = np.abs(way).argmax(axis=1)
    expected = 2 * axis + (way[np.arange(300), axis] < 0)
    np.testing.assert_array_equal(faces, expected)
