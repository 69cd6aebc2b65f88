// How far a direction is blocked in S3HO, 1 - V. Herholz et al. 2012, section 2.1: for a smooth effect, an occluder at
// distance d leaves V = 1 - 1/(1 + λ d), which increases with d. For λ = 0 an occluder blocks its direction wholly.

#include "lib/march.glsl"

const bool fading;       // strength > 0

uniform float strength;  // λ, 1 / radii

// The blocked share of direction `i`, in [0, 1], and its first occluder if that share is above 0.
float blockedShare(Receiver receiver, int i, out Occluder first) {
    float distance = firstBlocked(receiver, i, first);  // a share of the reach
    if (distance == OPEN) return 0.0;
    return fading ? 1.0 / (1.0 + strength * distance * length(kernel[i].xyz)) : 1.0;
}

// The blocked share of direction `i`, in [0, 1].
float blockedShare(Receiver receiver, int i) {
    if (!fading) return isWayBlocked(receiver, i) ? 1.0 : 0.0;
    Occluder first;
    return blockedShare(receiver, i, first);
}
