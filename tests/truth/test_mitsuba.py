"""The second opinion: Mitsuba's path tracer and our two ways to the same light, within stated errors."""

import subprocess
import sys

import numpy as np
import pytest
import small_scenes

import aolab
from aolab.errors import Error, ParameterError, SceneError
from aolab.scene.view import View
from aolab.truth import reference
from aolab.truth.mitsuba import path_traced, run_worker
from aolab.truth.picture import over_environment

from .rooms import quad, scene, wall_scene

SIZE = (64, 48)
FINE = 8  # our pixels are points: this many, squared, average to the area of one of Mitsuba's


@pytest.fixture(scope="module")
def mitsuba() -> None:
    """Skips a test where Mitsuba cannot be imported; tried in another process, where half an import does no harm."""
    if subprocess.run([sys.executable, "-c", "import mitsuba"], capture_output=True).returncode:
        pytest.skip("needs Mitsuba: pip install mitsuba, and libatomic")


needs_mitsuba = pytest.mark.usefixtures("mitsuba")


def fine(buffer):
    """(H, W, channels): the mean over each of Mitsuba's pixels of a buffer that is `FINE` times as large."""
    height, width = buffer.shape[0] // FINE, buffer.shape[1] // FINE
    return np.nan_to_num(buffer.astype(np.float64)).reshape(height, FINE, width, FINE, -1).mean(axis=(1, 3))


FINE_SIZE = (SIZE[0] * FINE, SIZE[1] * FINE)


def bias_and_error(a, b):
    """Signed mean and root mean square of a - b, as shares of the mean of b."""
    return (a - b).mean() / b.mean(), np.sqrt(((a - b) ** 2).mean()) / b.mean()


def cornell(camera=None):
    """The Cornell box with its bulb a metre lower: under the lid, a few bright pixels would be all of the noise.

    The camera is rolled, for edges along rows of pixels would meet all of our sample points at once, or none.
    """
    box = aolab.load("cornell")
    bulb = aolab.PointLight((0, 4.4, -2.8), (18.0, 14.0, 9.0))
    rolled = aolab.Camera(box.camera.eye, box.camera.target, up=(0.17, 1, 0), fov=box.camera.fov)
    return box.replace(lights=(bulb,), camera=camera or rolled)


@needs_mitsuba
def test_direct_light_in_the_cornell_box_by_three_engines():
    """Measured: bias 0.01 % and 0.1 %, root mean square 0.9 % and 1.3 %: edges, and the shadow map's soft ones."""
    second = path_traced(cornell(), size=SIZE, samples=256, buffers="direct")["direct"]
    first = fine(reference(cornell(), size=FINE_SIZE, rays=2, buffers="direct")["direct"])
    drawn = fine(aolab.render(cornell(), "none", size=FINE_SIZE)["direct"])
    for ours in (first, drawn):
        bias, error = bias_and_error(ours, second)
        assert abs(bias) < 3e-3
        assert error < 0.02


@needs_mitsuba
def test_environment_and_bounce_in_the_cornell_box_by_two_engines():
    """Measured: bias 0.03 % and 0.03 %, root mean square 3.8 % and 10 %, which is the sum of both engines' noise."""
    names = ("ambient", "indirect")
    second = path_traced(cornell(), size=SIZE, samples=256, buffers=names)
    first = reference(cornell(), size=FINE_SIZE, rays=32, buffers=names)
    for name, bias_limit, error_limit in (("ambient", 3e-3, 0.05), ("indirect", 1e-2, 0.14)):
        bias, error = bias_and_error(fine(first[name]), second[name])
        assert abs(bias) < bias_limit
        assert error < error_limit


@needs_mitsuba
def test_unoccluded_ambient_light_is_right_where_nothing_blocks():
    """From outside the Cornell box is convex, but for ledges of 2 cm. Measured: bias 0.24 %, root mean square 3.5 %."""
    behind = aolab.Camera(eye=(-9, -6, -16), target=(0, 2.7, -2.8), up=(0.17, 1, 0), fov=32)
    second = path_traced(cornell(behind), size=SIZE, samples=256, buffers="ambient")["ambient"]
    drawn = fine(aolab.render(cornell(behind), "none", size=FINE_SIZE)["ambient"])
    bias, error = bias_and_error(drawn, second)
    assert abs(bias) < 1e-2
    assert error < 0.05


