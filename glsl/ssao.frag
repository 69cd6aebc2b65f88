// SSAO over the hemisphere: the share of cosine-distributed directions in which nothing blocks within the radius.
// The hemisphere form of Filion and McNaughton 2008 (StarCraft II); here each direction is marched, so that more steps
// converge to a ray.
//
// Inputs:  viewZ, viewNormal (view space). Output: visibility in [0, 1], 1 = open; a plane gives exactly 1.

#include "lib/march.glsl"

uniform float power;

out float visibility;

void main() {
    Receiver receiver;
    visibility = 1.0;
    if (!receiverHere(receiver)) return;

    float blockedDirections = 0.0;
    for (int i = 0; i < directions; ++i) {
        blockedDirections += isWayBlocked(receiver, i) ? 1.0 : 0.0;
    }
    // (1/π) ∫ V cosθ dω, over a cosine density: the mean of V
    visibility = pow(1.0 - blockedDirections / float(directions), power);
}
