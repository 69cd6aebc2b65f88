// Real spherical harmonics, bands 0 to 3 (NumPy twin: aolab/maths/harmonics.py).
//
// Convention: the basis listed by Sloan 2008, "Stupid Spherical Harmonics (SH) Tricks", appendix A2. It is orthonormal
// and has the Condon-Shortley sign (y_1^-1 = -sqrt(3/4pi) y). Coefficient i = l (l + 1) + m belongs to band l, order m.
// Directions are unit vectors in the space in which the coefficients were projected; for an environment, world space.
// 16 coefficients are a mat4: column k, and a texel of texture `sh_k`, has the coefficients 4k .. 4k + 3.

#include "lib/constants.glsl"

// The factors of the polynomials in shBasis.
const mat4 SH_SCALE = mat4(
    0.28209479177387814,                                                // sqrt(1 / 4pi)
    -0.48860251190291992, 0.48860251190291992, -0.48860251190291992,    // sqrt(3 / 4pi)
    1.09254843059207907, -1.09254843059207907,                          // sqrt(15 / 4pi)
    0.31539156525252001,                                                // sqrt(5 / 16pi)
    -1.09254843059207907, 0.54627421529603953,                          // and sqrt(15 / 16pi)
    -0.59004358992664351, 2.89061144264055405,                          // sqrt(35 / 32pi), sqrt(105 / 4pi)
    -0.45704579946446574,                                               // sqrt(21 / 32pi)
    0.37317633259011540,                                                // sqrt(7 / 16pi)
    -0.45704579946446574, 1.44530572132027703, -0.59004358992664351     // and sqrt(105 / 16pi)
);

// sqrt(4pi / (2l + 1)): a lobe around d with the zonal coefficients z_l has c_lm = SH_ZONAL[l] z_l y_lm(d) (Sloan
// 2008).
const vec4 SH_ZONAL = sqrt(radians(720.0) / vec4(1.0, 3.0, 5.0, 7.0));

// SH_ZONAL times the zonal coefficients of the clamped cosine (Ramamoorthi & Hanrahan 2001, eq. 8).
const vec4 SH_COSINE = PI * vec4(1.0, 2.0 / 3.0, 0.25, 0.0);

// The 16 basis functions y_i at the unit vector d.
mat4 shBasis(vec3 d) {
    float xy = d.x * d.y, zz = d.z * d.z, xxyy = d.x * d.x - d.y * d.y;
    return matrixCompMult(SH_SCALE, mat4(
        1.0, d.y, d.z, d.x,
        xy, d.y * d.z, 3.0 * zz - 1.0, d.x * d.z,
        xxyy, d.y * xxyy + 2.0 * d.x * xy, d.z * xy, d.y * (5.0 * zz - 1.0),
        d.z * (5.0 * zz - 3.0), d.x * (5.0 * zz - 1.0), d.z * xxyy, d.x * xxyy - 2.0 * d.y * xy
    ));
}

// The integral of the product of two functions over the sphere.
float shDot(mat4 a, mat4 b) {
    return dot(a[0], b[0]) + dot(a[1], b[1]) + dot(a[2], b[2]) + dot(a[3], b[3]);
}

// The coefficients with band l multiplied by weights[l].
mat4 shWindow(mat4 c, vec4 weights) {
    vec4 w = weights;
    return mat4(c[0] * w.xyyy, c[1] * w.z, c[2] * w.zwww, c[3] * w.w);
}

// The lobe around the unit vector d with the zonal coefficients z.
mat4 shZonal(vec4 z, vec3 d) {
    return shWindow(shBasis(d), SH_ZONAL * z);
}

// The clamped cosine max(dot(w, d), 0), as a function of w.
mat4 shClampedCosine(vec3 d) {
    return shWindow(shBasis(d), SH_COSINE);
}

// Weights of the Hann window against ringing, `width` > 0 in bands (Sloan 2008); a smaller width is smoother.
vec4 shHanning(float width) {
    vec4 band = vec4(0.0, 1.0, 2.0, 3.0);
    return (0.5 + 0.5 * cos(PI * band / width)) * vec4(lessThan(band, vec4(width)));
}

// Zonal coefficients, for shZonal, of a light without size; `window` comes from shHanning, or is all 1. The lobe is
// scaled so that an unoccluded surface facing the light receives irradiance 1 (Sloan 2008).
vec4 shLightLobe(vec4 window) {
    vec4 lobe = window / SH_ZONAL;  // a Dirac impulse: y_l0 at the pole, sqrt((2l + 1) / 4pi)
    return lobe / dot(lobe, SH_COSINE / SH_ZONAL);
}

// The 9 basis functions of bands 0 to 2.
void shBasis9(vec3 direction, out float y[9]) {
    mat4 b = shBasis(direction);
    y = float[9](b[0].x, b[0].y, b[0].z, b[0].w, b[1].x, b[1].y, b[1].z, b[1].w, b[2].x);
}

// The irradiance of a surface with the unit normal `worldNormal`. The coefficients are already convolved with the
// clamped cosine (Ramamoorthi & Hanrahan 2001; Environment.irradiance_sh). The result is clamped: opposite a sun, three
// bands ring below 0.
vec3 shIrradiance(vec3 coefficients[9], vec3 worldNormal) {
    float y[9];
    shBasis9(worldNormal, y);
    vec3 irradiance = vec3(0.0);
    for (int i = 0; i < 9; ++i) {
        irradiance += coefficients[i] * y[i];
    }
    return max(irradiance, 0.0);
}
