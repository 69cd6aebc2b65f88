"""Shading normals against the triangles' own: a convex body occludes nothing of itself, in modules and in the truth."""

import numpy as np
import pytest
import small_scenes
import trimesh
from small_scenes import WHITE

import aolab
from aolab import Camera, Mesh
from aolab.modules import MODULES
from aolab.modules.filters import Filter
from aolab.modules.filters.base import over_sources
from aolab.truth.hemisphere import frames
from aolab.truth.points import Points

DEPTHS = [name for name, module in MODULES.items() if module.has_radius() and name != "hao"]  # hao: of voxels
SIZE = (48, 36)


def smooth(shape: trimesh.Trimesh) -> Mesh:
    """The body with normals that point away from its centre, as exporters write them."""
    away = shape.vertices - shape.vertices.mean(axis=0)
    return Mesh(shape.vertices, shape.faces, away / np.linalg.norm(away, axis=1)[:, None], material=WHITE)


def tetrahedron() -> Mesh:
    corners = np.array([(0, 0, -1), (0.87, 0, 0.5), (0, 1.15, 0), (-0.87, 0, 0.5)])
    return smooth(trimesh.Trimesh(corners, [(0, 2, 1), (1, 2, 3), (3, 2, 0), (0, 1, 3)]))


BODIES = {
    "tetrahedron": tetrahedron,
    "box": lambda: smooth(trimesh.creation.box()),
    "cylinder": lambda: smooth(trimesh.creation.cylinder(1, 3, sections=8)),
    "icosahedron": lambda: smooth(trimesh.creation.icosphere(0)),
}


@pytest.mark.parametrize("body", BODIES)
def test_a_convex_body_alone_is_open(lab, body):
    scene = small_scenes.of(BODIES[body]())
    assert scene.is_smooth
    for module in DEPTHS:
        frame = lab.render(scene, module, size=SIZE, radius=1.0, filter="none")
        name = "transfer" if module == "ambient_transfer" else "visibility"
        assert np.min(frame[name][frame.mask]) > 0.99, module
    truth = aolab.reference(scene, size=SIZE, rays=32, buffers="visibility", cache=False)
    assert np.nanmin(truth["visibility"]) == 1


def test_a_convex_body_alone_receives_all_of_its_light(lab):
    """Under a sky of radiance 1, every buffer of ambient light is the albedo, and no light bounces."""
    scene = small_scenes.of(tetrahedron())
    truth = aolab.reference(scene, size=SIZE, rays=32, buffers=("ambient", "indirect"), cache=False)
    np.testing.assert_allclose(truth["ambient"][truth.mask], 1, atol=1e-3)
    assert truth["indirect"].max() == 0
    for module, options in (("ssdo", {"bounces": 1}), ("s3ho", {"indirect": True}), ("ssbn", {})):
        frame = lab.render(scene, module, size=SIZE, radius=1.0, **options)
        np.testing.assert_allclose(frame["ambient"][frame.mask], 1, atol=0.02, err_msg=module)
        if "indirect" in frame:
            assert frame["indirect"].max() < 0.01


def test_normals_of_triangles_are_drawn_where_they_differ(lab):
    flat, curved = small_scenes.box((-1, 0, -1), (1, 1, 1)), tetrahedron()
    assert "facetNormal" not in lab.render(small_scenes.of(flat), "ssao", size=SIZE)
    frame = lab.render(small_scenes.of(curved), "ssao", size=SIZE)
    facets = frame["facetNormal"][frame.mask]
    np.testing.assert_allclose(np.linalg.norm(facets, axis=1), 1, atol=2e-3)
    assert (facets * frame["viewNormal"][frame.mask]).sum(axis=1).min() > 0
    corners = curved.vertices[curved.faces].astype(float)
    known = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    known = known / np.linalg.norm(known, axis=1)[:, None] @ frame.camera.view_from_world[:3, :3].T
    assert np.abs(facets @ known.T).max(axis=1).min() > 0.999


