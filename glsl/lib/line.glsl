// The rotated kernel: samples on a line from the pixel, which the 4×4 pixels of a block turn by 16 angles.
// Chow 2014, "Reflective Shadow Maps and SSAO", "Rotating Kernel Sampling": distances x² for even x.
// The sets also shift x, so that the samples of a block lie on 16 × N rings and not on N: with the same rings for all pixels, a
// neighbour has the same error, and the mean of 4×4 pixels keeps it.

#include "lib/sampling.glsl"

struct Line {
    vec2 direction;  // unit
    float shift;     // of x, in steps of x, from 0 to 1
};

// The line of a pixel's set. `start`, of aolab/maths/sampling.py: the unit direction of set 0 (xy), and its shift (z).
Line lineOf(int set, vec3 start) {
    float angleRad = 2.0 * PI * float(set) / 16.0;
    float c = cos(angleRad), s = sin(angleRad);
    // 16 even shifts in the order of the reversed bits, so that neighbouring angles have very different ones
    int reversed = (set & 1) << 3 | (set & 2) << 1 | (set & 4) >> 1 | (set & 8) >> 3;
    return Line(mat2(c, s, -s, c) * start.xy, fract(start.z + (float(reversed) + 0.5) / 16.0));
}

// Sample `i` of `count`: its place (xy), and the share of the unit disc that it stands for (z). Turned by all angles, it
// sweeps a ring at the radius x² of the width 2 x / N: 4 x³ / N of the disc.
vec3 onLine(Line line, int i, int count) {
    float x = (float(i) + line.shift) / float(count);
    return vec3(x * x * line.direction, 4.0 * x * x * x / float(count));
}
