"""Embree against Möller and Trumbore, ray by ray, and what both must do."""

import sys

import numpy as np
import pytest

from aolab.errors import ParameterError
from aolab.truth.casters import NUMPY_LIMIT, EmbreeCaster, NumpyCaster, caster


def random_rays(count=3000):
    random = np.random.default_rng(7)
    triangles = (random.random((60, 1, 3)) + random.normal(0, 0.15, (60, 3, 3))).astype(np.float32)
    origins = random.uniform(-0.5, 1.5, (count, 3)).astype(np.float32)
    directions = random.normal(size=(count, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return triangles, origins, directions.astype(np.float32)


@pytest.mark.parametrize("limit", [np.inf, 0.4])
def test_embree_and_numpy_agree_ray_by_ray(limit):
    triangles, origins, directions = random_rays()
    embree, plain = (one(triangles).first_hit(origins, directions, limit) for one in (EmbreeCaster, NumpyCaster))
    hit = plain.triangle >= 0
    assert 100 < hit.sum() < len(hit) - 100
    # a ray along an edge may fall on either side in float32
    assert (embree.triangle != plain.triangle).sum() <= 2
    same = hit & (embree.triangle == plain.triangle)
    np.testing.assert_allclose(embree.distance[same], plain.distance[same], rtol=1e-4, atol=1e-5)
    np.testing.assert_allclose(embree.u[same], plain.u[same], atol=2e-3)
    np.testing.assert_allclose(embree.v[same], plain.v[same], atol=2e-3)
    assert np.isinf(embree.distance[embree.triangle < 0]).all()
    assert np.isinf(plain.distance[~hit]).all()


@pytest.mark.parametrize("kind", [EmbreeCaster, NumpyCaster])
def test_occlusion_is_a_first_hit_within_the_limit(kind):
    triangles, origins, directions = random_rays()
    one = kind(triangles)
    limits = np.random.default_rng(1).uniform(0, 1, len(origins)).astype(np.float32)
    expected = one.first_hit(origins, directions, np.inf).distance <= limits
    np.testing.assert_array_equal(one.occluded(origins, directions, limits), expected)


@pytest.mark.parametrize("kind", [EmbreeCaster, NumpyCaster])
def test_a_hit_is_where_its_barycentric_coordinates_say(kind):
    triangles, origins, directions = random_rays()
    distance, triangle, u, v = kind(triangles).first_hit(origins, directions, np.inf)
    hit = triangle >= 0
    a, b, c = np.moveaxis(triangles[triangle[hit]], 1, 0)
    u, v = u[hit, None], v[hit, None]
    reached = origins[hit] + directions[hit] * distance[hit, None]
    np.testing.assert_allclose((1 - u - v) * a + u * b + v * c, reached, atol=1e-4)


@pytest.mark.parametrize("kind", [EmbreeCaster, NumpyCaster])
def test_the_callers_limits_are_left_alone(kind):
    triangles, origins, directions = random_rays(100)
    limits = np.full(100, 10, np.float32)
    kind(triangles).first_hit(origins, directions, limits)
    kind(triangles).occluded(origins, directions, limits)
    assert (limits == 10).all()


@pytest.mark.parametrize("kind", [EmbreeCaster, NumpyCaster])
def test_no_rays_give_no_hits(kind):
    none = np.zeros((0, 3), np.float32)
    assert len(kind(random_rays()[0]).first_hit(none, none, np.inf).triangle) == 0


def test_an_unknown_engine_is_refused():
    with pytest.raises(ParameterError, match=r"engine = 'embre'.*did you mean 'embree'"):
        caster("embre", random_rays()[0])


def test_numpy_refuses_a_large_scene():
    with pytest.raises(ParameterError, match=f"up to {NUMPY_LIMIT} triangles; this one has {NUMPY_LIMIT + 1}"):
        caster("numpy", np.zeros((NUMPY_LIMIT + 1, 3, 3)))


@pytest.mark.parametrize("engine", ["auto", "embree"])
def test_without_embreex_the_error_names_the_command_and_the_slow_caster(monkeypatch, engine):
    monkeypatch.setitem(sys.modules, "embreex.mesh_construction", None)  # as if it were not installed
    with pytest.raises(ParameterError, match=r"ray tracing needs embreex: .*pip install embreex, or engine='numpy'"):
        caster(engine, random_rays()[0])
