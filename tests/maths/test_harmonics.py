"""Real spherical harmonics: orthonormality, Sloan's signs, exact coefficients, lobes, rotations, products, GLSL."""

from math import factorial

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.special import lpmv

from aolab.gl.source import assemble
from aolab.maths import harmonics as sh

AXES = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]], float)


def sphere_quadrature(rings: int) -> tuple[np.ndarray, np.ndarray]:
    """Directions (n, 3) and solid angles (n,), exact for polynomials up to degree 2·rings - 1, even if cut at z = 0."""
    half, weights = np.polynomial.legendre.leggauss(rings)
    z = np.concatenate([half - 1, half + 1]) / 2
    azimuth = 2 * np.pi * (np.arange(2 * rings) + 0.5) / (2 * rings)
    across = np.sqrt(1 - z**2)[:, None]
    directions = np.stack(np.broadcast_arrays(across * np.cos(azimuth), across * np.sin(azimuth), z[:, None]), -1)
    return directions.reshape(-1, 3), np.repeat(np.tile(weights, 2) / 2 * np.pi / rings, 2 * rings)


def random_directions(count: int) -> np.ndarray:
    directions = np.random.default_rng(7).normal(size=(count, 3))
    return directions / np.linalg.norm(directions, axis=1, keepdims=True)


def test_basis_is_orthonormal():
    directions, solid_angles = sphere_quadrature(8)
    y = sh.basis(directions, 4)
    np.testing.assert_allclose((y * solid_angles[:, None]).T @ y, np.eye(16), atol=1e-12)


def test_band_1_has_the_signs_of_sloan():
    k = np.sqrt(3 / (4 * np.pi))
    x, y, z = 0.48, 0.6, 0.64
    np.testing.assert_allclose(sh.basis(np.array([x, y, z]), 2)[1:], [-k * y, k * z, -k * x], rtol=1e-14)


def test_basis_equals_its_definition_by_legendre_functions():
    """√2 K P_l^|m| (cos mφ | sin |m|φ), where SciPy's P includes the Condon-Shortley sign (Sloan 2008)."""
    directions = random_directions(50)
    azimuth = np.arctan2(directions[:, 1], directions[:, 0])
    y = sh.basis(directions, 4)
    for band in range(4):
        for order in range(-band, band + 1):
            m = abs(order)
            scale = np.sqrt((2 * band + 1) / (4 * np.pi) * factorial(band - m) / factorial(band + m))
            turn = 1 if m == 0 else np.sqrt(2) * (np.cos(m * azimuth) if order > 0 else np.sin(m * azimuth))
            expected = scale * turn * lpmv(m, band, directions[:, 2])
            np.testing.assert_allclose(y[:, band * (band + 1) + order], expected, atol=1e-12)


def test_fewer_bands_are_a_prefix_of_more():
    directions = random_directions(5).reshape(5, 1, 3)
    assert sh.basis(directions, 4).shape == (5, 1, 16)
    for bands in (1, 2, 3):
        np.testing.assert_array_equal(sh.basis(directions, bands), sh.basis(directions, 4)[..., : bands**2])


@pytest.mark.parametrize("bands", [0, 5])
def test_unknown_bands_are_refused(bands):
    with pytest.raises(ValueError, match=rf"bands = {bands} is outside \[1, 4\]"):
        sh.basis(AXES, bands)


def test_clamped_cosine_has_its_exact_coefficients():
    """Around n = z only the coefficients of m = 0 are not 0: √π/2, √(π/3), √(5π)/8, 0."""
    directions, solid_angles = sphere_quadrature(8)
    lobe = np.maximum(directions[:, 2:], 0)
    coefficients = sh.project(lobe, directions, solid_angles, bands=4)[:, 0]
    expected = np.zeros(16)
    expected[[0, 2, 6]] = np.sqrt(np.pi) / 2, np.sqrt(np.pi / 3), np.sqrt(5 * np.pi) / 8
    np.testing.assert_allclose(expected[[0, 2, 6]], [0.886227, 1.023327, 0.495416], atol=5e-7)
    np.testing.assert_allclose(coefficients, expected, atol=1e-13)
    np.testing.assert_allclose(sh.clamped_cosine(np.array([0, 0, 1])), expected, atol=1e-13)


def test_irradiance_scales_each_band_by_the_cosine_coefficient():
    """A_l = √(4π / (2l + 1)) × the clamped cosine's zonal coefficient (Ramamoorthi & Hanrahan 2001, eq. 8)."""
    zonal = np.array([np.sqrt(np.pi) / 2, np.sqrt(np.pi / 3), np.sqrt(5 * np.pi) / 8, 0])
    scale = zonal * np.sqrt(4 * np.pi / (2 * np.arange(4) + 1))
    by_band = sh.irradiance(np.ones((16, 3)))
    for band in range(4):
        np.testing.assert_allclose(by_band[band**2 : (band + 1) ** 2], scale[band], atol=1e-15)


