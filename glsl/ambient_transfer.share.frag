// Ambient transfer: the light that a surface reflects, in units of the ambient light, to stand for its albedo.
// Umenhoffer, Tóth and Szirmay-Kalos 2009, section 4.1: "replace the albedo in this formula by the radiance stored in the
// pixel". Without lamps this is the albedo itself. A share above 1 would let W grow without end, and is cut at 1.
//
// Inputs:  viewNormal, albedo; direct: the light of the lamps that the surface reflects, radiance.
// Output:  reflected_share: rgb (a L_a + direct) / L_a in [0, 1], with L_a = E(n)/π of the environment.

#include "lib/sh.glsl"
#include "lib/constants.glsl"

uniform sampler2D viewNormal;
uniform sampler2D albedo;
uniform sampler2D direct;
uniform mat4 world_from_view;
uniform vec3 irradiance_sh[9];

out vec4 reflected_share;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 worldNormal = mat3(world_from_view) * texelFetch(viewNormal, pixel, 0).xyz;
    vec3 ambientLight = max(shIrradiance(irradiance_sh, worldNormal), 1e-20) / PI;
    vec4 surfaceAlbedo = texelFetch(albedo, pixel, 0);
    reflected_share = vec4(min(surfaceAlbedo.rgb + texelFetch(direct, pixel, 0).rgb / ambientLight, 1.0), surfaceAlbedo.a);
}
