"""The microscope replays the samples of a pixel: its values are those of the shader."""

import numpy as np
import pytest
from scipy.ndimage import binary_erosion
from small_scenes import box, floor, of, quad

import aolab
from aolab import Camera, DirectionalLight, Environment, ParameterError, PointLight, SpotLight
from aolab.modules import MODULES, find
from aolab.modules.estimate import Estimate
from aolab.modules.marched import Marched
from aolab.modules.occluders import OCCLUDERS, Depth, Height, Product, Voxels
from aolab.modules.occluders.base import OccluderKind
from aolab.notebook.microscope.blocking import OCCLUDER_TWINS
from aolab.notebook.microscope.twins import TWINS, taking

CASES = [
    ("ssao", {}),
    ("ssao", {"power": 2.0, "directions": 16, "steps": 7, "thickness": 0.4}),
    ("ssao", {"occluders": "layers"}),
    ("ssao", {"occluders": "views"}),
    ("ssao", {"occluders": "views", "view_layers": 2}),
    ("ssao", {"occluders": "voxels", "voxels": 64, "steps": 8}),
    ("ssdo", {"occluders": "voxels", "voxels": 32}),
    ("ssao", {"occluders": Product(first=Depth(), second=Voxels(voxels=64))}),
    ("ssdo", {"scale": 0.5}),
    ("ssdo", {"estimator": "plain"}),
    ("ssdo", {"bounces": 1}),
    ("ssdo", {"bounces": 1, "senders": "patches", "bleeding": 2.0, "scale": 0.5}),
    ("ssdo", {"bounces": 1, "occluders": "layers"}),
    ("ssdo", {"bounces": 1, "occluders": "views"}),
    ("ssdo", {"bounces": 1, "occluders": Product(first=Depth(), second=Voxels(voxels=64))}),
    ("ssdo", {"light_steps": 4, "fill": 2}),
    ("ssdo", {"light_steps": 6, "occluders": "layers", "scale": 0.5}),
    ("ssbn", {}),
    ("ssbn", {"weighting": "uniform"}),
    ("s3ho", {}),
    ("s3ho", {"strength": 3.0, "indirect": True, "occluders": "layers"}),
    ("s3ho", {"indirect": True, "senders": "patches"}),
    ("s3ho", {"strength": 3.0, "estimator": "plain"}),
    ("rotated_ssao", {}),
    ("rotated_ssao", {"scale": 0.5, "occluders": "layers", "strength": 2.0}),
    ("hao", {}),
    ("hao", {"occluders": "depth", "spread": 0.6, "scale": 1.0}),
    ("hao", {"voxel_region": "middle"}),
    ("ambient_transfer", {}),
    ("ambient_transfer", {"albedo_source": "radiance", "occluders": "layers"}),
    ("ambient_transfer", {"silhouette_elimination": False, "measure": "exponential", "steps": 3}),
    ("rsm", {}),
    ("rsm", {"gather": "full", "rsm_radius": 0.2, "rsm_samples": 64}),
    ("rsm", {"gather": "low", "rsm_samples": 64}),
    ("ssao+rsm", {"scale": 0.5}),
    ("environment_vpl", {"environment_lights": 40}),
    ("environment_vpl", {"fill": 4, "vpl_resolution": 16, "environment_lights": 20}),
    ("environment_vpl", {"fill": 4, "occluders": "voxels", "environment_lights": 20}),
    ("ssbn", {"fill": 4, "shadow_resolution": 16}),
    ("instant_radiosity", {"fill": 3, "scale": 0.5, "bounce_lights": 40}),
    ("instant_radiosity", {"near_field": True, "vpl_clamp": 2.0, "occluders": "layers"}),
    ("instant_radiosity", {"near_field": True, "bounce_lights": 8}),
    ("ssdo+instant_radiosity", {"bounce_lights": 10}),
]

LAMPS = (DirectionalLight((-0.5, -1, -0.3)), SpotLight((2, 4, 3), (-0.5, -1, -0.6), (30, 30, 30), inner=20, outer=35))
MORE_LAMPS = (
    *LAMPS,
    PointLight((-1.5, 2.5, 1.5), (5, 5, 8)),
    DirectionalLight((1, -0.4, 0), (2, 1, 1), shadow=False),  # which samples on the screen alone can block
)


def pixels(frame, count: int) -> list[tuple[int, int]]:
    """Random pixels with a surface, also at half the resolution."""
    rows, columns = np.nonzero(binary_erosion(frame.mask, iterations=2))
    chosen = np.random.default_rng(5).choice(len(rows), count, replace=False)
    return [(int(columns[i]), int(rows[i])) for i in chosen]


