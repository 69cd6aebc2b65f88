// The surfaces of the picture in one pass: the fast form of direct.frag, ambient.frag, indirect.frag and compose.frag, which
// stores none of the terms. It is made of the same functions. sky.frag draws the background.
// Inputs: viewZ, viewNormal, albedo, emission, and those of the functions. Output: image (sRGB, 8 bits).

#include "lib/surface.glsl"
#include "direct.glsl"
#include "ambient.glsl"
#include "indirect.glsl"
#include "lib/display.glsl"

const bool has_emission;

uniform sampler2D emission;

out vec4 image;

void main() {
    Surface surface;
    surfaceHere(surface);
    vec3 total = directAt(surface) + ambientAt(surface) + indirectAt(surface);
    if (has_emission) total += texelFetch(emission, surface.pixel, 0).rgb;
    image = vec4(displayed(total), 1.0);
}
