// Real spherical harmonics, bands 0 to 3 (the NumPy twin is aolab/maths/harmonics.py).
//
// Convention: the basis listed by Sloan 2008, "Stupid Spherical Harmonics (SH) Tricks", appendix A2: orthonormal, with
// the Condon-Shortley sign (y_1^-1 = -sqrt(3/4pi) y). Coefficient i = l (l + 1) + m holds band l, order m. Directions
// are unit vectors in whatever space the coefficients were projected in; those of an environment are in world space.
// 16 coefficients are a mat4: column k holds coefficients 4k .. 4k + 3, as the texel of a texture `sh_k` does.

// The factors of the polynomials that shBasis lists.
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

// A lobe around d with the zonal coefficients z_l has c_lm = sqrt(4pi / (2l + 1)) z_l y_lm(d) (Sloan 2008): the roots.
const vec4 SH_ZONAL = sqrt(radians(720.0) / vec4(1.0, 3.0, 5.0, 7.0));

// SH_ZONAL times the zonal coefficients of the clamped cosine (Ramamoorthi & Hanrahan 2001, eq. 8).
const vec4 SH_COSINE = radians(180.0) * vec4(1.0, 2.0 / 3.0, 0.25, 0.0);

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

// Band l times weights[l].
mat4 shWindow(mat4 c, vec4 weights) {
    vec4 w = weights;
    return mat4(c[0] * w.xyyy, c[1] * w.z, c[2] * w.zwww, c[3] * w.w);
}

// The lobe with the zonal coefficients z around d.
mat4 shZonal(vec4 z, vec3 d) {
    return shWindow(shBasis(d), SH_ZONAL * z);
}

// max(dot(w, d), 0) as a function of the direction w.
mat4 shClampedCosine(vec3 d) {
    return shWindow(shBasis(d), SH_COSINE);
}

// The Hann window against ringing, `width` > 0 bands wide (Sloan 2008); the smaller, the smoother.
vec4 shHanning(float width) {
    vec4 band = vec4(0.0, 1.0, 2.0, 3.0);
    return (0.5 + 0.5 * cos(radians(180.0) * band / width)) * vec4(lessThan(band, vec4(width)));
}

// Zonal coefficients, for shZonal, of a light without size, windowed; `window` is of shHanning, or all 1. Scaled so
// that an open surface that faces the light receives irradiance 1 (Sloan 2008).
vec4 shLightLobe(vec4 window) {
    vec4 lobe = window / SH_ZONAL;  // of a Dirac impulse: y_l0 at the pole, sqrt((2l + 1) / 4pi)
    return lobe / dot(lobe, SH_COSINE / SH_ZONAL);
}

// The 9 coefficients of bands 0 to 2.
void shBasis9(vec3 direction, out float y[9]) {
    mat4 b = shBasis(direction);
    y = float[9](b[0].x, b[0].y, b[0].z, b[0].w, b[1].x, b[1].y, b[1].z, b[1].w, b[2].x);
}

// Irradiance on a surface with unit normal `worldNormal`, from coefficients that are already convolved with the clamped
// cosine (Ramamoorthi & Hanrahan 2001; Environment.irradiance_sh). Clamped: three bands ring below 0 opposite a sun.
vec3 shIrradiance(vec3 coefficients[9], vec3 worldNormal) {
    float y[9];
    shBasis9(worldNormal, y);
    vec3 irradiance = vec3(0.0);
    for (int i = 0; i < 9; ++i) {
        irradiance += coefficients[i] * y[i];
    }
    return max(irradiance, 0.0);
}
