// SSAO over the hemisphere: the share of cosine-distributed directions in which nothing blocks within the radius.
// The hemisphere form of Filion and McNaughton 2008 (StarCraft II); here each direction is marched, so that more steps
// converge to a ray.
//
// Inputs:  viewZ, viewNormal (view space). Output: visibility in [0, 1], 1 = open; a plane gives exactly 1.
// kernel[i]: xyz a direction around +z times its reach in radii (see aolab/kernels.py: the falloff is in there),
//            w its first sample's offset, in steps.

#include "lib/space.glsl"
#include "lib/sampling.glsl"
#include "occluders.glsl"

const int directions;
const int steps;

uniform float radius;     // scene units
uniform float bias;       // radii
uniform float thickness;  // radii
uniform float power;
uniform vec4 kernel[directions];
uniform vec4 ray_from_pixel;

out float visibility;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float centreZ = texelFetch(viewZ, pixel, 0).r;
    visibility = 1.0;
    if (isBackground(centreZ)) return;

    vec3 normal = texelFetch(viewNormal, pixel, 0).xyz;
    vec3 viewPos = viewPosAt(gl_FragCoord.xy, centreZ, ray_from_pixel);
    viewPos += normal * liftOff(bias * radius, radius, viewPos, ray_from_pixel);
    int set = interleavedSet(pixel);
    mat3 frame = interleavedFrame(normal, set) * radius;

    float blockedDirections = 0.0;
    for (int i = 0; i < directions; ++i) {
        vec3 way = frame * kernel[i].xyz;
        float offset = interleavedOffset(kernel[i].w, set);
        bool blocked = false;
        for (int j = 0; j < steps; ++j) {
            Occluder occluder;
            vec3 samplePos = viewPos + way * ((float(j) + offset) / float(steps));
            blocked = isBlocked(samplePos, thickness * radius, occluder) || blocked;
        }
        blockedDirections += blocked ? 1.0 : 0.0;
    }
    // (1/π) ∫ V cosθ dω, over a cosine density: the mean of V
    visibility = pow(1.0 - blockedDirections / float(directions), power);
}
