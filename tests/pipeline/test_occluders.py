"""Peeled layers and further views, which see more than one depth layer, against rays and known geometry."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
import small_scenes
from small_scenes import OPEN, box, of, quad, world_positions

import aolab
from aolab import Camera, DirectionalLight, Environment, Material, PointLight
from aolab.modules.occluders.views import further_cameras
from aolab.pipeline.rasterizer import Rasterizer

DARK = Environment.constant(0.0)
RED = Material((0.75, 0.0, 0.0))
KINDS = ["layers", "views"]
CONVERGED = {"directions": 16, "steps": 16, "accumulate": 4, "filter": "none"}

pytestmark = pytest.mark.filterwarnings("ignore:.*not closed:aolab.Notice")


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.nanmean(np.square(values, dtype=np.float64))))


def error(lab, scene: aolab.Scene, kind: str, truth: aolab.Frame, where=np.s_[:], module="ssao", **settings) -> float:
    """RMSE of the visibility against rays."""
    frame = lab.render(scene, module, occluders=kind, size=truth.size, **{**CONVERGED, **settings})
    return rms((frame["visibility"] - truth["visibility"])[where])


def traced(scene: aolab.Scene, radius: float, size=(96, 72)) -> aolab.Frame:
    like = aolab.SSAO(radius=radius)
    return aolab.reference(scene, size=size, like=like, rays=128, buffers="visibility", cache=False)


# --- both kinds


@pytest.mark.parametrize("module", ["ssao", "ssdo"])
@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_serves_every_module(lab, boxes, module, kind):
    frame, plain = (lab.render(boxes, module, occluders=one, radius=0.8) for one in (kind, "depth"))
    assert 0 <= np.nanmin(frame["visibility"]) < 0.8
    assert np.nanmax(frame["visibility"]) == 1
    assert (frame["visibility"] != plain["visibility"])[frame.mask].any()
    other = lab.render(boxes, "ssao" if module == "ssdo" else "ssdo", occluders=kind, radius=0.8)
    np.testing.assert_allclose(frame["visibility"], other["visibility"], atol=1e-3)


@pytest.mark.parametrize("scale", [1.0, 0.5])
@pytest.mark.parametrize(
    "settings",
    [
        {"occluders": "layers"},
        {"occluders": "views"},
        {"occluders": "views", "view_scale": 0.125},
        {"occluders": "views", "view_layers": 4, "view_scale": 1.0},
    ],
    ids=str,
)
def test_a_plane_stays_exactly_open(lab, settings, scale):
    cameras = {
        "above": Camera((0, 3, 6), (0, 0, 0)),
        "straight down": Camera((3, 80, 2), (0, 0, 1)),
        "grazing": Camera((0, 0.05, 6), (0, 0, 0)),
        "rolled": Camera((20, 1, 30), (0, 0, 0), up=(0.3, 1, 0.2)),
        "narrow": Camera((0, 3, 6), (0, 0, 0), fov=2),
    }
    for name, camera in cameras.items():
        for half in (10.0, 100.0):
            for radius in (0.5, 5.0):
                scene = small_scenes.plane(camera, half)
                frame = lab.render(scene, "ssao", radius=radius, scale=scale, bias=0.0, filter="none", **settings)
                assert frame["visibility"][frame.mask].min() >= OPEN, (name, half, radius)


@pytest.mark.parametrize("kind", KINDS)
def test_nothing_is_drawn_for_kinds_that_are_not_chosen(lab, boxes, kind):
    plain = lab.render(boxes, "ssdo", bounces=1).complete()
    assert not {"peel", "pack layers", "views"} & set(plain.timings)
    extra = set(lab.render(boxes, "ssdo", bounces=1, occluders=kind).complete().timings) - set(plain.timings)
    assert extra == {"layers": {"peel", "pack layers"}, "views": {"views"}}[kind]
    assert lab.render(boxes, "ssdo", occluders=kind).buffers == lab.render(boxes, "ssdo").buffers


# --- layers


@pytest.mark.parametrize(
    ("layers", "at", "layer"),
    [
        ((-1, -2, -4, -6), (-0.9, -1.1, -1.9, -2.1, -3.9, -4.1, -5.9, -6.1), (-1, 0, 1, -1, -1, 2, 3, -1)),
        ((-1, -2, -4, -np.inf), (-1.1, -3, -4.1, -4.6), (0, -1, 2, -1)),  # half a unit thick
        ((-1, -np.inf, -np.inf, -np.inf), (-0.9, -1.4, -1.6), (-1, 0, -1)),
        ((-np.inf, -np.inf, -np.inf, -np.inf), (-1, -1e9), (-1, -1)),
    ],
    ids=["two solids", "the second open", "one sheet", "background"],
)
def test_a_point_is_inside_the_first_solid_or_the_second(glsl, layers, at, layer):
    """And its occluder is the side of it that is nearer."""
    include = 'lib/space.glsl"\n#include "lib/solids.glsl'
    rows = np.pad(np.array(at, float)[:, None], ((0, 0), (0, 3)))
    found = glsl(include, "result.x = float(solidAt(layers, x.x, 0.5));", rows, layers=layers)[:, 0]
    np.testing.assert_array_equal(found, layer)


def slab_before_a_wall() -> aolab.Scene:
    """A thin slab floating before a wall, both closed; between them is room."""
    wall = box((-4, -4, -1), (4, 4, 0))
    return of(wall, box((-0.6, -0.4, 0.6), (0.6, 0.4, 0.7)), camera=Camera((0.8, 0.5, 4), (0, 0, 0)))


def test_light_passes_behind_a_slab(lab):
    """Points behind its back are open: no halo, in contrast to one depth without a range check."""
    scene = slab_before_a_wall()
    truth = traced(scene, 1.0)
    of_kind = {kind: error(lab, scene, kind, truth, radius=1.0, thickness=10.0) for kind in ("depth", "layers")}
    assert of_kind["layers"] < 0.025
    assert of_kind["depth"] > 5 * of_kind["layers"]


def test_a_thick_wall_seen_edge_on_is_solid(lab):
    """Its depth goes on behind what is seen, farther than any thickness that keeps halos away."""
    scene = of(
        box((-5, -0.2, -8), (5, 0, 5)),
        box((-0.4, 0, -4), (0.4, 1.6, 1.6)),  # its long side along the view
        camera=Camera((0.9, 1.2, 5), (0.4, 0.5, 0)),
    )
    truth = traced(scene, 1.0)
    assert error(lab, scene, "layers", truth, radius=1.0, thickness=0.1) < 0.03
    assert error(lab, scene, "depth", truth, radius=1.0, thickness=0.1) > 0.05


def test_a_far_post_throws_no_halo_however_thick_surfaces_are_taken_to_be(lab):
    scene = of(
        box((-20, -20, -1), (20, 20, 0)), box((-0.2, -19, 4), (0.2, 19, 4.2)), camera=Camera((0, 0, 10), (0, 0, 0))
    )
    depth, layers = (
        lab.render(scene, "ssao", occluders=kind, radius=1.0, thickness=10.0, filter="none")
        for kind in ("depth", "layers")
    )
    behind = depth["viewZ"] < -9
    assert (layers["visibility"][behind] == 1).all()
    assert depth["visibility"][behind].min() < 0.9


@pytest.fixture
def peelings(monkeypatch):
    """Counts the passes: a list of whether each one found anything."""
    found = []
    peel = Rasterizer.peel

    def counted(*args, **kwargs):
        layer = peel(*args, **kwargs)
        found.append(layer is not None)
        return layer

    monkeypatch.setattr(Rasterizer, "peel", counted)
    return found


def test_peeling_stops_where_nothing_is_left(lab, plane, peelings):
    lab.render(plane, "ssao", occluders="layers", layers=4)
    assert peelings == [False]  # one layer: the first look behind it finds nothing, and there is no second
    del peelings[:]
    one_box = of(box((-1, -1, -1), (1, 1, 1)), camera=Camera((0, 0, 5), (0, 0, 0)))
    frame = lab.render(one_box, "ssao", occluders="layers", layers=4)
    assert peelings == [True, False]
    assert (frame["visibility"][frame.mask] == 1).all()
    del peelings[:]
    two = of(*(box((-1, -1, z), (1, 1, z + 0.5)) for z in (0, 1)), camera=Camera((0, 0, 5), (0, 0, 0)))
    for layers, expected in ((4, [True] * 3), (3, [True] * 2), (2, [True])):
        lab.render(two, "ssao", occluders="layers", layers=layers)
        assert peelings == expected
        del peelings[:]
    lab.render(two, "ssao", occluders="views", view_layers=2)
    assert peelings == [True]  # of all views in one atlas


def test_more_layers_than_the_scene_has_change_nothing(lab):
    scene = of(box((-2, -1, -1), (2, 0, 1)), camera=Camera((0, 2, 4), (0, 0, 0)))
    two, four = (lab.render(scene, "ssao", occluders="layers", layers=layers) for layers in (2, 4))
    np.testing.assert_array_equal(two["visibility"], four["visibility"])


def test_layers_out_of_range_are_refused():
    for bad in (1, 5):
        with pytest.raises(aolab.ParameterError, match=rf"layers = {bad}.*2.*4|layers.*{bad}"):
            aolab.SSAO().replace(occluders="layers", layers=bad)


@pytest.mark.parametrize("settings", [{"occluders": "layers"}, {"occluders": "views", "view_layers": 2}], ids=str)
def test_open_meshes_are_named_once(lab, settings):
    open_ones = [
        quad((-1, 0, 1), (2, 0, 0), (0, 0, -2), name="sheet"),
        quad((-1, 1, 1), (2, 0, 0), (0, 0, -2), name="sail"),
    ]
    scene = of(*open_ones, box((-1, -2, -1), (1, -1, 1), name="crate"), camera=Camera((0, 3, 6), (0, 0, 0)))
    with pytest.warns(aolab.Notice, match=r"2 of 3 meshes are not closed \(sail, sheet\).*`thickness` closes it"):
        frame = lab.render(scene, "ssao", **settings)
    assert len(frame.notes) == 1
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert lab.render(scene, "ssao", seed=1, **settings).notes == []
        closed = of(box((-1, -2, -1), (1, -1, 1)), camera=scene.camera)
        assert lab.render(closed, "ssao", **settings).notes == []


def test_thickness_closes_what_is_open(lab, wall):
    """A wall of one sheet, and nothing behind it, blocks as deep as the thickness."""
    settings = {"occluders": "layers", "radius": 0.6, "filter": "none", "size": (96, 72)}
    thin, thick = (lab.render(wall, "ssao", thickness=thickness, **settings) for thickness in (0.02, 2.0))
    x, y, _ = np.moveaxis(world_positions(thin, wall.camera), -1, 0)
    near = (np.abs(y) < 1e-3) & (x > 0.05) & (x < 0.2)
    assert near.sum() > 50
    slipped = thin["visibility"][near].mean() - thick["visibility"][near].mean()
    assert slipped > 0.1  # steps pass through the sheet between two points


def hidden_back() -> aolab.Scene:
    """A red screen before the camera, and a lamp behind it that only its back sees; the floor shows over its edge."""
    lamp = PointLight((0, 0.5, -1.5), (10.0, 10.0, 10.0))
    screen, ground = box((-1.5, 0, 0), (1.5, 0.7, 0.2), RED), box((-6, -0.5, -6), (6, 0, 6))
    return of(ground, screen, camera=Camera((0, 4, 2.5), (0, 0, -0.4)), lights=(lamp,), sky=DARK)


@pytest.mark.slow
def test_hidden_senders_bounce(lab):
    """The red back of the screen, which the camera does not see, shines onto the floor behind it."""
    scene, size = hidden_back(), (128, 96)
    settings = {"radius": 1.2, "bounces": 1, "senders": "rays", "size": size, **CONVERGED}
    one_layer = lab.render(scene, "ssdo", **settings)
    frames = [
        lab.render(scene, "ssdo", occluders="layers", **settings),
        lab.render(scene, "ssdo", occluders="views", view_scale=1.0, **settings),
    ]
    truth = aolab.reference(scene, size=size, like=aolab.SSDO(radius=1.2), buffers="indirect", cache=False)
    _, y, z = np.moveaxis(world_positions(one_layer, scene.camera), -1, 0)
    behind = (np.abs(y) < 1e-3) & (z < -0.3) & (z > -1.0) & (truth["indirect"][..., 0] > 0.05 * truth["indirect"].max())
    assert behind.sum() > 30
    expected = truth["indirect"][behind, 0].mean()
    assert one_layer["indirect"][behind, 0].mean() < 0.1 * expected
    for frame in frames:
        assert frame["indirect"][behind, 0].mean() == pytest.approx(expected, rel=0.35)
        assert frame["indirect"][behind, 1].max() < 0.02 * expected  # red alone: the floor itself is no sender


# --- views


@pytest.mark.parametrize("shape", ["boxes", "ball"])
def test_the_views_stand_as_in_the_paper(shape):
    """Displaced by a unit vector times the bounding sphere's radius, towards the same centre of interest."""
    view = Camera((0.5, 2.5, 5), (0, 0.5, 0))
    ball = small_scenes.of(small_scenes.sphere(2.0, (1, 0, 0)), camera=view)
    scene, radius = {"boxes": (small_scenes.boxes(view), np.sqrt(20**2 + 1.8**2 + 20**2) / 2), "ball": (ball, 2)}[shape]
    cameras = further_cameras(view, scene)
    assert len(cameras) == 4
    eye = np.array(view.eye)
    forward = -view.view_from_world[2, :3]
    for camera in cameras:
        assert np.linalg.norm(np.array(camera.eye) - eye) == pytest.approx(radius, rel=1e-3)
        towards = np.array(camera.target) - eye
        assert towards @ forward == pytest.approx(np.linalg.norm(towards))  # on the camera's own axis
        assert camera.target == pytest.approx(cameras[0].target)
        assert camera.fov == view.fov
    axes = view.view_from_world[:3, :3]
    right, left, above, _ = (axes @ (np.array(camera.eye) - eye) / radius for camera in cameras)
    np.testing.assert_allclose([right, left, above], [(1, 0, 0), (-1, 0, 0), (0, 1, 0)], atol=1e-3)


