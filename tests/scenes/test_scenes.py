"""The scenes of scenes/: they load, have valid geometry, match their descriptions, and refuse values out of range."""

import subprocess
import sys
import warnings

import numpy as np
import pytest
import trimesh

import aolab
from aolab.loading import scene_names
from aolab.scene.scene import Scene

# number of triangles at the default parameters, least and greatest
TRIANGLES = {
    "atrium": (80_000, 160_000),
    "boxes": (36, 1_000),
    "coins": (3_000, 50_000),
    "colonnade": (20_000, 150_000),
    "cornell": (60, 500),
    "skyscrapers": (5_000, 100_000),
    "toasters": (5_000, 50_000),
}
OUT_OF_RANGE = {
    "atrium": {"detail": 5},
    "boxes": {"light": -1.0},
    "coins": {"sun_elevation": 0.0},
    "colonnade": {"count": 1},
    "cornell": {"lamp": -0.5},
    "skyscrapers": {"sun_elevation": 0.0},
    "toasters": {"count": 0},
}
names = pytest.mark.parametrize("name", sorted(TRIANGLES))


@pytest.fixture(scope="module")
def scenes() -> dict[str, Scene]:
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # including Notices of degenerate triangles
        return {name: aolab.load(name) for name in TRIANGLES}


def meshes(scene: Scene) -> set[aolab.Mesh]:
    return {instance.mesh for instance in scene.instances}


def test_every_scene_is_covered_here():
    assert set(scene_names()) >= set(TRIANGLES)


@names
def test_size_lights_and_camera(name, scenes):
    scene = scenes[name]
    least, greatest = TRIANGLES[name]
    assert least <= scene.triangles <= greatest
    assert scene.lights
    assert (
        scene.environment.irradiance([(0.0, 1.0, 0.0)]).min() > 0.01
    )  # ambient light, so that unlit surfaces are visible
    axis = np.subtract(scene.camera.target, scene.camera.eye)
    towards = scene.bounds.mean(axis=0) - scene.camera.eye
    assert axis @ towards > 0


@names
def test_meshes_are_closed_and_face_outwards(name, scenes):
    for mesh in meshes(scenes[name]):
        solid = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
        solid.merge_vertices(merge_norm=True, merge_tex=True)
        assert solid.is_watertight, mesh.name
        assert solid.is_winding_consistent, mesh.name
        assert solid.volume > 0, mesh.name


@names
def test_normals_agree_with_the_faces(name, scenes):
    for mesh in meshes(scenes[name]):
        a, b, c = np.moveaxis(mesh.vertices[mesh.faces].astype(float), 1, 0)
        face = np.cross(b - a, c - a)
        cosine = (mesh.normals[mesh.faces] * face[:, None]).sum(axis=2) / np.linalg.norm(face, axis=1)[:, None]
        assert cosine.min() > 0, mesh.name


@names
def test_albedo_is_in_the_range_of_real_surfaces(name, scenes):
    for mesh in meshes(scenes[name]):
        albedo = np.array(mesh.material.base_color)
        if mesh.colors is not None:
            albedo = albedo * mesh.colors[:, :3]
        assert albedo.min() > 0.0, mesh.name
        assert albedo.max() <= (0.85 if mesh.material.texture is None else 1.0), mesh.name


@names
def test_loading_again_uses_the_same_meshes_and_environment(name, scenes):
    again = aolab.load(name)
    assert meshes(again) == meshes(scenes[name])
    assert again.environment is scenes[name].environment  # the tables that methods make of it stay on the GPU


@names
def test_values_out_of_range_are_refused(name):
    ((parameter, value),) = OUT_OF_RANGE[name].items()
    with pytest.raises(aolab.ParameterError, match=rf"'{name}': {parameter} = {value} is outside \["):
        aolab.load(name, **OUT_OF_RANGE[name])


def corners(scene: Scene) -> np.ndarray:
    """Every vertex of the scene in world space, sorted, so that the order of instances has no effect."""
    parts = [i.mesh.vertices @ i.world_from_local[:3, :3].T + i.world_from_local[:3, 3] for i in scene.instances]
    points = np.unique(np.concatenate(parts).round(4) + 0.0, axis=0)
    return points


