// Direct light: every light through its shadow map, reflected diffusely. Ambient occlusion takes no part in this.
//   L = Σ albedo/π × E_light × cosθ × shadow
// Inputs: the surface; light_share, the share of the lights' irradiance that arrives, where `shared_light`.

#include "lib/lights.glsl"
#include "lib/constants.glsl"

const bool shared_light;   // multiply by `light_share`

uniform sampler2D light_share;

vec3 directAt(Surface surface) {
    vec3 worldPos = litPosOf(surface), worldNormal = worldNormalOf(surface);
    vec3 irradiance = vec3(0.0);
    for (int i = 0; i < lights; ++i) {
        vec3 toLight;
        irradiance += irradianceFrom(i, worldPos, worldNormal, toLight);
    }
    if (shared_light) irradiance *= texelFetch(light_share, surface.pixel, 0).rgb;
    return surface.albedo / PI * irradiance;
}
