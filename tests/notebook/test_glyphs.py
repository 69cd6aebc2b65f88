"""`aolab.glyph`: coefficients, light and irradiance of a pixel, and the pictures of them."""

import pkgutil
from dataclasses import replace as with_changes
from io import BytesIO

import numpy as np
import pytest
import small_scenes
from PIL import Image

import aolab
from aolab import Camera, DirectionalLight, Environment, ParameterError, PointLight, SpotLight
from aolab.maths.harmonics import basis, clamped_cosine

HALF = 2e-3  # coefficients and normals are half floats
DARK = Environment.constant(0.0)
UP = np.array((0.0, 1.0, 0.0))
ANYWHERE = (32, 40)
BESIDE_THE_RED_BOX = (22, 33)  # on the floor in front of the left box of `small_scenes.boxes`
LAMPS = (
    DirectionalLight((0.5, -1, -0.6), (1.0, 0.8, 0.5), shadow=False),
    PointLight((1.5, 2, 2), (3.0, 4.0, 6.0), shadow=False),
    SpotLight((-2, 3, 2), (2, -3, -2), (20.0, 5.0, 9.0), inner=10, outer=30, shadow=False),
)


def mean_direction(glyph):
    """(3,) world space: ∫ w f(w) dω, by the first band."""
    y, z, x = glyph.coefficients[1:4] / (-1, 1, -1)
    return np.array((x, y, z))


def picked(lab, scene, pixel=ANYWHERE, **parameters):
    return aolab.glyph(lab.render(scene, "s3ho", **parameters), pixel)


def columns_of_red(picture):
    red = picture[..., 0].astype(int) - picture[..., 1] > 60
    return np.flatnonzero(red.any(axis=0))


def test_an_open_surface_is_the_clamped_cosine(lab, plane):
    glyph = picked(lab, plane.replace(environment=Environment.constant((1.0, 2.0, 0.5))))
    assert glyph.coefficients == pytest.approx(clamped_cosine(UP), abs=HALF)
    assert glyph.visibility == pytest.approx(1, abs=HALF)
    assert glyph.irradiance == pytest.approx(np.pi * np.array((1, 2, 0.5)), rel=HALF)  # E = π L
    assert glyph.bounce is None
    assert glyph.normal == pytest.approx(UP, abs=HALF)


def test_the_position_is_the_surface_point_of_the_pixel(lab, plane):
    frame = lab.render(plane, "s3ho")
    for column, row in [(0, 47), (40, 30), (63, 25)]:
        expected = small_scenes.world_positions(frame, plane.camera)[row, column]
        assert aolab.glyph(frame, (column, row)).position == pytest.approx(expected, abs=1e-4)


def test_rays_give_the_same_glyph(plane):
    frame = aolab.reference(plane, size=(16, 12), rays=256, radius=1, cache=False, buffers=("sh0", "sh1", "sh2", "sh3"))
    glyph = aolab.glyph(frame, (8, 10))
    assert glyph.coefficients == pytest.approx(clamped_cosine(UP), abs=0.02)
    assert glyph.irradiance == pytest.approx([np.pi] * 3, rel=0.01)


@pytest.mark.parametrize(("side", "leans"), [(1, 1), (-1, -1)])
def test_the_lobe_leans_away_from_a_wall(lab, side, leans):
    # the wall x = 0, seen along it: from the front it is on the left, and from behind on the right
    scene = small_scenes.wall(camera=Camera(eye=(1, 1.5, 5 * side), target=(1, 0, 0)))
    glyph = picked(lab, scene, (32, 24), radius=4.0, directions=32)
    assert mean_direction(glyph)[0] > 0.1
    columns = columns_of_red(glyph.occlusion_picture())
    assert leans * (columns.mean() - 119.5) > 10


TWO_ABOVE = (0, 2, 0)  # relative to the pixel's surface point