@pytest.mark.parametrize(
    "camera",
    [
        Camera((0, 6, 0), (0, 0, 0), up=(0, 0, -1)),
        Camera((0, 6, 1e-4), (0, 0, 0)),
        Camera((0, -6, 0), (0, 0, 0), up=(1, 0, 0)),
        Camera((0, 0.5, 0), (0, 0.5, -1)),  # in the middle of the scene
        Camera((0, 12, 12), (0, 0, 0)),
        Camera((0, 1, 500), (0, 0, 0), fov=5),
    ],
    ids=["down", "nearly down", "up", "inside", "diagonal", "far away"],
)
def test_no_camera_is_without_views(lab, boxes, camera):
    scene = replace(boxes, camera=camera)
    assert len(further_cameras(camera, scene)) == 4
    frame = lab.render(scene, "ssdo", occluders="views", bounces=1)
    assert np.isfinite(frame["radiance"]).all()


def test_the_view_from_above_when_it_stands_over_the_centre_of_interest():
    """There its up would be along its own look."""
    scene = small_scenes.boxes()
    eye = np.array((0, 0.5 - scene.sphere_radius, 0))
    camera = Camera(tuple(eye), (0, 0.5 - scene.sphere_radius / 2, 0), up=(0, 0, -1))
    for one in further_cameras(camera, scene):
        assert np.isfinite(one.view_from_world).all()


