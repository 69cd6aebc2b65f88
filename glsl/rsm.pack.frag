// A reflective shadow map, packed for gathering: four words a pixel light (lib/pixel_light.glsl).
// Inputs: rsm_position, rsm_normal, rsm_flux (rsm.map.frag).
// Output: rsm_packed.

#include "lib/pixel_light.glsl"

uniform sampler2D rsm_position;
uniform sampler2D rsm_normal;
uniform sampler2D rsm_flux;
uniform vec4 rsm_box;

out uvec4 rsm_packed;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec4 position = texelFetch(rsm_position, texel, 0);
    vec3 normal = texelFetch(rsm_normal, texel, 0).xyz;
    rsm_packed = wordsOf(PixelLight(position.xyz, position.w, normal, texelFetch(rsm_flux, texel, 0).rgb), rsm_box);
}