@pytest.mark.parametrize(
    ("light", "expected"),
    [
        (DirectionalLight((0, -2, 0), (1.0, 2.0, 3.0)), (1, 2, 3)),
        (PointLight(TWO_ABOVE, (4.0, 8.0, 0.0)), (1, 2, 0)),
        (SpotLight(TWO_ABOVE, (0, -1, 0), (4.0, 8.0, 0.0)), (1, 2, 0)),
        (SpotLight(TWO_ABOVE, (0, 1, 0), (4.0, 8.0, 0.0)), (0, 0, 0)),
    ],
)
@pytest.mark.parametrize("light_window", [2.0, 64.0])
def test_an_open_surface_facing_a_light_receives_its_irradiance(lab, plane, light, expected, light_window):
    if not isinstance(light, DirectionalLight):
        light = with_changes(light, position=tuple(picked(lab, plane).position + 2 * UP))
    glyph = picked(lab, plane.replace(lights=(light,), environment=DARK), light_window=light_window)
    assert glyph.irradiance == pytest.approx(expected, rel=HALF, abs=1e-6)


def test_the_light_window_is_the_parameter_of_the_frame(lab, plane):
    scene = plane.replace(lights=LAMPS[:1], environment=DARK)
    broad, sharp = (picked(lab, scene, light_window=window) for window in (1.5, 64.0))
    assert sharp.brightest > 1.5 * broad.brightest


@pytest.mark.parametrize("indirect", [False, True])
@pytest.mark.parametrize("pixel", [(20, 28), (29, 30), (44, 33), (10, 40), (15, 22)])
def test_its_irradiance_gives_the_radiance_of_the_frame(lab, indirect, pixel):
    scene = small_scenes.boxes(lights=LAMPS).replace(environment=Environment.sky())
    frame = lab.render(scene, "s3ho", radius=1.0, directions=16, indirect=indirect)
    glyph = aolab.glyph(frame, pixel)
    column, row = pixel
    shown = sum(frame[name][row, column] for name in ("direct", "ambient", "indirect") if name in frame.buffers)
    assert glyph.irradiance * frame["albedo"][row, column] / np.pi == pytest.approx(shown, rel=0.005)


def test_its_bounce_gives_the_indirect_radiance_of_the_frame(lab):
    scene = small_scenes.boxes(lights=LAMPS).replace(environment=Environment.sky())
    frame = lab.render(scene, "s3ho", radius=1.0, directions=32, indirect=True)
    glyph = aolab.glyph(frame, BESIDE_THE_RED_BOX)
    column, row = BESIDE_THE_RED_BOX
    indirect = frame["indirect"][row, column]
    assert indirect[0] > indirect[1] > 0
    assert glyph.bounced * frame["albedo"][row, column] / np.pi == pytest.approx(indirect, rel=0.005)


def test_a_relit_frame_shows_the_new_light(lab, plane):
    frame = lab.render(plane, "s3ho")
    before = aolab.glyph(frame, ANYWHERE)
    after = aolab.glyph(
        lab.relight(frame, environment=DARK, lights=(DirectionalLight((0, -1, 0), (0.0, 5.0, 0.0)),)), ANYWHERE
    )
    assert (after.coefficients == before.coefficients).all()
    assert after.irradiance == pytest.approx((0, 5, 0), rel=HALF)


@pytest.mark.parametrize(("eye", "right"), [((0, 3, 6), (1, 0, 0)), ((6, 3, 0), (0, 0, -1))])
def test_light_from_the_cameras_right_is_on_the_right(lab, plane, eye, right):
    towards = np.asarray(right) + 0.3 * UP
    light = DirectionalLight(tuple(-towards), (1.0, 0.5, 0.5))
    scene = plane.replace(camera=Camera(eye, (0, 0, 0)), lights=(light,), environment=Environment.constant(0.1))
    picture = picked(lab, scene).light_picture((100, 100)).astype(float)
    left, right = picture[30:70, 20:40], picture[30:70, 60:80]
    assert right.mean() > left.mean() + 40
    above, below = picture[15:30, 60:75], picture[70:85, 60:75]
    assert above.mean() > below.mean() + 10


def test_the_light_picture_shows_the_environments_colour(lab, plane):
    glyph = picked(lab, plane.replace(environment=Environment.constant((4.0, 2.0, 0.0))))
    assert glyph.brightest == pytest.approx(4)
    linear_half = 188  # sRGB of 0.5
    assert glyph.light_picture((60, 60))[30, 30] == pytest.approx((255, linear_half, 0), abs=1)