@pytest.mark.parametrize("module", MODULES)
def test_every_module_that_takes_samples_is_a_case(module):
    assert bool(taking(MODULES[module]())) == (module != "none")
    assert (module in {name for name, _ in CASES}) == (module != "none")


@pytest.mark.parametrize(("module", "parameters"), CASES, ids=str)
def test_every_pass_of_an_estimate_has_a_twin(module, parameters):
    one = find(module, MODULES, **parameters)
    estimates = [step for step in (one.estimate(), *one.lighting(), one.bounce()) if isinstance(step, Estimate)]
    shaders = {str(step.shader) for estimate in estimates for step in estimate.passes}
    assert shaders <= {*TWINS, "hao.outside.frag", "none.frag"}  # the first is in the twin of hao.frag


@pytest.mark.filterwarnings("ignore::aolab.Notice")  # the floor is not closed, the point light has no reflective map
@pytest.mark.parametrize(("module", "parameters"), CASES, ids=str)
def test_the_replay_is_the_shader(lab, boxes, module, parameters):
    scene = boxes.replace(environment=Environment.sky(), lights=MORE_LAMPS)
    settings = {"radius": 1.0} if find(module, MODULES).has_radius() else {}
    settings |= {"shadow_resolution": 128, **parameters}  # small shadow maps are read back sooner
    frame = lab.render(scene, module, seed=3, **settings)
    seen = [aolab.microscope(frame, pixel) for pixel in pixels(frame, 60)]
    assert max(one.difference for one in seen) <= 1e-3
    tested = [one.sets[0] for pixel in seen for one in pixel.passes if one.name not in ("rsm gather", "rsm complete")]
    assert not tested or any(one.blocked.any() for one in tested)


def test_every_kind_of_occluders_has_a_twin():
    assert set(OCCLUDER_TWINS) == set(OCCLUDERS.values())


@pytest.mark.parametrize(
    "occluders",
    [Height(), Height(depth_too=False), Product(first=Depth(), second=Height())],
    ids=lambda kind: repr(kind.model_dump()),
)
@pytest.mark.parametrize("settings", [{}, {"normals": "geometric"}], ids=str)
def test_samples_of_a_relief_are_replayed(lab, occluders, settings):
    frame = lab.render("relief", "ssao", size=(96, 64), radius=0.3, steps=8, occluders=occluders, **settings)
    seen = [aolab.microscope(frame, pixel) for pixel in pixels(frame, 60)]
    assert max(one.difference for one in seen) <= 1e-3
    assert np.mean([one.passes[0].sets[0].blocked.any() for one in seen]) > 0.3


def test_accumulated_sets_are_replayed(lab, boxes):
    frame = lab.render(boxes, "ssao", radius=1.0, accumulate=3, power=2.0)
    seen = [aolab.microscope(frame, pixel) for pixel in pixels(frame, 20)]
    assert {len(one.passes[0].sets) for one in seen} == {3}
    assert max(one.difference for one in seen) <= 1e-3


def test_contributions_add_up_to_the_value(lab, boxes):
    frame = lab.render(boxes, "ssdo", radius=1.0)
    for pixel in pixels(frame, 5):
        (seen,) = aolab.microscope(frame, pixel).passes
        assert seen.sets[0].contributions["open_light"].sum(axis=0) == pytest.approx(seen.values["open_light"])


def test_a_wall_blocks_and_is_named(lab, wall):
    frame = lab.render(wall, "ssao", radius=3.0, directions=32, camera=Camera((4, 3, 0), (0.5, 0.3, 0), fov=60))
    rows, columns = np.nonzero(frame.mask & (frame["visibility"] < 0.7))
    seen = aolab.microscope(frame, (int(columns[0]), int(rows[0])))
    (seen_pass,) = seen.passes
    blocked = ~seen_pass.sets[0].open
    assert blocked.any()
    assert {seen_pass.blockers[i] for i in np.flatnonzero(blocked)} <= {"wall", "floor"}
    assert {seen_pass.blockers[i] for i in np.flatnonzero(~blocked)} <= {""}
    assert "blocked at" in str(seen)
    assert str(seen).count("direction ") == 32


def test_light_from_open_directions_contributes_in_its_colour(lab):
    red = Environment.constant((1.0, 0.0, 0.0))
    scene = of(quad((-5, 0, 5), (10, 0, 0), (0, 0, -10)), camera=Camera((0, 3, 4), (0, 0, 0)), sky=red)
    seen = aolab.microscope(lab.render(scene, "ssdo"), (32, 30))
    parts = seen.passes[0].sets[0].contributions["open_light"]
    assert parts[:, 0] == pytest.approx(np.full(len(parts), 1 / len(parts)), rel=1e-3)
    assert (parts[:, 1:3] == 0).all()


