"""Spherical harmonics in GLSL against their NumPy twins."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from aolab.maths import harmonics as sh

ATOL = 1e-5  # float32, for coefficients around 1
A, B = np.random.default_rng(1).normal(size=(2, 16)).astype("f4")
MATRICES = [np.eye(3), *Rotation.random(3, random_state=1).as_matrix()]


def directions(count: int = 50) -> np.ndarray:
    """(count, 4): unit vectors all around, the axes among them, and 0."""
    axes = np.concatenate([np.eye(3), -np.eye(3)])
    random = np.random.default_rng(2).normal(size=(count - 6, 3))
    random /= np.linalg.norm(random, axis=1, keepdims=True)
    return np.pad(np.concatenate([axes, random]), ((0, 0), (0, 1))).astype("f4")


@pytest.fixture
def columns(glsl):
    """(n, 16): the columns of a mat4 of `x`, with `a`, `b` and the mat3 `r` of keywords at hand."""

    def evaluate(include, matrix, x, a=A, b=B, r=MATRICES[0]):
        parts = {f"a{k}": a[4 * k : 4 * k + 4] for k in range(4)} | {f"b{k}": b[4 * k : 4 * k + 4] for k in range(4)}
        parts |= {f"r{k}": (*r[:, k], 0) for k in range(3)}
        made = "mat4 a = mat4(a0, a1, a2, a3), b = mat4(b0, b1, b2, b3); mat3 r = mat3(r0.xyz, r1.xyz, r2.xyz);"
        used = " + ".join(f"0.0 * {name}" for name in parts)  # a uniform that nothing reads is refused
        scoped = f"vec4 none = {used}; {made}"
        return np.concatenate(
            [glsl(include, f"{scoped} result = none + ({matrix})[{k}];", x, **parts) for k in range(4)], axis=1
        )

    return evaluate


def test_basis(columns):
    x = directions()
    np.testing.assert_allclose(columns("lib/sh.glsl", "shBasis(x.xyz)", x), sh.basis(x[:, :3], 4), atol=1e-6)


def test_dot(glsl):
    x = directions()
    parts = {f"a{k}": A[4 * k : 4 * k + 4] for k in range(4)}
    out = glsl("lib/sh.glsl", "result.x = shDot(mat4(a0, a1, a2, a3), shBasis(x.xyz));", x, **parts)
    np.testing.assert_allclose(out[:, 0], sh.evaluate(A, x[:, :3]), atol=ATOL)


def test_lobes_around_a_direction(columns):
    x = directions()
    zonal = np.array([0.3, -1.2, 0.7, 0.4])
    lobes = columns("lib/sh.glsl", "shZonal(vec4(0.3, -1.2, 0.7, 0.4), x.xyz)", x)
    np.testing.assert_allclose(lobes, sh.zonal_lobe(zonal, x[:, :3]), atol=ATOL)
    cosines = columns("lib/sh.glsl", "shClampedCosine(x.xyz)", x)
    np.testing.assert_allclose(cosines, sh.clamped_cosine(x[:, :3]), atol=ATOL)


def test_window(columns):
    weights = np.random.default_rng(3).normal(size=(9, 4)).astype("f4")
    np.testing.assert_allclose(columns("lib/sh.glsl", "shWindow(a, x)", weights), sh.window(A, weights), atol=ATOL)


def test_hann_window_and_light_lobe(glsl):
    widths = np.array([0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4, 6, 50])
    x = np.stack([widths, *[widths] * 3], axis=1)
    window = np.array([sh.hanning(width) for width in widths])
    np.testing.assert_allclose(glsl("lib/sh.glsl", "result = shHanning(x.x);", x), window, atol=ATOL)
    np.testing.assert_allclose(
        glsl("lib/sh.glsl", "result = shLightLobe(x);", window), sh.light_lobe(window), atol=ATOL
    )


@pytest.mark.parametrize("matrix", MATRICES)
def test_rotation(columns, matrix):
    turned = columns("lib/sh_quadrature.glsl", "shRotate(a, r)", np.zeros((1, 4)), r=matrix)[0]
    np.testing.assert_allclose(turned, sh.rotate(A, matrix), atol=ATOL)


def test_moments_hold_the_basis_of_every_direction(glsl):
    """Two directions, x and its mirror image in the plane z = y, of weights 0.7 and -0.4."""
    x = directions()
    statements = """
        Moments m = NO_MOMENTS;
        addDirection(m, x.xyz, 0.7);
        addDirection(m, x.xzy, -0.4);
        result = shFromMoments(m)[{column}];
    """
    out = np.concatenate([glsl("lib/sh_moments.glsl", statements.format(column=k), x) for k in range(4)], axis=1)
    expected = 0.7 * sh.basis(x[:, :3], 4) - 0.4 * sh.basis(x[:, [0, 2, 1]], 4)
    np.testing.assert_allclose(out, expected, atol=1e-6)


def test_product(columns):
    result = columns("lib/sh_quadrature.glsl", "shProduct(a, b)", np.zeros((1, 4)))[0]
    np.testing.assert_allclose(result, sh.product(A, B), atol=ATOL)
