// S3HO, the lights: each a lobe around its direction at P, windowed, in the coefficients that the occlusion has.
// Herholz et al. 2012, Eq. 3 and 4: E(P) = Σ c_l(P) · c(P).
// A lobe's coefficients are its zonal ones times y_i(d): so c_l · c is the windowed transfer's value towards the light.
// Besides, lights pass their shadow maps, as in pipeline/direct.frag; the paper has none.
// Inputs: viewZ, viewNormal, albedo, occlusion0 to occlusion3; light_share, where `shared_light`. Output: direct, linear RGB radiance: albedo/π × E.

#include "lib/space.glsl"
#include "lib/lights.glsl"
#include "s3ho.transfer.glsl"
#include "lib/constants.glsl"

const bool shared_light;     // multiply by `light_share`

uniform sampler2D viewZ;
uniform sampler2D viewNormal;
uniform sampler2D albedo;
uniform sampler2D light_share;
uniform float light_window;  // bands
uniform vec4 ray_from_pixel;
uniform mat4 view_from_world;
uniform mat4 world_from_view;

out vec4 direct;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float surfaceZ = texelFetch(viewZ, pixel, 0).r;
    direct = vec4(0.0);
    if (lights == 0 || isBackground(surfaceZ)) return;

    vec3 normal = texelFetch(viewNormal, pixel, 0).xyz;
    vec3 viewPos = litPoint(viewPosAt(gl_FragCoord.xy, surfaceZ, ray_from_pixel), normal, ray_from_pixel);
    vec3 worldPos = (world_from_view * vec4(viewPos, 1.0)).xyz;
    mat4 windowed = shWindow(transferAt(pixel, normal), SH_ZONAL * shLightLobe(shHanning(light_window)));
    vec3 irradiance = vec3(0.0);
    for (int i = 0; i < lights; ++i) {
        float arriving;
        vec3 toLight = towardsLightAt(i, worldPos, arriving);
        vec3 viewToLight = mat3(view_from_world) * toLight;
        arriving *= lobesShadowOf(i, worldPos, toLight, dot(normal, viewToLight));
        irradiance += light_color[i] * arriving * max(shDot(shBasis(viewToLight), windowed), 0.0);
    }
    if (shared_light) irradiance *= texelFetch(light_share, pixel, 0).rgb;
    direct = vec4(texelFetch(albedo, pixel, 0).rgb / PI * irradiance, 1.0);
}
