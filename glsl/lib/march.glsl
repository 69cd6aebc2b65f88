// What a pixel looks into: its directions, each marched in a few points until something blocks. The parameters that
// methods share have their one meaning here. Positions and vectors are in view space, lengths in scene units.
//
// kernel[i]: xyz a direction around +z times its reach in radii (aolab/maths/sampling.py: the falloff is in there),
//            w its first point's offset, in steps.

#include "lib/space.glsl"
#include "lib/sampling.glsl"
#include "occluders.glsl"

const int directions;
const int steps;

uniform float radius;     // scene units
uniform float bias;       // radii
uniform float thickness;  // radii
uniform vec4 kernel[directions];
uniform vec4 ray_from_pixel;

const float OPEN = 2.0;   // no distance along a way is as large

// The surface point of a pixel, lifted off; `frame` turns the kernel around its normal.
struct Receiver {
    vec3 viewPos;
    vec3 normal;
    mat3 frame;
    int set;
};

// The receiver of this fragment; false where it is background.
bool receiverHere(out Receiver receiver) {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float centreZ = texelFetch(viewZ, pixel, 0).r;
    if (isBackground(centreZ)) return false;
    receiver.normal = texelFetch(viewNormal, pixel, 0).xyz;
    receiver.viewPos = viewPosAt(gl_FragCoord.xy, centreZ, ray_from_pixel);
    receiver.viewPos += receiver.normal * liftOff(bias * radius, radius, receiver.viewPos, ray_from_pixel);
    receiver.set = interleavedSet(pixel);
    receiver.frame = interleavedFrame(receiver.normal, receiver.set);
    return true;
}

// The point `j` on direction `i`, `along` as a share of its reach; and whether something blocks it, and what.
bool isPointBlocked(Receiver receiver, int i, int j, out float along, out Occluder occluder) {
    vec3 way = receiver.frame * kernel[i].xyz * radius;
    along = (float(j) + interleavedOffset(kernel[i].w, receiver.set)) / float(steps);
    return isBlocked(receiver.viewPos + way * along, thickness * radius, occluder);
}

// Does anything block direction `i`?
bool isWayBlocked(Receiver receiver, int i) {
    bool blocked = false;
    for (int j = 0; j < steps; ++j) {
        float along;
        Occluder occluder;
        blocked = isPointBlocked(receiver, i, j, along, occluder) || blocked;
    }
    return blocked;
}

// The same, and what it is that blocks first: it hides the others.
bool isWayBlocked(Receiver receiver, int i, out Occluder first) {
    bool blocked = false;
    for (int j = 0; j < steps; ++j) {
        float along;
        Occluder occluder;
        bool hit = isPointBlocked(receiver, i, j, along, occluder);
        if (hit && !blocked) first = occluder;
        blocked = blocked || hit;
    }
    return blocked;
}

// Where the first blocked point lies on direction `i`, as a share of its reach, or OPEN.
float firstBlocked(Receiver receiver, int i) {
    float first = OPEN;
    for (int j = 0; j < steps; ++j) {
        float along;
        Occluder occluder;
        first = min(first, isPointBlocked(receiver, i, j, along, occluder) ? along : OPEN);
    }
    return first;
}
