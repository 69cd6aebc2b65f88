// One frame's share of a mean; blending adds the shares up.
// Inputs: sources (lib/sources.glsl); share, 1 / frames. Outputs: results, the sources × share.

#include "lib/sources.glsl"

uniform float share;

void main() {
    writeResults(sourcesAt(ivec2(gl_FragCoord.xy)) * share);
}
