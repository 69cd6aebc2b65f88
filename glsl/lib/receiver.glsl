// The receiver: the surface point that is shaded. View space, scene units.

#include "lib/sampling.glsl"

struct Receiver {
    vec3 viewPos;   // lifted off its surface
    vec3 normal;    // unit
    mat3 frame;     // turns a kernel around +z to the normal, by the angle of the pixel's set
    int set;        // the pixel's set of samples, 0 to 15
    ivec2 pixel;
    vec2 uv;        // the pixel's centre
};

// `viewPos` is lifted off already; `texelSize` is 1 / resolution.
Receiver receiverAt(ivec2 pixel, vec3 viewPos, vec3 normal, vec2 texelSize) {
    int set = interleavedSet(pixel);
    return Receiver(viewPos, normal, interleavedFrame(normal, set), set, pixel, (vec2(pixel) + 0.5) * texelSize);
}
