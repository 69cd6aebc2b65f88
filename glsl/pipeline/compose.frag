// The picture: direct + ambient + indirect light + emission, the environment behind it, tone map, sRGB.
// Inputs: viewZ, direct, ambient, indirect, emission. Outputs: radiance (linear RGB), image (sRGB, 8 bits).
// This is the plain form, from stored terms; image.frag is the fast one.

#include "lib/background.glsl"
#include "lib/display.glsl"

const bool has_indirect;
const bool has_emission;

uniform sampler2D viewZ;
uniform sampler2D direct;
uniform sampler2D ambient;
uniform sampler2D indirect;
uniform sampler2D emission;
uniform vec4 ray_from_pixel;
uniform mat4 world_from_view;

out vec4 radiance;
out vec4 image;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 total;
    if (isBackground(texelFetch(viewZ, pixel, 0).r)) {
        total = backgroundAt(gl_FragCoord.xy, ray_from_pixel, world_from_view);
    } else {
        total = texelFetch(direct, pixel, 0).rgb + texelFetch(ambient, pixel, 0).rgb;
        if (has_indirect) total += texelFetch(indirect, pixel, 0).rgb;
        if (has_emission) total += texelFetch(emission, pixel, 0).rgb;
    }
    radiance = vec4(total, 1.0);
    image = vec4(displayed(total), 1.0);
}
