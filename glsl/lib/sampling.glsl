// Interleaved sampling: the frame of a normal, and one of 16 sample sets for each pixel of a 4×4 block.

#include "lib/constants.glsl"

// An orthonormal frame around the unit vector `n`, as columns (tangent, bitangent, n).
// Duff et al. 2017, "Building an Orthonormal Basis, Revisited": no singular direction.
mat3 frameAround(vec3 n) {
    float s = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (s + n.z);
    float b = n.x * n.y * a;
    return mat3(1.0 + s * n.x * n.x * a, s * b, -s * n.x, b, s + n.y * n.y * a, -n.y, n);
}

// The index, 0..15, of a pixel's sample set; each 4×4 block of pixels has every set once (SSDO, Ritschel et al. 2009,
// section 3: M = 4×4). The order is a Bayer matrix, so that the sets of neighbouring pixels differ most.
int interleavedSet(ivec2 pixel) {
    ivec2 low = pixel & 1;
    ivec2 high = (pixel >> 1) & 1;
    return 4 * (2 * (low.x ^ low.y) + low.y) + 2 * (high.x ^ high.y) + high.y;
}

// The frame around `n`, rotated by the angle of this set: 16 pixels use the same kernel at 16 angles (Umenhoffer et al.
// 2009, section 4.2).
mat3 interleavedFrame(vec3 n, int set) {
    float angleRad = 2.0 * PI * float(set) / 16.0;
    mat3 frame = frameAround(n);
    float c = cos(angleRad), s = sin(angleRad);
    return mat3(c * frame[0] + s * frame[1], c * frame[1] - s * frame[0], n);
}

// The offset of a direction's first point in this set, as a fraction of one step; `offset` is the kernel's.
float interleavedOffset(float offset, int set) {
    return fract(offset + float(set) / 16.0);
}
