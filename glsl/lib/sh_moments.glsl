// Spherical harmonics of a weighted sum of directions, by moments. On the unit sphere the polynomials of bands 0 to 3
// are linear combinations of the 6 second moments Σ w d_i d_j and the 10 third moments Σ w d_i d_j d_k. Adding a
// direction to the moments costs a third of evaluating its 16 basis functions; scaling and combining is done once, at
// the end.

#include "lib/sh.glsl"

struct Moments {
    vec3 squares;   // xx yy zz
    vec3 products;  // xy yz zx
    vec3 cubes;     // xxx yyy zzz
    vec3 byNext;    // xxy yyz zzx
    vec3 byLast;    // xxz yyx zzy
    float xyz;
};

const Moments NO_MOMENTS = Moments(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), 0.0);

// Adds the unit vector `d` with its weight.
void addDirection(inout Moments m, vec3 d, float weight) {
    vec3 weighted = weight * d;
    vec3 squares = weighted * d, products = weighted * d.yzx;
    m.squares += squares;
    m.products += products;
    m.cubes += squares * d;
    m.byNext += squares * d.yzx;
    m.byLast += squares * d.zxy;
    m.xyz += products.x * d.z;
}

// Σ w y_i(d) over the added directions. The matrix lists the polynomials of shBasis in the same order.
mat4 shFromMoments(Moments m) {
    float one = m.squares.x + m.squares.y + m.squares.z;         // xx + yy + zz = 1
    vec3 d = m.cubes + m.byNext.zxy + m.byLast.yzx;              // x = xxx + xyy + xzz, and so on
    return matrixCompMult(SH_SCALE, mat4(
        one, d.y, d.z, d.x,
        m.products.x, m.products.y, 3.0 * m.squares.z - one, m.products.z,
        m.squares.x - m.squares.y, 3.0 * m.byNext.x - m.cubes.y, m.xyz, 5.0 * m.byLast.z - d.y,
        5.0 * m.cubes.z - 3.0 * d.z, 5.0 * m.byNext.z - d.x, m.byLast.x - m.byNext.y, m.cubes.x - 3.0 * m.byLast.y
    ));
}