def test_a_direction_comes_back_from_its_map(glsl):
    directions = np.random.default_rng(2).normal(size=(2000, 3))
    directions = directions[directions[:, 2] > -0.5 * np.linalg.norm(directions, axis=1)]
    rows = np.pad(directions / np.linalg.norm(directions, axis=1)[:, None], ((0, 0), (0, 1)))
    known = np.array([(0, 0, 1, 0), (1, 0, 0, 0), (0, -1, 0, 0)])
    uv = glsl("lib/azimuthal.glsl", "result.xy = azimuthalUv(x.xyz);", known)[:, :2]
    np.testing.assert_allclose(uv, [(0.5, 0.5), (0.5 + np.sqrt(1 / 8), 0.5), (0.5, 0.5 - np.sqrt(1 / 8))], atol=1e-6)
    # the texture has whole numbers up to 65535
    back = "result.xyz = azimuthalDirection(round(azimuthalUv(x.xyz) * 65535.0) / 65535.0);"
    found = glsl("lib/azimuthal.glsl", back, rows)[:, :3]
    np.testing.assert_allclose(np.linalg.norm(found, axis=1), 1, atol=1e-5)
    assert np.linalg.norm(found - rows[:, :3], axis=1).max() < 1e-4


def test_a_shader_may_sample_the_normals_of_triangles(lab):
    class Facing(aolab.SSAO):
        shader = """
        uniform sampler2D facetNormal;
        out float visibility;
        void main() { visibility = texelFetch(facetNormal, ivec2(gl_FragCoord.xy), 0).z; }
        """

    for scene in (small_scenes.of(tetrahedron()), small_scenes.of(small_scenes.box((-1, 0, -1), (1, 1, 1)))):
        for scale in (1.0, 0.5):
            frame = lab.render(scene, Facing(filter="none", scale=scale), size=SIZE)
            facets = frame["facetNormal" if scene.is_smooth else "viewNormal"]
            if scale == 1:
                np.testing.assert_array_equal(frame["visibility"][frame.mask], facets[frame.mask][:, 2])
            known = np.unique(facets[frame.mask][:, 2].round(2))
            assert np.isin(frame["visibility_raw"][np.isfinite(frame["visibility_raw"])].round(2), [0, *known]).all()


@pytest.mark.parametrize("name", ["albedo", "facetNormal", "uv"])
@pytest.mark.parametrize("scale", [1.0, 0.5])
def test_a_filter_of_ones_own_may_read_any_buffer_of_the_surfaces(lab, name, scale):
    class Own(Filter):
        name = "own"
        at_full_size = True

        def passes(self, formats):
            text = f"""
            #include "lib/sources.glsl"
            uniform sampler2D {name};
            void main() {{ results[0] = texelFetch({name}, ivec2(gl_FragCoord.xy), 0).xxxx; }}
            """
            return [over_sources("own", text, formats)]

    frame = lab.render(small_scenes.of(tetrahedron()), "ssao", size=SIZE, filter=Own(), scale=scale)
    shown = frame["visibility"][frame.mask]
    if name in frame:
        np.testing.assert_allclose(shown, frame[name][frame.mask][:, 0], atol=1e-3)
    else:
        assert (shown == 0).all()  # the body has no uv


def test_normals_of_triangles_are_made_when_they_are_read(lab):
    frame = lab.render(small_scenes.of(tetrahedron()), "ssao", size=SIZE)
    assert frame["image"].any()
    assert "facetNormal" not in frame.made
    assert not frame["facetNormal"][~frame.mask].any()
    assert "direct" not in frame.made


def test_a_mesh_is_smooth_if_its_normals_are_not_its_triangles():
    assert not small_scenes.box((0, 0, 0), (1, 1, 1)).is_smooth
    turned = trimesh.creation.box().apply_transform(trimesh.transformations.euler_matrix(0.1, 0.5, 0.8))
    assert not Mesh(turned.vertices, turned.faces).is_smooth
    assert tetrahedron().is_smooth