@needs_mitsuba
def test_radiance_is_the_sum_of_its_parts_and_max_depth_adds_bounces():
    parts = path_traced(cornell(), size=SIZE, samples=16, buffers=("direct", "ambient", "indirect"))
    frames = {depth: path_traced(cornell(), size=SIZE, samples=16, max_depth=depth) for depth in (2, 3, -1)}
    inside = (slice(8, 40), slice(16, 48))  # no background
    two, three, all_of_them = (frames[depth]["radiance"][inside].mean() for depth in (2, 3, -1))
    direct, ambient, indirect = (parts[name][inside].mean() for name in ("direct", "ambient", "indirect"))
    assert two == pytest.approx(direct + ambient, rel=5e-3)
    assert three == pytest.approx(direct + ambient + indirect, rel=1e-2)
    assert two < three < all_of_them < 2 * two
    assert frames[3].image.shape == (48, 64, 3)
    assert frames[3].image.mean() > frames[2].image.mean() + 5


@pytest.mark.filterwarnings("ignore:nothing is drawn:aolab.Notice")
@needs_mitsuba
@pytest.mark.parametrize(
    ("shape", "target"),
    [
        ((1, 2), (0.2, 0.5, -1)),
        ((4, 8), (1, -0.3, 0.4)),
        ((5, 7), (1, -0.3, 0.4)),
        ((4, 8), (-0.7, 1, 0.6)),
        ((5, 7), (0.1, -1, 0.1)),
    ],
)
def test_the_environment_is_where_we_look_it_up(shape, target):
    """A map of random texels, seen in directions that hold its seam and both poles."""
    environment = aolab.Environment(np.random.default_rng(3).random((*shape, 3)))
    camera = aolab.Camera(eye=(0, 0, 0), target=target, fov=80)
    behind = tuple(-20 * np.asarray(target))
    lit = scene(quad(behind, (0.1, 0, 0), (0, 0.1, 0.1)), environment=environment, camera=camera)
    seen = path_traced(lit, size=SIZE, samples=64)
    black, view = np.zeros((FINE_SIZE[1], FINE_SIZE[0], 3)), View(camera, FINE_SIZE, lit.bounds)
    expected = fine(over_environment(black, black[..., 0] > 0, environment, view))
    np.testing.assert_allclose(seen["radiance"], expected, atol=0.02)
    assert np.abs(seen["radiance"] - expected).mean() < 2e-3


@needs_mitsuba
@pytest.mark.filterwarnings("ignore:the camera's near plane:aolab.Notice")
def test_a_surface_before_the_near_plane_is_not_seen():
    near, far = quad((0, 0, 1), (1, 0, 0), (0, 1, 0), 0.8), quad((0, 0, 0), (1, 0, 0), (0, 1, 0), 0.5)
    sun = aolab.DirectionalLight((3, 0, -1), (1.0, 1.0, 1.0))  # from the side, past the nearer one
    camera = aolab.Camera((0, 0, 3), (0, 0, 0), near=2.5)
    seen = path_traced(scene(near, far, lights=(sun,), camera=camera), size=SIZE, samples=16)
    assert seen["radiance"][24, 32] == pytest.approx([0.5 / np.pi / np.sqrt(10)] * 3, rel=1e-3)


LIGHTS = [
    aolab.DirectionalLight((0.4, -1, 0.2), (2.0, 1.0, 0.5)),
    aolab.PointLight((1.0, 1.5, 0.3), (2.0, 1.0, 0.5)),
    aolab.SpotLight((1.5, 2.0, 0.3), (-0.2, -1, 0), (4.0, 2.0, 1.0), inner=5, outer=25),
    aolab.SpotLight((1.5, 0.3, 0.1), (0, -2, 0.1), (0.4, 0.2, 0.1), inner=0, outer=85),
]


@needs_mitsuba
@pytest.mark.parametrize("light", LIGHTS, ids=lambda light: type(light).__name__)
def test_lights_have_our_units_and_our_cones(light):
    lit = wall_scene(lights=(light,), half_width=3)
    second = path_traced(lit, size=SIZE, samples=64, buffers="direct")["direct"]
    first = fine(reference(lit, size=FINE_SIZE, rays=2, buffers="direct")["direct"])
    assert abs(bias_and_error(first, second)[0]) < 2e-3
    assert np.median(np.abs(first - second)) < 2e-3 * second.max()