def test_boxes_are_mirror_symmetric(scenes):
    scene, swapped = scenes["boxes"], aolab.load("boxes", swap=True)
    points = corners(scene)
    mirrored = np.unique(points * (-1, 1, 1) + 0.0, axis=0)
    np.testing.assert_allclose(mirrored, points, atol=1e-3)
    assert scene.camera.eye[0] == scene.camera.target[0] == 0
    for light, other in zip(scene.lights, swapped.lights[::-1], strict=True):
        assert light.intensity == other.intensity
        np.testing.assert_array_equal(np.multiply(light.position, (-1, 1, 1)), other.position)
        np.testing.assert_array_equal(np.multiply(light.direction, (-1, 1, 1)), other.direction)
    assert scene.environment is not None
    np.testing.assert_allclose(scene.environment.radiance[:, ::-1], swapped.environment.radiance, rtol=1e-5)
    assert scene.lights[0].intensity != swapped.lights[0].intensity


def test_skyscrapers_depend_on_their_seed(scenes):
    first = [i.world_from_local for i in scenes["skyscrapers"].instances]
    again = [i.world_from_local for i in aolab.load("skyscrapers", seed=7).instances]
    other = [i.world_from_local for i in aolab.load("skyscrapers", seed=8).instances]
    np.testing.assert_array_equal(first, again)
    assert len(first) != len(other) or not np.array_equal(first, other)


def test_atrium_detail_multiplies_triangles():
    counts = [aolab.load("atrium", detail=detail).triangles for detail in (1, 2, 3, 4)]
    assert counts == sorted(set(counts))
    assert 300_000 <= counts[-1] <= 600_000


def test_colonnade_hides_the_pink_column_from_its_camera(scenes):
    scene, without = scenes["colonnade"], aolab.load("colonnade", hidden=False)
    assert len(scene.instances) == len(without.instances) + 1
    frames = [aolab.render(one, "none", size=(640, 360)) for one in (scene, without)]
    np.testing.assert_array_equal(frames[0]["albedo"], frames[1]["albedo"])
    assert (frames[0]["direct"] < frames[1]["direct"]).any()  # the shadow of the hidden column
    from_above = aolab.Camera((0, 12, -2), (0, 0, -3))
    above = [aolab.render(one, "none", camera=from_above, size=(64, 36))["albedo"] for one in (scene, without)]
    assert not np.array_equal(*above)


def placements(time: float) -> np.ndarray:
    return np.array([i.world_from_local for i in aolab.load("toasters", time=time).instances])


def test_only_the_transforms_of_toasters_change_with_time():
    now, later = aolab.load("toasters", time=0.3), aolab.load("toasters", time=1.7)
    assert [i.mesh for i in now.instances] == [i.mesh for i in later.instances]
    assert not np.allclose(placements(0.3), placements(1.7))


@pytest.mark.parametrize("time", [0.0, 0.49, 1.23, 2.5, 3.97])
def test_toasters_move_continuously_and_periodically(time):
    np.testing.assert_allclose(placements(time + 4), placements(time), atol=1e-9)
    assert np.abs(placements(time + 1e-4) - placements(time)).max() < 5e-3  # at most 50 units a second


def test_toasters_stay_above_the_floor_and_apart():
    for time in np.linspace(0, 4, 33):
        shells = [i for i in aolab.load("toasters", time=float(time), count=10).instances if i.mesh.name == "shell"]
        middle = np.array([i.world_from_local[:3, 3] for i in shells])
        apart = np.linalg.norm(middle[:, None] - middle[None], axis=2)[~np.eye(len(shells), dtype=bool)]
        assert apart.min() > 1.6
        assert middle[:, 1].min() >= -0.011


def test_a_scene_loaded_by_name_does_not_import_trimesh():
    """Scenes are built from `aolab.scene.shapes`, without trimesh: its import takes a third of a second."""
    code = "import sys, aolab; aolab.load('cornell'); sys.exit('trimesh' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
