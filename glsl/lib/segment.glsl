// A segment towards a light, tested for blocking on the screen.

#include "lib/receiver.glsl"
#include "occluders.glsl"

// Does nothing on the screen block the segment of length `reach` (scene units) from the receiver in the direction `viewDir`,
// unit, view space? `samples` points are tested, the first one at `offset` steps. `depth` is the thickness of surfaces
// whose back is not known, scene units.
bool isSegmentOpen(Receiver receiver, vec3 viewDir, float reach, float offset, int samples, float depth) {
    bool blocked = false;
    for (int j = 0; j < samples; ++j) {
        Occluder occluder;
        vec3 samplePos = receiver.viewPos + viewDir * (reach * (float(j) + offset) / float(samples));
        blocked = isBlocked(receiver, samplePos, depth, occluder) || blocked;
    }
    return !blocked;
}
