// The gap that the bias of a shadow map leaves above a surface, filled in image space (SSDO, Ritschel et al. 2009,
// section 5, "Screen Space Shadow Correction"): samples on the segment P .. P + b l, each with the test of the occluders.

#include "lib/shadow_tiles.glsl"
#include "lib/segment.glsl"

const int fill;             // samples on the segment; with 0, the shadow map alone decides

// Depth that is taken to be solid behind a surface, in lengths of the segment. Of 0.12, 0.25, 0.5, 1, 2, 4 and 100, the lengths
// 0.25 and 0.5 had the least error against rays on `coins` (sun, point and environment; maps of 128 to 1024); with more, near
// things shade the surfaces behind them.
const float FILL_THICKNESS = 0.5;

// Does nothing on the screen block the segment that the bias of shadow tile `tile` leaves out? `surfacePos` is the
// receiver on its surface in view space, `worldPos` the same in world space; `viewToLight`: unit, `away`: its distance.
bool isFilledOpen(Receiver receiver, int tile, vec3 surfacePos, vec3 worldPos, vec3 viewToLight, float away,
                  vec4 rayFromPixel) {
    if (fill == 0 || tile < 0) return true;
    float reach = min(tileBias(tile, worldPos, dot(receiver.normal, viewToLight)), away);
    receiver.viewPos = surfacePos + receiver.normal * liftOff(0.0, reach, surfacePos, rayFromPixel);
    return isSegmentOpen(receiver, viewToLight, reach, 0.5, fill, FILL_THICKNESS * reach);
}
