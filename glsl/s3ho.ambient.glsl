// S3HO, the environment's light: the product integral of light and occlusion is the dot product of their coefficients.
// Herholz et al. 2012, Eq. 3: E(P) = c_env · c(P).
// L = albedo/π × E. Inputs: the surface; occlusion0 to occlusion3.

#include "s3ho.transfer.glsl"
#include "lib/constants.glsl"

uniform mat4 view_environment_sh[3];  // of red, green and blue

vec3 ambientAt(Surface surface) {
    mat4 transfer = transferOf(surface);
    vec3 irradiance;
    for (int i = 0; i < 3; ++i) irradiance[i] = shDot(view_environment_sh[i], transfer);
    irradiance = max(irradiance, 0.0);  // four bands can ring below 0
    return surface.albedo / PI * irradiance;
}
