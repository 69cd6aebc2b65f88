// Shadow maps, filled: the share of the lights' irradiance that nothing on the screen blocks where the maps' bias left a gap.
// SSDO, Ritschel, Grosch and Seidel 2009, section 5. A pixel that its shadow map has in shadow is not tested.
//
// Inputs:  viewZ, viewNormal; the lights with their shadow maps.
// Output:  light_share: rgb Σ E_i V_i / Σ E_i over the lights' irradiances E_i; 1 where no light arrives.

#include "lib/space.glsl"
#include "lib/lights.glsl"
#include "lib/fill.glsl"

uniform vec4 ray_from_pixel;

out vec4 light_share;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float surfaceZ = texelFetch(viewZ, pixel, 0).r;
    light_share = vec4(1.0);
    if (lights == 0 || isBackground(surfaceZ)) return;

    vec3 surfacePos = viewPosAt(gl_FragCoord.xy, surfaceZ, ray_from_pixel);
    vec3 worldPos = (world_from_view * vec4(surfacePos, 1.0)).xyz;
    Receiver receiver = receiverAt(pixel, surfacePos, texelFetch(viewNormal, pixel, 0).xyz, texel_size);
    vec3 worldNormal = mat3(world_from_view) * receiver.normal;
    vec3 all = vec3(0.0), arriving = vec3(0.0);
    for (int i = 0; i < lights; ++i) {
        vec3 toLight;
        vec3 irradiance = irradianceFrom(i, worldPos, worldNormal, toLight);
        all += irradiance;
        if (irradiance == vec3(0.0)) continue;
        vec3 viewToLight = mat3(view_from_world) * toLight;
        if (isFilledOpen(receiver, tileOf(i, toLight), surfacePos, worldPos, viewToLight, distanceOf(i, worldPos), ray_from_pixel)) {
            arriving += irradiance;
        }
    }
    light_share.rgb = mix(vec3(1.0), arriving / max(all, 1e-20), vec3(greaterThan(all, vec3(0.0))));
}