def test_your_own_marched_module_is_replayed(lab, boxes):
    class Halved(Marched):
        name = "halved"
        shader = aolab.SSAO.shader
        power: float = aolab.parameter(1.0, "Contrast.", gt=0)

    frame = lab.render(boxes, Halved(radius=1.0))
    assert max(aolab.microscope(frame, pixel).difference for pixel in pixels(frame, 10)) <= 1e-3


@pytest.mark.parametrize("module", ["ssao", "rotated_ssao", "rsm", "environment_vpl", "instant_radiosity"])
def test_it_has_a_picture_with_a_row_for_each_pass(lab, boxes, module):
    frame = lab.render(boxes.replace(lights=LAMPS), module)
    seen = aolab.microscope(frame, pixels(frame, 1)[0])
    picture = np.asarray(seen.picture())
    assert picture.shape == (414 * len(seen.passes), 900, 3)
    assert picture.std() > 5


def test_a_scene_without_lamps_has_no_virtual_lights(lab, boxes):
    frame = lab.render(boxes, "instant_radiosity")
    bounce = aolab.microscope(frame, pixels(frame, 1)[0]).passes[1]
    assert len(bounce.sets[0].ends) == 0
    assert bounce.values["reflective_irradiance"] == pytest.approx(0)
    assert "0 of 0 lights open" in str(bounce)


def test_virtual_lights_behind_a_wall_are_blocked_by_it(lab):
    """From the floor at (1, 0, 0), a wall 10 wide and 8 high in the plane x = 0 hides the low lights on its side."""
    scene = of(floor(6), box((-0.2, 0, -5), (0, 8, 5), name="wall"), camera=Camera((3, 3, 0), (1, 0, 0), fov=40))
    frame = lab.render(scene, "environment_vpl")
    (seen,) = aolab.microscope(frame, (32, 24)).passes
    samples = seen.sets[0]
    x, y, z = ((samples.ends - samples.receiver) @ frame.camera.view_from_world[:3, :3]).T
    low = (x < 0) & (np.abs(z) < -3 * x) & (y > 0) & (y < -3 * x)
    assert low.sum() > 3
    assert {seen.blockers[i] for i in np.flatnonzero(low)} == {"wall"}
    assert not samples.contributions["environment_irradiance"][low].any()
    assert samples.open[(x > 0) & (y > 0)].all()


def test_a_pixel_light_is_on_the_surface_that_a_lamp_lights(lab, boxes):
    frame = lab.render(boxes.replace(lights=LAMPS[:1]), "rsm")
    (seen,) = aolab.microscope(frame, pixels(frame, 1)[0]).passes
    assert "48 pixel lights" not in str(seen)  # one map has 24
    assert "24 pixel lights, not tested for blocking" in str(seen)
    assert "pixel light 0: on floor at" in str(seen)


def test_wrong_pixels_and_frames_are_refused(lab, plane, boxes):
    frame = lab.render(plane, "ssao", camera=Camera((0, 1, 6), (0, 1, 0)))
    with pytest.raises(ParameterError, match=r"microscope: pixel \(10, 2\) is in the background"):
        aolab.microscope(frame, (10, 2))
    with pytest.raises(ParameterError, match=r"microscope: pixel = \(64, 2\) is not a \(column, row\)"):
        aolab.microscope(frame, (64, 2))
    with pytest.raises(
        ParameterError, match="none takes no samples that can be computed again; modules that do: ssao, ssdo"
    ):
        aolab.microscope(lab.render(plane, "none"), (30, 40))
    frame.kept = None
    with pytest.raises(ParameterError, match="not rendered by a lab"):
        aolab.microscope(frame, (30, 40))


def test_occluders_without_a_twin_are_refused(lab, boxes):
    class Mine(OccluderKind):
        name = "mine"
        shader = Depth.shader

    frame = lab.render(boxes, "ssao", occluders=Mine())
    with pytest.raises(ParameterError, match="the occluders 'mine' are unknown; known: depth, layers"):
        aolab.microscope(frame, pixels(frame, 1)[0])


def test_a_relit_frame_is_replayed_under_its_light(lab, boxes):
    frame = lab.render(boxes, "ssdo", radius=1.0)
    lit = lab.relight(frame, environment=Environment.constant((0.0, 2.0, 0.0)), lights=[DirectionalLight((0, -1, 0))])
    assert max(aolab.microscope(lit, pixel).difference for pixel in pixels(lit, 10)) <= 1e-3