@needs_mitsuba
@pytest.mark.parametrize("unit", [1e-4, 1e4])
def test_the_unit_of_length_does_not_matter(unit):
    """A bracket with a gap of a hundredth under it, and a mirrored, stretched instance; 5 km away from the origin."""

    def room(unit):
        away = np.array((5e3, 0, 0)) * unit
        floor, lid = quad((0, 0, 0), (0, 0, 2), (2, 0, 0)), quad((0, 0.01, 0), (0, 0, 0.5), (0.5, 0, 0), name="lid")
        ball = aolab.load("boxes").instances[1].mesh
        places = [np.diag((unit, unit, unit, 1.0)), np.diag((-0.5 * unit, 0.3 * unit, unit, 1.0))]
        for matrix in places:
            matrix[:3, 3] += away
        bulb = aolab.PointLight(tuple(away + np.array((0.7, 1.5, 0.4)) * unit), (3 * unit**2,) * 3)
        camera = aolab.Camera(tuple(away + np.array((2, 3, 3)) * unit), tuple(away), fov=40)
        instances = [aolab.Instance(floor, places[0]), aolab.Instance(lid, places[0]), aolab.Instance(ball, places[1])]
        return aolab.Scene(tuple(instances), (bulb,), aolab.Environment.constant(0.0), camera)

    one, other = (path_traced(room(each), size=SIZE, samples=16, buffers="direct") for each in (1.0, unit))
    ours = fine(reference(room(1.0), size=FINE_SIZE, rays=2, buffers="direct")["direct"])
    assert bias_and_error(other["direct"], one["direct"])[1] < 0.02
    assert abs(bias_and_error(ours, one["direct"])[0]) < 5e-3


@needs_mitsuba
def test_materials_reflect_as_they_are_drawn():
    """Under a sky of 1 unblocked surfaces have their albedo's radiance: base colour, texture, vertex colours, both."""
    random = np.random.default_rng(1)
    texture = aolab.Texture(random.integers(0, 256, (4, 8, 4), np.uint8))
    textured = aolab.Material(base_color=(0.9, 0.8, 0.7), texture=texture)
    left = quad((-1.4, 0, 0), (0.6, 0, 0), (0, 0.8, 0), material=textured)
    plain = quad((0, 0, 0), (0.6, 0, 0), (0, 0.8, 0), material=aolab.Material(base_color=(0.2, 0.5, 0.9)))
    middle = aolab.Mesh(plain.vertices, plain.faces, colors=random.random((4, 4)), material=plain.material)
    tinted = quad((1.4, 0, 0), (0.6, 0, 0), (0, 0.8, 0), material=textured)
    right = aolab.Mesh(
        tinted.vertices, tinted.faces, uv=tinted.uv * 1.7, colors=[(1, 0.5, 1, 1)] * 4, material=textured
    )
    camera = aolab.Camera(eye=(0.1, 0.2, -4), target=(0, 0, 0), up=(0.17, 1, 0), fov=42)  # from behind
    both = scene(left, middle, right, camera=camera, environment=aolab.Environment.constant(1.0))
    second = path_traced(both, size=SIZE, samples=64, buffers="ambient")["ambient"]
    drawn = fine(aolab.render(both, "none", size=FINE_SIZE)["albedo"])
    assert abs(bias_and_error(drawn, second)[0]) < 2e-3
    assert bias_and_error(drawn, second)[1] < 0.03


@needs_mitsuba
@pytest.mark.parametrize("mirror", [1, -1])
def test_normals_shade_as_they_are_drawn(mirror):
    """A ball with its own normals, and a sheet whose normals fan out as its shape does not, sheared and mirrored."""
    ball = small_scenes.sphere(1.0, (0, 0, 0), subdivisions=2)
    sheet = quad((0, 0, 0), (1, 0, 0), (0, 1, 0))
    fan = aolab.Mesh(sheet.vertices, sheet.faces, normals=[(-0.5, 0, 1), (0.5, -0.4, 1), (0.5, 0.4, 1), (-0.5, 0, 1)])
    shear = np.array([(0.7 * mirror, 0.5, 0, 1.4), (0, 1, 0, 0), (0.6, 0, 1.8, 0), (0, 0, 0, 1)])
    sun = aolab.DirectionalLight((0.4, -0.3, -1))
    camera = aolab.Camera((0.6, 0, 7), (0.6, 0, 0), up=(0.17, 1, 0), fov=30)
    lit = aolab.Scene((aolab.Instance(ball), aolab.Instance(fan, shear)), (sun,), camera=camera)
    second = path_traced(lit, size=SIZE, samples=64, buffers="direct")["direct"]
    drawn = fine(aolab.render(lit, "none", size=FINE_SIZE)["direct"])
    bias, error = bias_and_error(drawn, second)
    assert abs(bias) < 5e-3
    assert error < 0.03