def hidden_blocker() -> tuple[aolab.Scene, aolab.Scene]:
    """A low block right behind a screen, and the same without it; the floor beside them is seen."""
    ground, screen = box((-6, -0.5, -6), (6, 0, 6)), box((-1, 0, 0), (1, 1.6, 0.1))
    camera = Camera((0.9, 1.0, 5), (0.9, 0.4, 0))
    return of(ground, screen, box((0.3, 0, -1.3), (0.93, 1.2, -0.35)), camera=camera), of(ground, screen, camera=camera)


def test_blockers_that_the_camera_does_not_see_count(lab):
    """The floor right of the screen is darkened by what stands behind it."""
    scene, without = hidden_blocker()
    size = (128, 96)
    truth, bare = traced(scene, 0.8, size), traced(without, 0.8, size)
    shaded = bare["visibility"] - truth["visibility"] > 0.1
    shaded &= np.isclose(truth["viewZ"], bare["viewZ"], atol=1e-4)  # seen with and without it
    assert shaded.sum() > 20
    depth = error(lab, scene, "depth", truth, shaded, radius=0.8)
    views = error(lab, scene, "views", truth, shaded, radius=0.8, view_scale=1.0)
    assert views < 0.5 * depth


BESIDE_THE_WALL = Camera((1.75, 3, 0), (1.75, 0, 0), up=(0, 0, -1))  # straight down: the wall is just out of sight


