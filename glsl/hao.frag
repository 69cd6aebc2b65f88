// HAO: ambient occlusion by rays through a grid of voxels.
// Reinbothe, Boubekeur and Alexa 2009, "Hybrid Ambient Occlusion", section 6, Eq. 2 to 4:
//   A(P, n) = Σ w(t_i, d_max) (ω_i·n) / Σ (ω_i·n),   visibility = 1 - A
// over uniform directions ω_i in a cone around n; t_i is the distance of the first set voxel, w is Wendland's kernel.
// Differences: Eq. 4 prints 1/n, with which an open hemisphere's weights would sum to 1/2; the sum of cosines is exact for a
// closed cap. The small tiling noise texture is an integer hash of the place in the world and the normal.
//
// Inputs:  viewZ, viewNormal, facets; kernel[i]: a unit direction around +z, and the offset of its first point in steps.
// Output:  visibility, in [0, 1].

#include "lib/space.glsl"
#include "lib/filter.glsl"
#include "lib/receiver.glsl"
#include "lib/facets.glsl"
#include "lib/wendland.glsl"
#include "lib/hash.glsl"
#include "occluders.glsl"

const int directions;
const int steps;
const bool lifted;               // off the surface, for occluders in pixels

uniform float radius;            // d_max, scene units
uniform float spread;            // half-angle of the cone, in right angles
uniform vec4 kernel[directions];
uniform vec4 ray_from_pixel;

out float visibility;

// The side of a cell of the noise, in radii: some pixels wide, so that a small motion of the camera finds the same cell.
const float NOISE_CELL = 0.05;

// Is the surface seen so nearly edge-on that its depth in a smaller picture may be off its plane? The smaller picture follows
// the plane from the nearest pixel's centre, which is up to half a pixel away, but by no more than MOST (pipeline/shrink.frag).
const float MOST = 0.02;

bool isEdgeOn(vec3 normal, vec3 viewPos) {
    float across = 0.5 * dot(abs(normal.xy), ray_from_pixel.xy);
    if (orthographic) return across > MOST * COT_22_5 * -ray_from_pixel.w * abs(normal.z);
    return across > MOST * abs(dot(normal, viewPos / viewPos.z));
}

// The direction with its elevation moved by `share` of the stratum that it has for itself, within the cone.
vec3 jittered(vec3 direction, float share) {
    float depth = 1.0 - cos(0.5 * PI * spread);
    float z = 1.0 - depth * fract((1.0 - direction.z) / depth + share / float(directions));
    return vec3(direction.xy * sqrt((1.0 - z * z) / max(1.0 - direction.z * direction.z, 1e-6)), z);
}

void main() {
    visibility = 1.0;
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float centreZ = texelFetch(viewZ, pixel, 0).r;
    if (isBackground(centreZ)) return;
    vec3 normal = texelFetch(viewNormal, pixel, 0).xyz;
    vec3 viewPos = viewPosAt(gl_FragCoord.xy, centreZ, ray_from_pixel);
    vec3 facet = facetAt(pixel, normal);
    float lift = lifted || isEdgeOn(facet, viewPos) ? liftOff(0.0, radius, viewPos, ray_from_pixel) : 0.0;
    Receiver receiver = receiverAt(pixel, viewPos + facet * lift, normal, facet, texel_size);

    vec3 worldPos = (world_from_view * vec4(viewPos, 1.0)).xyz;
    vec3 worldNormal = mat3(world_from_view) * normal;
    vec3 noise = hashed(ivec3(floor(worldPos / (NOISE_CELL * radius))) + 7919 * ivec3(round(3.0 * worldNormal)));
    float c = cos(2.0 * PI * noise.x), s = sin(2.0 * PI * noise.x);
    mat3 frame = frameAround(normal);
    frame = mat3(c * frame[0] + s * frame[1], c * frame[1] - s * frame[0], normal);

    float occlusion = 0.0, cosines = 0.0;
    for (int i = 0; i < directions; ++i) {
        vec3 direction = jittered(kernel[i].xyz, noise.z);
        vec3 way = wayAlong(receiver, frame * direction * radius);
        float nearest = 1.0;  // a share of the radius, where the kernel is 0
        for (int j = 0; j < steps; ++j) {
            float along = (float(j) + fract(kernel[i].w + noise.y)) / float(steps);
            Occluder occluder;
            bool hit = isBlocked(receiver, receiver.viewPos + way * along, radius, occluder);
            nearest = min(nearest, hit ? along : 1.0);
        }
        float cosine = direction.z;                          // ω_i·n
        occlusion += wendland(nearest, 1.0) * cosine;        // Eq. 2
        cosines += cosine;
    }
    visibility = 1.0 - occlusion / cosines;
}
