// The picture in one pass: the fast form of direct.frag, ambient.frag, indirect.frag and compose.frag, which stores none of
// the terms. It is made of the same functions.
// Inputs: viewZ, viewNormal, albedo, emission, and those of the functions. Output: image (sRGB, 8 bits).

#include "lib/surface.glsl"
#include "direct.glsl"
#include "ambient.glsl"
#include "indirect.glsl"
#include "lib/background.glsl"
#include "lib/display.glsl"

const bool has_emission;

uniform sampler2D emission;

out vec4 image;

void main() {
    Surface surface;
    vec3 total;
    if (surfaceHere(surface)) {
        total = directAt(surface) + ambientAt(surface) + indirectAt(surface);
        if (has_emission) total += texelFetch(emission, surface.pixel, 0).rgb;
    } else {
        total = backgroundAt(gl_FragCoord.xy, ray_from_pixel, world_from_view);
    }
    image = vec4(displayed(total), 1.0);
}