def test_blockers_off_the_screen_count(lab):
    """The wall beside the picture, which one view does not see."""
    scene = of(box((0, -0.5, -3), (4, 0, 3)), box((-0.5, -0.5, -3), (0, 2.5, 3)), camera=BESIDE_THE_WALL)
    truth = traced(scene, 1.5)
    assert np.nanmean(truth["visibility"]) < 0.97
    depth = error(lab, scene, "depth", truth, radius=1.5)
    views = error(lab, scene, "views", truth, radius=1.5, view_scale=1.0)
    assert views < 0.35 * depth


@pytest.mark.parametrize("side", [1, -1], ids=["left", "right"])
def test_senders_off_the_screen_contribute(lab, side):
    """A lit red wall beside the picture, on its left or right, colours the floor in it."""

    def mirrored(low, high, material=small_scenes.WHITE):
        corners = np.array((low, high)) * (side, 1, 1)
        return box(corners.min(axis=0), corners.max(axis=0), material)

    meshes = mirrored((0, -0.5, -3), (4, 0, 3)), mirrored((-0.5, -0.5, -3), (0, 2.5, 3), RED)
    sun = DirectionalLight((-side, -1, 0), (3.0, 3.0, 3.0))
    x = side * BESIDE_THE_WALL.eye[0]
    camera = replace(BESIDE_THE_WALL, eye=(x, 3, 0), target=(x, 0, 0))
    scene = of(*meshes, camera=camera, lights=(sun,), sky=DARK)
    settings = {"radius": 1.5, "bounces": 1, "senders": "rays", **CONVERGED}
    frame = lab.render(scene, "ssdo", occluders="views", view_scale=1.0, **settings)
    one_view = lab.render(scene, "ssdo", **settings)
    truth = aolab.reference(scene, size=frame.size, like=aolab.SSDO(radius=1.5), buffers="indirect", cache=False)
    assert (one_view["indirect"] == 0).all()
    assert rms(frame["indirect"] - truth["indirect"]) < 0.45 * rms(truth["indirect"])