def test_the_lobe_has_values_and_a_mesh(lab, plane):
    lobe = picked(lab, plane).lobe
    assert lobe.values == pytest.approx(basis(lobe.directions, 4) @ clamped_cosine(UP), abs=2 * HALF)
    assert lobe.values.max() == pytest.approx(
        17 / 16, abs=2 * HALF
    )  # the maximum with four bands; the cosine's own maximum is 1
    lengths = np.linalg.norm(lobe.mesh.vertices, axis=1)
    assert lengths == pytest.approx(np.maximum(np.abs(lobe.values), 1e-3), abs=1e-6)
    red, _, blue, _ = lobe.mesh.colors.T
    assert ((red > blue) == (lobe.values > 0)).all()
    assert (lobe.values < 0).any()


def test_a_bounce_colours_the_lobe(lab):
    frame = lab.render(small_scenes.boxes(), "s3ho", radius=1.0, directions=32, indirect=True)
    glyph = aolab.glyph(frame, BESIDE_THE_RED_BOX)
    red, green, _ = glyph.lobe.values.T
    assert red.max() > green.max() + 0.01
    assert (glyph.lobe.mesh.colors[:, 0] - glyph.lobe.mesh.colors[:, 1]).max() > 0.3
    assert np.linalg.norm(glyph.lobe.mesh.vertices, axis=1) == pytest.approx(
        np.abs(glyph.lobe.values).max(axis=1), abs=1e-3
    )
    assert glyph.occlusion_picture().shape == (240, 240, 3)


def test_open_surfaces_have_lobes_of_the_same_size(lab, plane):
    frame = lab.render(plane, "s3ho", radius=1.0)
    bright = lab.relight(frame, environment=Environment.constant(7.0))
    one, other = (aolab.glyph(f, p).occlusion_picture() for f, p in [(frame, (10, 30)), (bright, (50, 46))])
    assert np.abs(one.astype(int) - other).max() <= 2


def test_pictures_have_the_requested_size(lab, plane):
    glyph = picked(lab, plane)
    assert glyph.occlusion_picture((90, 60)).shape == glyph.light_picture((90, 60)).shape == (60, 90, 3)
    assert glyph.occlusion_picture((60, 90)).dtype == np.uint8
    sheet = glyph.picture((90, 60))
    assert sheet.width > 180
    assert sheet.height > 60
    assert Image.open(BytesIO(glyph._repr_png_())).size == glyph.picture().size


@pytest.mark.parametrize("pixel", [(64, 0), (0, 48), (-1, 3), (1.5, 2), (1, 2, 3), 7, "ab"])
def test_a_pixel_outside_is_refused_with_the_size(lab, plane, pixel):
    with pytest.raises(ParameterError, match=r"of this image, 64x48: columns are 0 to 63, rows 0 to 47"):
        picked(lab, plane, pixel)


def test_numpy_integers_are_accepted_as_pixels(lab, plane):
    assert picked(lab, plane, np.array(ANYWHERE)).pixel == ANYWHERE


def test_the_background_has_no_glyph(lab, ball):
    with pytest.raises(ParameterError, match=r"pixel \(2, 1\) is in the background"):
        picked(lab, ball.replace(camera=Camera((0, 1, 9), (0, 3, 0))), (2, 1))


def test_a_frame_without_harmonics_names_the_modules(lab, plane):
    with pytest.raises(ParameterError, match=r"of ssao, has no sh0.*modules s3ho.*aolab.reference"):
        aolab.glyph(lab.render(plane, "ssao"), ANYWHERE)


def test_a_frame_without_a_scene_is_refused(lab, plane):
    frame = lab.render(plane, "s3ho")
    frame.scene = None
    with pytest.raises(ParameterError, match="has no scene"):
        aolab.glyph(frame, ANYWHERE)


def test_no_file_of_the_package_hides_a_public_name():
    assert not {module.name for module in pkgutil.iter_modules(aolab.__path__)} & set(aolab.__all__) - {"modules"}  # pyright: ignore
