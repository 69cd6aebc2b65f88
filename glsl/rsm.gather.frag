// One bounce of the lights, gathered from their reflective shadow maps: Dachsbacher and Stamminger 2005; Chow 2014. Nothing
// blocks on the way from a pixel light to the receiver.
// Inputs: viewZ, viewNormal; the reflective shadow maps (lib/pixel_lights.glsl).
// Output: rsm_irradiance: rgb the irradiance from the samples; a is 1.

#include "lib/space.glsl"
#include "lib/pixel_lights.glsl"

uniform sampler2D viewZ;
uniform sampler2D viewNormal;
uniform vec4 ray_from_pixel;
uniform mat4 world_from_view;

out vec4 rsm_irradiance;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float surfaceZ = texelFetch(viewZ, pixel, 0).r;
    rsm_irradiance = vec4(0.0);
    if (isBackground(surfaceZ)) return;

    vec3 worldPos = (world_from_view * vec4(viewPosAt(gl_FragCoord.xy, surfaceZ, ray_from_pixel), 1.0)).xyz;
    vec3 worldNormal = mat3(world_from_view) * texelFetch(viewNormal, pixel, 0).xyz;
    rsm_irradiance = vec4(gatherAt(worldPos, worldNormal, interleavedSet(pixel)), 1.0);
}