@pytest.mark.parametrize(
    ("parameter", "bad", "allowed"),
    [("views", 0, "1.*4"), ("views", 5, "1.*4"), ("view_layers", 0, "1.*4"), ("view_scale", 0.0, "0.125.*1")],
)
def test_views_out_of_range_are_refused(parameter, bad, allowed):
    with pytest.raises(aolab.ParameterError, match=rf"{parameter}.*{bad}.*{allowed}|{parameter}.*{allowed}.*{bad}"):
        aolab.SSDO(occluders="views", **{parameter: bad})


def test_each_setting_of_the_views_has_an_effect(lab):
    scene, _ = hidden_blocker()
    plain = lab.render(scene, "ssao", occluders="views", radius=0.8)["visibility"]
    for change in ({"views": 1}, {"view_scale": 0.25}, {"view_layers": 2}):
        other = lab.render(scene, "ssao", occluders="views", radius=0.8, **change)["visibility"]
        assert not np.array_equal(plain, other, equal_nan=True), change


@pytest.mark.slow
def test_more_views_and_finer_ones_come_closer_to_rays(lab):
    scene, _ = hidden_blocker()
    truth = traced(scene, 0.8, (128, 96))
    coarse, fine = (error(lab, scene, "views", truth, radius=0.8, view_scale=scale) for scale in (0.125, 1.0))
    one, four = (error(lab, scene, "views", truth, radius=0.8, view_scale=1.0, views=views) for views in (1, 4))
    assert fine < coarse
    assert four <= one
    assert fine < 0.05


def test_a_surface_that_a_view_sees_in_the_open_is_not_blocked_by_another_view(lab):
    """The slab before a wall again: no thickness makes a halo, for the views aside look behind it."""
    scene = slab_before_a_wall()
    truth = traced(scene, 1.0)
    views, depth = (error(lab, scene, kind, truth, radius=1.0, thickness=10.0) for kind in ("views", "depth"))
    assert views < 0.4 * depth
