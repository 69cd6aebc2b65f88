// SSDO, the environment's light, reflected: from the sums of ssdo.frag to radiance.
//   plain:    L(P) = ρ Σ V L_in / N, the paper's sum.
//   blocked:  L(P) = ρ/π E_open(n) (1 - Σ (1 - V) L_in / Σ L_in): the exact irradiance of an open surface, less the share
//             that the blocked directions hold. Its mean is that of the plain sum, but for the blur of L_in, which
//             cancels. It has no noise where all is open or all is blocked, and is never negative.
//
// Inputs:  the surface; open_light; if `blocked`, all_light and open_irradiance, E_open/π by the normal.

#include "lib/environment.glsl"

const bool blocked;

uniform sampler2D open_light;
uniform sampler2D all_light;
uniform sampler2D open_irradiance;

vec3 ambientAt(Surface surface) {
    vec4 open = texelFetch(open_light, surface.pixel, 0);
    vec3 arriving = open.rgb;  // irradiance / π
    if (blocked) {
        vec3 all = texelFetch(all_light, surface.pixel, 0).rgb;
        // a colour that no direction met has no share: the visibility stands in
        vec3 openShare = mix(vec3(open.a), open.rgb / max(all, 1e-30), greaterThan(all, vec3(0.0)));
        vec2 uv = irradianceUv(worldNormalOf(surface), textureSize(open_irradiance, 0));
        arriving = openShare * texture(open_irradiance, uv).rgb;
    }
    return surface.albedo * arriving;
}
