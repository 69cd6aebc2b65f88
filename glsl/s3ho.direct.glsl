// S3HO, the lights: each a lobe around its direction at P, windowed, in the coefficients that the occlusion has.
// Herholz et al. 2012, Eq. 3 and 4: E(P) = Σ c_l(P) · c(P).
// A lobe's coefficients are its zonal ones times y_i(d): so c_l · c is the windowed transfer's value towards the light.
// Besides, lights pass their shadow maps, as in lighting/direct.glsl; the paper has none. L = albedo/π × E.
// Inputs: the surface; occlusion0 to occlusion3; light_share, where `shared_light`.

#include "lib/lights.glsl"
#include "s3ho.transfer.glsl"
#include "lib/constants.glsl"

const bool shared_light;     // multiply by `light_share`
const float light_window;    // bands; the compiler computes the window

uniform sampler2D light_share;

vec3 directAt(Surface surface) {
    if (lights == 0) return vec3(0.0);

    vec3 worldPos = litPosOf(surface), normal = surface.viewNormal;
    mat4 windowed = shWindow(transferOf(surface), SH_ZONAL * shLightLobe(shHanning(light_window)));
    vec3 irradiance = vec3(0.0);
    for (int i = 0; i < lights; ++i) {
        float arriving;
        vec3 toLight = towardsLightAt(i, worldPos, arriving);
        vec3 viewToLight = toLight * mat3(world_from_view);  // by the inverse, which is the transpose
        arriving *= lobesShadowOf(i, worldPos, toLight, dot(normal, viewToLight));
        irradiance += light_color[i] * arriving * max(shDot(shBasis(viewToLight), windowed), 0.0);
    }
    if (shared_light) irradiance *= texelFetch(light_share, surface.pixel, 0).rgb;
    return surface.albedo / PI * irradiance;
}
