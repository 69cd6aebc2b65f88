// Direct light: every light through its shadow map, reflected diffusely. Ambient occlusion takes no part in this.
// Inputs: viewZ, viewNormal, albedo; light_share, the share of the lights' irradiance that arrives, where `shared`.
// Output: direct, linear RGB radiance: Σ albedo/π × E_light × cosθ × shadow.

#include "lib/space.glsl"
#include "lib/lights.glsl"
#include "lib/constants.glsl"

const bool shared_light;   // multiply by `light_share`

uniform sampler2D viewZ;
uniform sampler2D viewNormal;
uniform sampler2D albedo;
uniform sampler2D light_share;
uniform vec4 ray_from_pixel;
uniform mat4 world_from_view;

out vec4 direct;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float surfaceZ = texelFetch(viewZ, pixel, 0).r;
    direct = vec4(0.0);
    if (lights == 0 || isBackground(surfaceZ)) return;

    vec3 normal = texelFetch(viewNormal, pixel, 0).xyz, worldNormal = mat3(world_from_view) * normal;
    vec3 viewPos = litPoint(viewPosAt(gl_FragCoord.xy, surfaceZ, ray_from_pixel), normal, ray_from_pixel);
    vec3 worldPos = (world_from_view * vec4(viewPos, 1.0)).xyz;
    vec3 irradiance = vec3(0.0);
    for (int i = 0; i < lights; ++i) {
        vec3 toLight;
        irradiance += irradianceFrom(i, worldPos, worldNormal, toLight);
    }
    if (shared_light) irradiance *= texelFetch(light_share, pixel, 0).rgb;
    direct = vec4(texelFetch(albedo, pixel, 0).rgb / PI * irradiance, 1.0);
}