def test_noise_is_filtered_on_a_triangle_of_a_smooth_body(lab):
    """Neighbours lie on the triangle's plane. Across the shading normal, the filter took them for other surfaces."""
    ball = smooth(trimesh.creation.icosphere(1))
    low = float(ball.bounds[0, 1])
    floor = small_scenes.quad((-9, low, 9), (18, 0, 0), (0, 0, -18))
    camera = Camera((0, low + 0.35, 2.2), (0, low + 0.25, 0), fov=40)
    noise = {}
    for filter in ("none", "box4", "bilateral"):
        frame = lab.render(
            small_scenes.of(ball, floor), "ssao", camera=camera, size=(96, 72), radius=0.8, filter=filter
        )
        converged = lab.render(
            small_scenes.of(ball, floor), "ssao", camera=camera, size=(96, 72), radius=0.8, filter="none", accumulate=64
        )
        on_ball = np.abs(frame["facetNormal"] - frame["viewNormal"]).max(axis=2) > 0.02
        noise[filter] = float((frame["visibility"] - converged["visibility"])[on_ball].std())
    assert noise["box4"] < 0.5 * noise["none"]
    assert noise["bilateral"] < 0.4 * noise["none"]


def test_directions_under_the_triangle_are_mirrored():
    """The ways' density over the half space of the triangle is `Points.cosine` / π, and integrates to 1."""
    random = np.random.default_rng(1)
    normal, facet = np.array([[0.0, 0.0, 1.0]]), np.array([[np.sin(0.7), 0.0, np.cos(0.7)]])
    count = 200_000
    points = Points(np.zeros((count, 3)), np.repeat(normal, count, axis=0), np.repeat(facet, count, axis=0))
    u, v = random.random((2, count))
    r, azimuth = np.sqrt(u), 2 * np.pi * v
    directions = np.stack([r * np.cos(azimuth), r * np.sin(azimuth), np.sqrt(1 - u)], axis=1)
    ways = points.ways(directions)
    assert ((ways * facet).sum(axis=1) >= -1e-12).all()
    kept = (directions * facet).sum(axis=1) > 0
    np.testing.assert_array_equal(ways[kept], directions[kept])
    # by uniform samples of the half space: the density's integral, and the mean of some function of the ways
    tangent, bitangent, up = frames(facet)
    z = random.random(count)
    across = np.sqrt(1 - z * z)
    uniform = (across * np.cos(azimuth))[:, None] * tangent + (across * np.sin(azimuth))[:, None] * bitangent
    uniform = uniform + z[:, None] * up
    density = points.cosine(uniform, np.arange(count), 1.0) / np.pi
    assert (2 * np.pi * density).mean() == pytest.approx(1, abs=0.01)
    assert (2 * np.pi * density * uniform[:, 0] ** 2).mean() == pytest.approx((ways[:, 0] ** 2).mean(), abs=0.01)


def test_light_that_is_sent_to_a_smooth_body_has_two_ways_to_be_found():
    """Rays from a lamp and from the surface agree: with the lamp's rays, the mean stays, and the noise falls."""
    ball = smooth(trimesh.creation.icosphere(1))
    low = float(ball.bounds[0, 1])
    floor = small_scenes.quad((-3, low, 3), (6, 0, 0), (0, 0, -6))
    lamp = aolab.PointLight((0.9, low + 0.05, 0.9), (1.0, 1.0, 1.0))
    unlit = aolab.Environment.constant((0, 0, 0))
    scene = aolab.Scene(
        tuple(aolab.Instance(mesh) for mesh in (ball, floor)), (lamp,), unlit, Camera((2, low + 0.6, 2), (0, -0.6, 0))
    )
    frame = aolab.reference(scene, size=SIZE, rays=512, buffers="indirect", cache=False)
    by_rays = scene.replace(lights=(aolab.PointLight(lamp.position, lamp.intensity, shadow=False),))
    alone = aolab.reference(by_rays, size=SIZE, rays=2048, buffers="indirect", cache=False)
    sides = [
        one["indirect"][one.mask & (one["facetNormal"] != one["viewNormal"]).any(axis=2)] for one in (frame, alone)
    ]
    assert sides[0].mean() == pytest.approx(sides[1].mean(), rel=0.1)
