"""The G-buffer of scenes whose every pixel is known: depth, normal, albedo, the right side up."""

import numpy as np
import pytest
import small_scenes

import aolab
from aolab import Camera, Instance, Material, Mesh, Scene, Texture

FRONT = Camera((0, 0, 4), (0, 0, 0), fov=2 * np.degrees(np.arctan(0.5)))  # sees x, y in [-2, 2] at z = 0
RED, GREEN, BLUE = Material((1.0, 0.0, 0.0)), Material((0.0, 1.0, 0.0)), Material((0.0, 0.0, 1.0))


def square(half: float = 2.0, z: float = 0.0, material: Material = RED) -> Mesh:
    """A square in a plane of constant z that faces +z."""
    return small_scenes.quad((-half, -half, z), (2 * half, 0, 0), (0, 2 * half, 0), material)


def render(lab, *instances: Instance, camera: Camera = FRONT, size=(16, 16)) -> aolab.Frame:
    return lab.render(Scene(instances, environment=small_scenes.SKY, camera=camera), "none", size=size)


def srgb_to_linear(value: np.ndarray) -> np.ndarray:
    value = value / 255
    return np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)


def test_a_facing_square_has_one_depth_one_normal_one_albedo(lab):
    frame = render(lab, Instance(square()))
    assert frame.mask.all()
    np.testing.assert_allclose(frame["viewZ"], -4, rtol=1e-6)
    np.testing.assert_allclose(frame["viewNormal"], np.broadcast_to([0, 0, 1], (16, 16, 3)), atol=1e-6)
    np.testing.assert_array_equal(frame["albedo"], np.broadcast_to([1, 0, 0], (16, 16, 3)))


def test_depth_of_a_floor_is_where_the_ray_meets_it(lab, plane):
    frame = lab.render(plane, "none", size=(33, 17))
    y = small_scenes.world_positions(frame, plane.camera)[..., 1][frame.mask]
    pixel = 2 * 6.7 * np.tan(np.radians(plane.camera.fov / 2)) / 17  # its width at the plane's centre
    np.testing.assert_allclose(y, 0, atol=pixel / 128)  # vertices lie on a grid of 1/256 of a pixel
    assert (np.diff(frame["viewZ"][:, 16][frame.mask[:, 16]]) > 0).all()  # the top row is the farthest


def test_rows_run_from_the_top_and_columns_from_the_left(lab):
    upper_left = small_scenes.quad((-2, 0, 0), (2, 0, 0), (0, 2, 0), GREEN)
    frame = render(lab, Instance(upper_left))
    expected = np.zeros((16, 16), bool)
    expected[:8, :8] = True
    np.testing.assert_array_equal(frame.mask, expected)
    assert frame.image[0, 0].tolist() != frame.image[-1, -1].tolist()


def test_the_background_is_infinitely_far_and_has_no_visibility(lab):
    frame = render(lab, Instance(square(half=1)))
    outside = ~frame.mask
    assert outside.sum() == 16 * 16 - 8 * 8
    assert (frame["viewZ"][outside] == -np.inf).all()
    assert np.isnan(frame["visibility"][outside]).all()
    assert np.isnan(frame["visibility_raw"][outside]).all()
    assert (frame["visibility"][frame.mask] == 1).all()
    np.testing.assert_allclose(frame["radiance"][outside], 1)  # the sky


def test_the_nearest_surface_wins_whatever_the_order(lab):
    for order in (1, -1):
        layers = [Instance(square(z=0, material=RED)), Instance(square(half=0.5, z=1, material=BLUE))][::order]
        frame = render(lab, *layers)
        assert frame["albedo"][8, 8].tolist() == [0, 0, 1]
        assert frame["albedo"][0, 0].tolist() == [1, 0, 0]


