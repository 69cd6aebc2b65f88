// The receiver: the surface point that is shaded. View space, scene units.

#include "lib/sampling.glsl"

struct Receiver {
    vec3 viewPos;   // lifted off its surface
    vec3 normal;    // unit
    vec3 facet;     // the triangle's normal, unit
    mat3 frame;     // turns a kernel around +z to the normal, by the angle of the pixel's set
    int set;        // the pixel's set of samples, 0 to 15
    ivec2 pixel;
    vec2 uv;        // the pixel's centre
};

// `viewPos` is lifted off already; `texelSize` is 1 / resolution.
Receiver receiverAt(ivec2 pixel, vec3 viewPos, vec3 normal, vec3 facet, vec2 texelSize) {
    int set = interleavedSet(pixel);
    return Receiver(viewPos, normal, facet, interleavedFrame(normal, set), set, pixel, (vec2(pixel) + 0.5) * texelSize);
}

// On a flat surface, whose normal is that of the triangle.
Receiver receiverAt(ivec2 pixel, vec3 viewPos, vec3 normal, vec2 texelSize) {
    return receiverAt(pixel, viewPos, normal, normal, texelSize);
}

// The way on which direction `dir` is tested for blocking. Around a shading normal, a few directions lead under the
// triangle, into the solid: these are mirrored at the triangle's plane, so that a convex solid does not occlude itself.
vec3 wayAlong(Receiver receiver, vec3 dir) {
    return dir - receiver.facet * min(2.0 * dot(dir, receiver.facet), 0.0);
}
