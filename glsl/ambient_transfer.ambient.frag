// Ambient transfer, the light: the environment's irradiance, as far as it arrives, and its reflections.
// Umenhoffer, Tóth and Szirmay-Kalos 2009, equation 2: L = a W L_a, with L_a = E(n)/π of the environment. The part a O L_a
// comes straight from the environment; the rest, a (W - O) L_a, comes by way of the occluders.
//
// Inputs:  viewNormal, albedo; transfer_terms: rgb the denominator of W, a its numerator O.
// Outputs: ambient, indirect: linear RGB radiance.

#include "lib/sh.glsl"
#include "lib/constants.glsl"

uniform sampler2D viewNormal;
uniform sampler2D albedo;
uniform sampler2D transfer_terms;
uniform mat4 world_from_view;
uniform vec3 irradiance_sh[9];   // E(n) = Σ irradiance_sh[i] y_i(n)

out vec4 ambient;
out vec4 indirect;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 surfaceAlbedo = texelFetch(albedo, pixel, 0);
    ambient = vec4(0.0);
    indirect = vec4(0.0);
    if (surfaceAlbedo.a == 0.0) return;  // background

    vec4 terms = texelFetch(transfer_terms, pixel, 0);
    vec3 worldNormal = mat3(world_from_view) * texelFetch(viewNormal, pixel, 0).xyz;
    vec3 light = surfaceAlbedo.rgb / PI * max(shIrradiance(irradiance_sh, worldNormal), 0.0);
    vec3 transfer = terms.a > 0.0 ? terms.a / terms.rgb : vec3(0.0);   // 0/0 is 0; an albedo up to 1 gives W up to 1
    ambient = vec4(light * terms.a, 1.0);
    indirect = vec4(light * (transfer - terms.a), 1.0);
}