@needs_mitsuba
def test_light_passes_through_the_holes_of_a_cut_out_texture():
    """A floor under a sheet with one half cut out, and a wall: sunlight through the holes, and its bounce."""
    pixels = np.full((1, 2, 4), 255, np.uint8)
    pixels[0, 0, 3] = 0
    sheet = aolab.Material(texture=aolab.Texture(np.repeat(pixels, 64, axis=1)), alpha_cutoff=0.5)
    floor = quad((0, 0, 0), (0, 0, 4), (4, 0, 0))
    over = quad((0, 1, 0), (3, 0, 0), (0, 0, 3), material=sheet)
    wall = quad((0, 2, -4), (0, 2, 0), (4, 0, 0))
    sun = aolab.DirectionalLight((0.5, -1, 0.2), (3.0,) * 3)
    camera = aolab.Camera(eye=(-4, 6, 3), target=(-1, 0, 0), up=(0.2, 1, 0), fov=50)
    lit = scene(floor, over, wall, lights=(sun,), camera=camera)
    names = ("direct", "indirect")
    second = path_traced(lit, size=SIZE, samples=256, buffers=names)
    first = reference(lit, size=FINE_SIZE, rays=8, buffers=names)
    for name, limit in (("direct", 2e-3), ("indirect", 1.5e-2)):
        assert abs(bias_and_error(fine(first[name]), second[name])[0]) < limit


@needs_mitsuba
def test_a_blended_surface_stops_a_share_of_the_light():
    floor = quad((0, 0, 0), (0, 0, 4), (4, 0, 0))
    pane = quad((0, 1, 0), (4, 0, 0), (0, 0, 4), material=aolab.Material((0, 0, 0), alpha=0.3, blend=True))
    sun = aolab.DirectionalLight((0, -1, 0), (3.0,) * 3)
    lit = scene(floor, pane, lights=(sun,), camera=aolab.Camera(eye=(0.3, 0.5, 0.6), target=(0.1, 0, 0)))
    direct = path_traced(lit, size=(32, 24), samples=64, buffers="direct")["direct"]
    alone = path_traced(scene(floor, lights=(sun,), camera=lit.camera), size=(32, 24), samples=4, buffers="direct")
    assert direct.mean() / alone["direct"].mean() == pytest.approx(0.7, abs=0.01)


@needs_mitsuba
@pytest.mark.parametrize("kind", ["both sides", "a solid", "a texture"])
def test_emission_is_seen_and_lights_others(kind):
    """A lamp between a floor and a wall. Measured: bias 0.08 % of radiance, 0.3 % of indirect light."""
    floor, wall = quad((0, 0, 0), (0, 0, 6), (6, 0, 0)), quad((0, 2, -2), (0, 4, 0), (6, 0, 0))
    pixels = np.full((8, 8, 4), 255, np.uint8)
    pixels[:4, :, :2] = 60
    glow = aolab.Texture(pixels) if kind == "a texture" else None
    paint = aolab.Material((0.3, 0.3, 0.3), emission=(3, 2, 1), emission_texture=glow)
    lamp = quad((0, 1, 0), (1.5, 0, 0), (0, 0.3, 1), material=paint)
    if kind == "a solid":
        lamp = small_scenes.box((-0.6, 0.7, -0.5), (0.6, 1.2, 0.4), paint)
    camera = aolab.Camera(eye=(1, 4, 4.5), target=(0, 0.7, -0.5), up=(0.17, 1, 0), fov=45)
    lit = scene(floor, wall, lamp, camera=camera)
    names = ("radiance", "indirect")
    second = path_traced(lit, size=SIZE, samples=64, max_depth=3, buffers=names)
    first = reference(lit, size=(SIZE[0] * 4, SIZE[1] * 4), rays=64, buffers=names)
    for name in names:
        ours = first[name].reshape(SIZE[1], 4, SIZE[0], 4, 3).mean(axis=(1, 3))
        bias = bias_and_error(np.nan_to_num(ours), second[name])[0]
        assert abs(bias) < 0.01
        assert second[name].max() > 0.1


