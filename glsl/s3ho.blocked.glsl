// How far a direction is blocked, in S3HO: 1 - V. Herholz et al. 2012, section 2.1: for a smooth effect a blocked direction
// may have V = 1 - 1 / (1 + λ d), which grows with the distance d; λ = 0 blocks it wholly.

#include "lib/march.glsl"

const bool fading;       // strength > 0

uniform float strength;  // λ, 1 / radii

float blockedShare(Receiver receiver, int i) {
    if (!fading) return isWayBlocked(receiver, i) ? 1.0 : 0.0;
    float first = firstBlocked(receiver, i);
    return first < OPEN ? 1.0 / (1.0 + strength * first * length(kernel[i].xyz)) : 0.0;
}