@pytest.mark.parametrize(
    "scale", [(1, 1, 1), (2, 1, 1), (1, 1, 0.2), (-1, 1, 1), (1, -3, 0.5), (-1, -1, -1), (1e-3, 1, 1)]
)
def test_normals_of_scaled_and_mirrored_instances(lab, scale):
    """The plane x + z = 0, scaled: its normal is the inverse transpose's, towards the viewer."""
    half = small_scenes.quad((-1, -1, 1), (2, 0, -2), (0, 2, 0))
    matrix = np.diag([*map(float, scale), 1.0])
    frame = render(lab, Instance(half, matrix), camera=Camera((0, 0, 4), (0, 0, 0), fov=20 * abs(scale[0]) + 0.01))
    normal = np.array([1, 0, 1]) / np.array(scale)
    normal /= np.linalg.norm(normal) * (np.sign(normal[2]) or 1)
    assert frame.mask.any()
    np.testing.assert_allclose(
        frame["viewNormal"][frame.mask], np.broadcast_to(normal, (frame.mask.sum(), 3)), atol=2e-3
    )


def test_both_sides_of_a_triangle_face_the_viewer(lab):
    for eye in ((0, 0, 4), (0, 0, -4)):
        frame = render(lab, Instance(square()), camera=Camera(eye, (0, 0, 0)))
        np.testing.assert_allclose(frame["viewNormal"][8, 8], [0, 0, 1], atol=1e-6)


def test_a_floor_faces_the_viewer_up_to_its_horizon(lab):
    """Derivatives at a horizon reach over to points behind the eye; they must not turn the normal round."""
    for eye in ((0, 0.3, 50), (0, 0.05, 6)):
        camera = Camera(eye, (0, 0, 0))
        frame = lab.render(small_scenes.plane(camera), "none", size=(17, 9))
        up = camera.view_from_world[:3, 1]
        assert (frame["viewNormal"][frame.mask] @ up > 0.999).all()


def test_winding_does_not_turn_the_normals_of_a_mesh(lab):
    ball = small_scenes.sphere(1.5, (0, 0, 0))
    turned = Mesh(ball.vertices, ball.faces[:, ::-1], normals=ball.normals)
    inverted = Mesh(ball.vertices, ball.faces, normals=-ball.normals)  # type: ignore[operator]
    expected = render(lab, Instance(ball))["viewNormal"]
    np.testing.assert_array_equal(render(lab, Instance(turned))["viewNormal"], expected)
    np.testing.assert_array_equal(render(lab, Instance(inverted))["viewNormal"], expected)


def test_normals_of_a_sphere_point_away_from_its_centre(lab):
    frame = render(lab, Instance(small_scenes.sphere(1.5, (0, 0, 0))), size=(48, 48))
    positions = small_scenes.world_positions(frame, FRONT)[frame.mask]
    normals = frame["viewNormal"][frame.mask]  # the camera looks down -z: view axes are the world's
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-3)
    cosine = (normals * positions).sum(axis=1) / np.linalg.norm(positions, axis=1)
    assert cosine.min() > np.cos(np.radians(2.5))  # the triangles are 4° wide


# --- materials


def checker() -> Texture:
    """Red, green / blue, grey; sRGB. 8×8 texels each, for their borders are blended."""
    four = np.array([[(255, 0, 0, 255), (0, 255, 0, 255)], [(0, 0, 255, 255), (188, 188, 188, 255)]], np.uint8)
    return Texture(four.repeat(8, axis=0).repeat(8, axis=1), "checker")


def test_a_textures_first_row_is_at_v_1_and_its_colours_are_srgb(lab):
    frame = render(lab, Instance(square(material=Material((1.0, 1.0, 1.0), checker()))))
    albedo = frame["albedo"]
    assert albedo[2, 2].tolist() == [1, 0, 0]
    assert albedo[2, -3].tolist() == [0, 1, 0]
    assert albedo[-3, 2].tolist() == [0, 0, 1]
    np.testing.assert_allclose(albedo[-3, -3], srgb_to_linear(np.array([188] * 3)), atol=2e-3)


