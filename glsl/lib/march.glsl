// Marching: the directions of a pixel, each tested for blocking at a few points. All methods that march include this
// file, so that the parameters mean the same in each. Positions and vectors are in view space, lengths in scene units.
//
// kernel[i], from aolab/maths/sampling.py: xyz, a direction around +z times its reach in radii, which encodes the
//            falloff; w, the offset of its first point, in steps.

#include "lib/space.glsl"
#include "lib/receiver.glsl"
#include "lib/facets.glsl"
#include "occluders.glsl"

const int directions;
const int steps;

uniform float radius;     // scene units
uniform float bias;       // radii
uniform float thickness;  // radii
uniform vec4 kernel[directions];
uniform vec4 ray_from_pixel;

const float OPEN = 2.0;   // larger than any share of a reach

// Computes the receiver of this fragment, for points within `reach`, scene units. Returns false in the background.
bool receiverHere(out Receiver receiver, float reach) {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 uv = gl_FragCoord.xy * texel_size;
    float centreZ = texture(viewZ, uv).r;
    if (isBackground(centreZ)) return false;
    vec3 normal = texture(viewNormal, uv).xyz;
    vec3 facet = facetAt(uv, normal);
    vec3 viewPos = viewPosAt(gl_FragCoord.xy, centreZ, ray_from_pixel);
    viewPos += facet * liftOff(bias * radius, reach, viewPos, ray_from_pixel);
#ifdef RECEIVER_ON_RELIEF
    if (isOnRelief(pixel)) facet = normal;   // a relief is no solid below its polygon, but below itself
#endif
    receiver = receiverAt(pixel, viewPos, normal, facet, texel_size);
    return true;
}

// The same for points within the radius.
bool receiverHere(out Receiver receiver) {
    return receiverHere(receiver, radius);
}

// Is point `j` on direction `i` blocked? `along`: its distance as a share of the reach; `occluder`: the blocker.
bool isPointBlocked(Receiver receiver, int i, int j, out float along, out Occluder occluder) {
    vec3 way = wayAlong(receiver, receiver.frame * kernel[i].xyz * radius);
    along = (float(j) + interleavedOffset(kernel[i].w, receiver.set)) / float(steps);
    return isBlocked(receiver, receiver.viewPos + way * along, thickness * radius, occluder);
}

// Is direction `i` blocked at any of its points?
bool isWayBlocked(Receiver receiver, int i) {
    bool blocked = false;
    for (int j = 0; j < steps; ++j) {
        float along;
        Occluder occluder;
        blocked = isPointBlocked(receiver, i, j, along, occluder) || blocked;
    }
    return blocked;
}

// The distance of the first blocked point on direction `i`, as a share of its reach; OPEN if there is none. `first` is the
// occluder there, which hides the others.
float firstBlocked(Receiver receiver, int i, out Occluder first) {
    float nearest = OPEN;
    for (int j = 0; j < steps; ++j) {
        float along;
        Occluder occluder;
        bool hit = isPointBlocked(receiver, i, j, along, occluder) && along < nearest;
        if (hit) first = occluder;
        nearest = hit ? along : nearest;
    }
    return nearest;
}

// The same without the occluder.
float firstBlocked(Receiver receiver, int i) {
    Occluder first;
    return firstBlocked(receiver, i, first);
}