def test_project_and_evaluate_are_inverse_within_the_bands():
    directions, solid_angles = sphere_quadrature(8)
    coefficients = np.random.default_rng(1).normal(size=(16, 3))
    values = sh.evaluate(coefficients, directions)
    np.testing.assert_allclose(sh.project(values, directions, solid_angles, bands=4), coefficients, atol=1e-12)


def test_a_constant_is_projected_exactly_for_any_samples():
    solid_angles = np.full(6, 4 * np.pi / 6)
    coefficients = sh.project(np.full((6, 1), 0.7), AXES, solid_angles, bands=4)
    np.testing.assert_allclose(sh.evaluate(coefficients, random_directions(9)), 0.7, rtol=1e-14)


# --- lobes and windows


def test_a_zonal_lobe_is_its_rotated_profile():
    """Σ z_l y_l0 as a function of cosine alone, about any axis, projected by quadrature."""
    nodes, solid_angles = sphere_quadrature(8)
    zonal, axes = np.array([0.3, -1.2, 0.7, 0.4]), random_directions(6)
    lobes = sh.zonal_lobe(zonal, axes)
    assert lobes.shape == (6, 16)
    for axis, lobe in zip(axes, lobes, strict=True):
        cosine = nodes @ axis
        about_z = np.stack([np.sqrt(1 - cosine**2), 0 * cosine, cosine], axis=-1)
        profile = sh.basis(about_z, 4)[:, [0, 2, 6, 12]] @ zonal
        np.testing.assert_allclose(sh.project(profile[:, None], nodes, solid_angles, 4)[:, 0], lobe, atol=1e-12)


def test_a_lobe_for_each_direction():
    zonal = np.random.default_rng(4).normal(size=(5, 1, 4))
    lobes = sh.zonal_lobe(zonal, random_directions(3))
    assert lobes.shape == (5, 3, 16)
    np.testing.assert_allclose(lobes[2, 1], sh.zonal_lobe(zonal[2, 0], random_directions(3)[1]), rtol=1e-14)


def test_clamped_cosine_integrates_to_irradiance():
    """∫ L max(w·n, 0) dw as a product integral equals `irradiance` and `evaluate` of the same L."""
    radiance, normals = np.random.default_rng(5).normal(size=(16, 3)), random_directions(20)
    expected = sh.evaluate(sh.irradiance(radiance), normals)
    np.testing.assert_allclose(sh.clamped_cosine(normals) @ radiance, expected, atol=1e-13)


def test_clamped_cosine_is_the_projection_about_any_axis():
    rings, weights = sphere_quadrature(8)  # exact for a cut at z = 0, so the axis is rotated to z
    turn = Rotation.random(random_state=2).as_matrix()
    coefficients = sh.project(np.maximum(rings[:, 2:], 0), rings @ turn.T, weights, 4)[:, 0]
    np.testing.assert_allclose(sh.clamped_cosine(turn[:, 2]), coefficients, atol=1e-13)


@pytest.mark.parametrize(
    ("width", "expected"),
    [(4, [1, (2 + np.sqrt(2)) / 4, 1 / 2, (2 - np.sqrt(2)) / 4]), (3, [1, 3 / 4, 1 / 4, 0]), (1, [1, 0, 0, 0])],
)
def test_hann_window_at_known_widths(width, expected):
    np.testing.assert_allclose(sh.hanning(width), expected, atol=1e-15)
    np.testing.assert_array_equal(sh.hanning(width, 2), sh.hanning(width)[:2])
    assert (sh.hanning(width)[width:] == 0).all()


@pytest.mark.parametrize("width", [0, -1.5, float("nan")])
def test_a_window_without_width_is_refused(width):
    with pytest.raises(ValueError, match=f"width = {width} is not above 0"):
        sh.hanning(width)


def test_a_window_weighs_whole_bands():
    weighted = sh.window(np.ones((2, 16)), [1, 2, 3, 4])
    np.testing.assert_array_equal(weighted, [[1] + [2] * 3 + [3] * 5 + [4] * 7] * 2)
    with pytest.raises(ValueError, match="3 weights do not fit 16 coefficients"):
        sh.window(np.ones(16), [1, 2, 3])


@pytest.mark.parametrize("weights", [(1, 1, 1, 1), sh.hanning(4), sh.hanning(2.5)])
def test_a_light_lobe_gives_a_facing_surface_irradiance_1(weights):
    lobe, towards = sh.light_lobe(weights), random_directions(5)
    radiance = sh.zonal_lobe(lobe, towards)
    np.testing.assert_allclose((radiance * sh.clamped_cosine(towards)).sum(-1), 1, rtol=1e-14)
    unscaled = np.sqrt((2 * np.arange(4) + 1) / (4 * np.pi)) * weights
    np.testing.assert_allclose(lobe / lobe[0], unscaled / unscaled[0], rtol=1e-14)
    if np.all(np.asarray(weights) == 1):  # Sloan 2008 has 16π/17, for irradiance π
        np.testing.assert_allclose(lobe, unscaled * 16 / 17, rtol=1e-14)


