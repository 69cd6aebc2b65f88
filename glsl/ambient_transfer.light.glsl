// Ambient transfer, the light: the environment's irradiance, as far as it arrives, and its reflections.
// Umenhoffer, Tóth and Szirmay-Kalos 2009, equation 2: L = a W L_a, with L_a = E(n)/π of the environment. The part a O L_a
// comes straight from the environment (ambientAt); the rest, a (W - O) L_a, comes by way of the occluders (indirectAt).
//
// Inputs: the surface; transfer_terms: rgb the denominator of W, a its numerator O.

#include "lib/sh.glsl"
#include "lib/constants.glsl"

uniform sampler2D transfer_terms;
uniform vec3 irradiance_sh[9];   // E(n) = Σ irradiance_sh[i] y_i(n)

// a L_a
vec3 openLightAt(Surface surface) {
    return surface.albedo / PI * max(shIrradiance(irradiance_sh, worldNormalOf(surface)), 0.0);
}

vec3 ambientAt(Surface surface) {
    return openLightAt(surface) * texelFetch(transfer_terms, surface.pixel, 0).a;
}

vec3 indirectAt(Surface surface) {
    vec4 terms = texelFetch(transfer_terms, surface.pixel, 0);
    vec3 transfer = terms.a > 0.0 ? terms.a / terms.rgb : vec3(0.0);   // 0/0 is 0; an albedo up to 1 gives W up to 1
    return openLightAt(surface) * (transfer - terms.a);
}