def test_base_colour_texture_and_vertex_colour_multiply(lab):
    half = square()
    texture = Texture(np.full((1, 1, 4), (188, 188, 188, 255), np.uint8))
    colors = np.tile(np.array([(0.5, 1.0, 0.25, 1.0)], np.float32), (4, 1))
    mesh = Mesh(half.vertices, half.faces, uv=half.uv, colors=colors, material=Material((0.8, 0.5, 1.0), texture))
    expected = srgb_to_linear(np.array([188.0])) * (0.8 * 0.5, 0.5 * 1.0, 1.0 * 0.25)
    np.testing.assert_allclose(render(lab, Instance(mesh))["albedo"][8, 8], expected, rtol=3e-3)


def test_vertex_colours_are_interpolated_in_linear_light(lab):
    half = square()
    colors = np.array([(0, 0, 0, 1), (1, 1, 1, 1), (1, 1, 1, 1), (0, 0, 0, 1)], np.float32)
    mesh = Mesh(half.vertices, half.faces, colors=colors, material=Material((1.0, 1.0, 1.0)))
    ramp = render(lab, Instance(mesh))["albedo"][8, :, 0]
    np.testing.assert_allclose(ramp, (np.arange(16) + 0.5) / 16, atol=1e-3)


def test_fragments_below_the_alpha_cutoff_are_holes(lab):
    alpha = np.zeros((1, 2, 4), np.uint8)
    alpha[0, :, 3] = 40, 200
    cut = Material((1.0, 1.0, 1.0), Texture(alpha), alpha_cutoff=0.5)
    whole = Material((1.0, 1.0, 1.0), Texture(alpha))
    left, right = np.s_[:, :3], np.s_[:, -3:]
    frame = render(lab, Instance(square(material=cut)))
    assert not frame.mask[left].any()
    assert frame.mask[right].all()
    assert render(lab, Instance(square(material=whole))).mask.all()
    faint = Material((1.0, 1.0, 1.0), Texture(alpha), alpha=0.5, alpha_cutoff=0.5)  # 0.5 · 200/255 < 0.5
    two = render(lab, Instance(square(1, 1)), Instance(square(material=faint)))
    np.testing.assert_array_equal(two.mask, render(lab, Instance(square(1, 1))).mask)


def test_instances_of_one_mesh_are_drawn_in_their_places(lab):
    small = square(half=0.5)
    places = [(-1.5, 1.5), (1.5, 1.5), (0.5, -0.5)]
    matrices = [np.eye(4) for _ in places]
    for matrix, (x, y) in zip(matrices, places, strict=True):
        matrix[:2, 3] = x, y
    frame = render(lab, *(Instance(small, matrix) for matrix in matrices))
    expected = np.zeros((16, 16), bool)
    expected[:4, :4] = expected[:4, 12:] = expected[8:12, 8:12] = True
    np.testing.assert_array_equal(frame.mask, expected)
    moved = render(lab, Instance(small, matrices[2]))  # the same mesh, placed anew: nothing of the old places is left
    assert moved.mask.sum() == 16


def test_a_texture_beyond_the_drivers_limit_is_scaled_down_and_said(lab, gl):
    limit = gl.info["GL_MAX_TEXTURE_SIZE"]
    pixels = np.zeros((1, limit + 8, 4), np.uint8)
    pixels[..., 1] = pixels[..., 3] = 255
    mesh = square(material=Material((1.0, 1.0, 1.0), Texture(pixels, "panorama")))
    with pytest.warns(aolab.Notice, match=rf"texture 'panorama' of {limit + 8}x1 .* driver's {limit}.* {limit}x1"):
        frame = render(lab, Instance(mesh))
    assert frame["albedo"][8, 8].tolist() == [0, 1, 0]
    assert "panorama" in frame.notes[0]


def test_scenes_tiny_and_enormous_look_the_same(lab):
    reference = render(lab, Instance(square(half=1)))
    for scale in (1e-6, 1e6):
        camera = Camera((0, 0, 4 * scale), (0, 0, 0), fov=FRONT.fov)
        frame = render(lab, Instance(square(half=scale)), camera=camera)
        np.testing.assert_array_equal(frame.mask, reference.mask)
        np.testing.assert_allclose(frame["viewZ"][frame.mask], -4 * scale, rtol=1e-6)
        np.testing.assert_allclose(frame["viewNormal"], reference["viewNormal"], atol=1 - small_scenes.OPEN)