def test_a_window_that_leaves_no_light_is_refused():
    with pytest.raises(ValueError, match=r"weights = \(0, 0, 0, 1\) leave"):
        sh.light_lobe((0, 0, 0, 1))


# --- rotation and product


def test_rotation_is_the_projection_of_the_rotated_function():
    nodes, solid_angles = sphere_quadrature(8)
    coefficients = np.random.default_rng(6).normal(size=(4, 16))
    for matrix in Rotation.random(4, random_state=6).as_matrix():
        turned = sh.evaluate(coefficients.T, nodes @ matrix)  # f'(w) = f(Rᵀw)
        expected = sh.project(turned, nodes, solid_angles, 4).T
        np.testing.assert_allclose(sh.rotate(coefficients, matrix), expected, atol=1e-12)


def test_rotation_rotates_a_lobe_with_its_axis():
    matrices, axes = Rotation.random(10, random_state=7).as_matrix(), random_directions(10)
    turned = sh.rotate(sh.clamped_cosine(axes), matrices)
    np.testing.assert_allclose(turned, sh.clamped_cosine((matrices @ axes[..., None])[..., 0]), atol=1e-13)


def test_rotation_is_orthogonal_blockwise_and_composes():
    a, b = Rotation.random(2, random_state=8).as_matrix()
    turn = sh.rotation(a)
    np.testing.assert_allclose(turn @ turn.T, np.eye(16), atol=1e-13)
    band = np.repeat(np.arange(4), [1, 3, 5, 7])
    np.testing.assert_allclose(turn[band[:, None] != band], 0, atol=1e-13)
    np.testing.assert_allclose(turn @ sh.rotation(b), sh.rotation(a @ b), atol=1e-13)
    np.testing.assert_allclose(sh.rotation(np.eye(3)), np.eye(16), atol=1e-13)


@pytest.mark.parametrize("matrix", [-np.eye(3), 1.001 * np.eye(3), np.full((3, 3), np.nan), np.zeros((3, 3))])
def test_a_matrix_that_is_not_a_rotation_is_refused(matrix):
    with pytest.raises(ValueError, match=r"matrix = \[\[.*\]\] is not a rotation"):
        sh.rotation(matrix)


def test_product_is_the_projection_of_the_pointwise_product():
    nodes, solid_angles = sphere_quadrature(8)
    a, b = np.random.default_rng(9).normal(size=(2, 5, 16))
    values = sh.evaluate(a.T, nodes) * sh.evaluate(b.T, nodes)
    np.testing.assert_allclose(sh.product(a, b), sh.project(values, nodes, solid_angles, 4).T, atol=1e-12)
    np.testing.assert_allclose(sh.product(a, b)[:, 0] * np.sqrt(4 * np.pi), (a * b).sum(-1), atol=1e-12)


# --- the GLSL twin of bands 0 to 2; tests/gl/test_sh.py has the others


SH_SHADER = """#include "lib/sh.glsl"
uniform vec3 coefficients[9];
in vec3 direction;
out vec3 irradiance;
out vec3 y012; out vec3 y345; out vec3 y678;
void main() {
    float y[9];
    shBasis9(direction, y);
    y012 = vec3(y[0], y[1], y[2]); y345 = vec3(y[3], y[4], y[5]); y678 = vec3(y[6], y[7], y[8]);
    irradiance = shIrradiance(coefficients, direction);
}
"""


def test_glsl_basis_and_irradiance_equal_numpy(gl):
    source = assemble(SH_SHADER).text
    names = ["irradiance", "y012", "y345", "y678"]
    program = gl.program(vertex_shader=source, varyings=names)
    coefficients = np.random.default_rng(3).normal(size=(9, 3)).astype("f4")
    program["coefficients"].write(coefficients.tobytes())
    directions = np.concatenate([AXES, random_directions(100)]).astype("f4")
    gl.simple_framebuffer((1, 1)).use()  # transform feedback needs a complete framebuffer, even if unused
    result = gl.buffer(reserve=len(directions) * 12 * 4)
    gl.vertex_array(program, [(gl.buffer(directions.tobytes()), "3f", "direction")]).transform(result, mode=gl.POINTS)
    out = np.frombuffer(result.read(), "f4").reshape(-1, 12)
    np.testing.assert_allclose(out[:, 3:], sh.basis(directions, 3), atol=1e-6)
    expected = sh.evaluate(coefficients, directions)
    assert (expected < 0).any()
    np.testing.assert_allclose(out[:, :3], np.maximum(expected, 0), atol=1e-5)
