// The picture: direct + ambient + indirect light + emission, the environment behind it, tone map, sRGB.
// Inputs: viewZ, direct, ambient, indirect, emission. Outputs: radiance (linear RGB), image (sRGB, 8 bits).

#include "lib/space.glsl"
#include "lib/environment.glsl"
#include "lib/color.glsl"

const bool has_indirect;
const bool has_emission;
const bool filmic_tone;

uniform sampler2D viewZ;
uniform sampler2D direct;
uniform sampler2D ambient;
uniform sampler2D indirect;
uniform sampler2D emission;
uniform sampler2D environment;
uniform vec4 ray_from_pixel;
uniform mat4 world_from_view;
uniform float exposure;

out vec4 radiance;
out vec4 image;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 total;
    if (isBackground(texelFetch(viewZ, pixel, 0).r)) {
        vec3 worldDir = mat3(world_from_view) * sightTo(viewPosAt(gl_FragCoord.xy, -1.0, ray_from_pixel));
        total = textureLod(environment, environmentUv(normalize(worldDir)), 0.0).rgb;
    } else {
        total = texelFetch(direct, pixel, 0).rgb + texelFetch(ambient, pixel, 0).rgb;
        if (has_indirect) total += texelFetch(indirect, pixel, 0).rgb;
        if (has_emission) total += texelFetch(emission, pixel, 0).rgb;
    }
    radiance = vec4(total, 1.0);
    vec3 exposed = total * exposure;
    image = vec4(srgbFromLinear(filmic_tone ? filmic(exposed) : clamp(exposed, 0.0, 1.0)), 1.0);
}
