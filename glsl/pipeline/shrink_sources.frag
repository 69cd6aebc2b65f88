// Smaller copies of buffers: the nearest pixel's values, seen through the centre of the small pixel (shrink.frag).
// Inputs: sources (lib/sources.glsl) at full size. Outputs: results, at small size.

#include "lib/space.glsl"
#include "lib/shrink.glsl"
#include "lib/sources.glsl"

uniform vec4 ray_from_pixel;         // of the full size
uniform vec4 small_ray_from_pixel;

void main() {
    writeResults(sourcesAt(nearestLarge(gl_FragCoord.xy, textureSize(source0, 0), ray_from_pixel, small_ray_from_pixel)));
}
