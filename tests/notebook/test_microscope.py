"""The microscope replays the samples of a pixel: its values are those of the shader."""

import numpy as np
import pytest
from scipy.ndimage import binary_erosion
from small_scenes import of, quad

import aolab
from aolab import Camera, DirectionalLight, Environment, ParameterError
from aolab.modules import MODULES
from aolab.modules.marched import Marched
from aolab.modules.occluders import OCCLUDERS, Depth, Height, Product, Voxels
from aolab.notebook.microscope.blocking import OCCLUDER_TWINS
from aolab.notebook.microscope.twins import taking

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
    ("ssbn", {}),
    ("ssbn", {"weighting": "uniform"}),
    ("instant_radiosity", {}),
    ("s3ho", {}),
    ("s3ho", {"strength": 3.0, "indirect": True}),
    ("s3ho", {"strength": 3.0, "estimator": "plain"}),
    ("rotated_ssao", {}),
    ("rotated_ssao", {"scale": 0.5, "occluders": "layers", "strength": 2.0}),
]


def pixels(frame, count: int) -> list[tuple[int, int]]:
    """Random pixels with a surface, also at half the resolution."""
    rows, columns = np.nonzero(binary_erosion(frame.mask, iterations=2))
    chosen = np.random.default_rng(5).choice(len(rows), count, replace=False)
    return [(int(columns[i]), int(rows[i])) for i in chosen]


def test_every_module_whose_samples_have_a_twin_is_a_case():
    assert {name for name, _ in CASES} == {name for name, module in MODULES.items() if taking(module())}


@pytest.mark.filterwarnings("ignore::aolab.Notice")  # the floor is not closed
@pytest.mark.parametrize(("module", "parameters"), CASES, ids=str)
def test_the_replay_is_the_shader(lab, boxes, module, parameters):
    sky = Environment.sky()
    frame = lab.render(boxes.replace(environment=sky), module, radius=1.0, seed=3, **parameters)
    seen = [aolab.microscope(frame, pixel) for pixel in pixels(frame, 60)]
    assert max(one.difference for one in seen) <= 1e-3
    assert any(one.passes[0].sets[0].blocked.any() for one in seen)


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


def test_it_has_a_picture(lab, boxes):
    frame = lab.render(boxes, "ssao", radius=1.0)
    picture = np.asarray(aolab.microscope(frame, pixels(frame, 1)[0]).picture())
    assert picture.shape == (414, 900, 3)
    assert picture.std() > 5


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


def test_a_relit_frame_is_replayed_under_its_light(lab, boxes):
    frame = lab.render(boxes, "ssdo", radius=1.0)
    lit = lab.relight(frame, environment=Environment.constant((0.0, 2.0, 0.0)), lights=[DirectionalLight((0, -1, 0))])
    assert max(aolab.microscope(lit, pixel).difference for pixel in pixels(lit, 10)) <= 1e-3
