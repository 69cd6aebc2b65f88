// Rotation and product of spherical harmonics, bands 0 to 3, by quadrature over the sphere: exact, but slow.
// NumPy twins: aolab/maths/harmonics.py.

#include "lib/sh.glsl"

// Gauss-Legendre rings of constant z, times equal steps of azimuth. The rule is exact for polynomials up to degree 9,
// the degree of a product's integral. Nodes and weights: Abramowitz & Stegun 1964, table 25.4, n = 5.
const int SH_RINGS = 5;
const int SH_AZIMUTHS = 10;
const float SH_RING_Z[5] = float[5](-0.906179845938664, -0.538469310105683, 0.0, 0.538469310105683, 0.906179845938664);
const float SH_RING_WEIGHT[5] =
    float[5](0.236926885056189, 0.478628670499366, 0.568888888888889, 0.478628670499366, 0.236926885056189);

// The i-th direction of the quadrature (xyz) and its solid angle (w).
vec4 shNode(int i) {
    int ring = i / SH_AZIMUTHS;
    float stepRad = radians(360.0) / float(SH_AZIMUTHS);
    float azimuthRad = stepRad * float(i % SH_AZIMUTHS);
    float z = SH_RING_Z[ring];
    return vec4(sqrt(1.0 - z * z) * vec2(cos(azimuthRad), sin(azimuthRad)), z, SH_RING_WEIGHT[ring] * stepRad);
}

// The coefficients of the rotated function f'(w) = f(transpose(rotation) w).
mat4 shRotate(mat4 c, mat3 rotation) {
    mat4 turned = mat4(0.0);
    for (int i = 0; i < SH_RINGS * SH_AZIMUTHS; ++i) {
        vec4 node = shNode(i);
        turned += node.w * shDot(c, shBasis(node.xyz)) * shBasis(rotation * node.xyz);
    }
    return turned;
}

// The product of two functions, truncated to 4 bands.
mat4 shProduct(mat4 a, mat4 b) {
    mat4 product = mat4(0.0);
    for (int i = 0; i < SH_RINGS * SH_AZIMUTHS; ++i) {
        vec4 node = shNode(i);
        mat4 y = shBasis(node.xyz);
        product += node.w * shDot(a, y) * shDot(b, y) * y;
    }
    return product;
}
