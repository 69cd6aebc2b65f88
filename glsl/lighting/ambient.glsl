// Ambient light: the environment's irradiance, reflected diffusely, dimmed by visibility: L = albedo/π × E(n) × visibility.
// Inputs: the surface; visibility, where `occluded`.

#include "lib/sh.glsl"
#include "lib/constants.glsl"

const bool occluded;  // multiply by `visibility`, where that is known

uniform sampler2D visibility;
uniform vec3 irradiance_sh[9];   // E(n) = Σ irradiance_sh[i] y_i(n)

vec3 ambientAt(Surface surface) {
    vec3 irradiance = max(shIrradiance(irradiance_sh, worldNormalOf(surface)), 0.0);  // 9 coefficients can ring below 0
    float open = occluded ? texelFetch(visibility, surface.pixel, 0).r : 1.0;
    return surface.albedo / PI * irradiance * open;
}
