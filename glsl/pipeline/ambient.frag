// Ambient light: the environment's irradiance, reflected diffusely, dimmed by visibility.
// Inputs: viewNormal, albedo, visibility. Output: ambient, linear RGB radiance: albedo/π × E(n) × visibility.

#include "lib/sh.glsl"
#include "lib/constants.glsl"

const bool occluded;  // multiply by `visibility`, where that is known

uniform sampler2D viewNormal;
uniform sampler2D albedo;
uniform sampler2D visibility;
uniform mat4 world_from_view;
uniform vec3 irradiance_sh[9];   // E(n) = Σ irradiance_sh[i] y_i(n)

out vec4 ambient;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 surfaceAlbedo = texelFetch(albedo, pixel, 0);
    ambient = vec4(0.0);
    if (surfaceAlbedo.a == 0.0) return;  // background

    vec3 worldNormal = mat3(world_from_view) * texelFetch(viewNormal, pixel, 0).xyz;
    vec3 irradiance = max(shIrradiance(irradiance_sh, worldNormal), 0.0);  // 9 coefficients can ring below 0
    float open = occluded ? texelFetch(visibility, pixel, 0).r : 1.0;
    ambient = vec4(surfaceAlbedo.rgb / PI * irradiance * open, 1.0);
}