@needs_mitsuba
def test_without_light_all_is_black_and_nothing_runs():
    frame = path_traced(wall_scene(), size=SIZE, timeout=1e-9)
    assert (frame["radiance"] == 0).all()
    assert (frame.image == 0).all()


@needs_mitsuba
def test_the_seed_decides():
    lit = wall_scene(environment=aolab.Environment.sky())
    one, same, other = (
        path_traced(lit, size=SIZE, samples=4, seed=seed, cache=False, buffers="ambient")["ambient"]
        for seed in (1, 1, 2)
    )
    np.testing.assert_array_equal(one, same)
    assert (one != other).mean() > 0.5


@needs_mitsuba
def test_results_are_kept():
    lit = wall_scene(lights=LIGHTS[:1])
    frame = path_traced(lit, size=SIZE, samples=4)
    again = path_traced(lit, size=SIZE, samples=4, timeout=1e-9)
    assert frame.buffers == again.buffers == sorted(["viewZ", "viewNormal", "albedo", "radiance", "image"])
    np.testing.assert_array_equal(frame["radiance"], again["radiance"])
    assert frame["radiance"].dtype == np.float32
    assert again.info["parameters"] == {"engine": "mitsuba", "max_depth": 2, "samples": 4}


@needs_mitsuba
def test_mitsuba_is_ended_when_its_time_is_up():
    with pytest.raises(Error, match=r"Mitsuba did not finish within 0\.01 s"):
        path_traced(wall_scene(lights=LIGHTS[:1]), size=SIZE, timeout=0.01)


@needs_mitsuba
def test_a_failing_mitsuba_has_the_last_word(tmp_path):
    with pytest.raises(Error, match=r"(?s)Mitsuba failed \(exit status 1\).*No such file.*scene\.json"):
        run_worker(tmp_path, timeout=60)


def test_a_missing_mitsuba_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "mitsuba", None)  # as an import finds it that is not there
    with pytest.raises(ParameterError, match=r"needs Mitsuba 3: .*pip install mitsuba"):
        path_traced(wall_scene(), size=SIZE)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"buffers": "visibility"}, r"has no buffer 'visibility'"),
        ({"max_depth": 1}, r"max_depth = 1 is none of: 2 \(direct light\)"),
        ({"samples": 0}, r"samples = 0 is not a whole number"),
        ({"seed": -1}, r"seed = -1 is not a whole number"),
        ({"timeout": 0}, r"timeout = 0 is not"),
    ],
)
def test_wrong_arguments_are_named(arguments, message):
    with pytest.raises(ParameterError, match=message):
        path_traced(wall_scene(), **arguments)


@needs_mitsuba
def test_a_scene_that_mitsuba_cannot_render_is_refused():
    sun = aolab.DirectionalLight((0, -1, 0), shadow=False)
    with pytest.raises(SceneError, match=r"DirectionalLight without shadow: engine = 'mitsuba' has no such light"):
        path_traced(wall_scene(lights=(sun,)), size=SIZE)
    one = quad(
        (0, 0, 0), (1, 0, 0), (0, 1, 0), material=aolab.Material(texture=aolab.Texture(np.zeros((1, 1, 4), np.uint8)))
    )
    two = aolab.Mesh(one.vertices, one.faces, uv=one.uv, colors=np.eye(4), material=one.material, name="rag")
    with pytest.raises(SceneError, match=r"mesh 'rag'.* no product of vertex colours and texture"):
        path_traced(scene(two, lights=LIGHTS[:1]), size=SIZE)
    holes = aolab.Material(alpha=0.5, blend=True, emission=(1, 1, 1))
    with pytest.raises(SceneError, match=r"has no emission of a surface with holes, or blended"):
        path_traced(scene(quad((0, 0, 0), (1, 0, 0), (0, 1, 0), material=holes)), size=SIZE)
    uneven = aolab.Material(texture=aolab.Texture(np.zeros((1, 1, 4), np.uint8), "rug", wrap=("repeat", "clamp")))
    with pytest.raises(SceneError, match=r"texture 'rug': .* one wrap for both axes, not repeat and clamp"):
        path_traced(scene(quad((0, 0, 0), (1, 0, 0), (0, 1, 0), material=uneven), lights=LIGHTS[:1]), size=SIZE)
