// SSAO over the hemisphere: the share of directions that are open within the radius.
// Filion and McNaughton 2008, "Effects & Techniques" (StarCraft II).
// Differences from the paper: directions have the density cosθ/π and count equally. Each direction is marched, so that
// more steps converge to a ray.
//
// Inputs:  viewZ (scene units, negative); viewNormal (view space, unit length).
// Output:  visibility in [0, 1], 1 = open. A plane gives exactly 1.

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
    // (1/π) ∫ V cosθ dω is the mean of V over directions with a cosine density
    visibility = pow(1.0 - blockedDirections / float(directions), power);
}
