// S3HO, the environment's light: the product integral of light and occlusion is the dot product of their coefficients.
// Herholz et al. 2012, Eq. 3: E(P) = c_env · c(P).
// Inputs: viewNormal, albedo, occlusion0 to occlusion3. Output: ambient, linear RGB radiance: albedo/π × E.

#include "s3ho.transfer.glsl"
#include "lib/constants.glsl"

uniform sampler2D viewNormal;
uniform sampler2D albedo;
uniform mat4 view_environment_sh[3];  // of red, green and blue

out vec4 ambient;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 surfaceAlbedo = texelFetch(albedo, pixel, 0);
    ambient = vec4(0.0);
    if (surfaceAlbedo.a == 0.0) return;  // background

    mat4 transfer = transferAt(pixel, texelFetch(viewNormal, pixel, 0).xyz);
    vec3 irradiance;
    for (int i = 0; i < 3; ++i) irradiance[i] = shDot(view_environment_sh[i], transfer);
    irradiance = max(irradiance, 0.0);  // four bands can ring below 0
    ambient = vec4(surfaceAlbedo.rgb / PI * irradiance, 1.0);
}
