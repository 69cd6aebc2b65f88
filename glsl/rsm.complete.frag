// The bounce of pixels that low resolution could not give: Dachsbacher and Stamminger 2005, section 4, the second pass.
// Inputs: viewZ, viewNormal; rsm_interpolated of rsm.interpolate.frag; the reflective shadow maps.
// Output: rsm_irradiance: rgb the irradiance; a is 1 where it was interpolated, 0 where it was gathered here.

#include "lib/space.glsl"
#include "lib/pixel_lights.glsl"

uniform sampler2D viewZ;
uniform sampler2D viewNormal;
uniform sampler2D rsm_interpolated;
uniform vec4 ray_from_pixel;
uniform mat4 world_from_view;

out vec4 rsm_irradiance;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float surfaceZ = texelFetch(viewZ, pixel, 0).r;
    rsm_irradiance = texelFetch(rsm_interpolated, pixel, 0);
    if (isBackground(surfaceZ) || rsm_irradiance.a > 0.5) return;

    vec3 worldPos = (world_from_view * vec4(viewPosAt(gl_FragCoord.xy, surfaceZ, ray_from_pixel), 1.0)).xyz;
    vec3 worldNormal = mat3(world_from_view) * texelFetch(viewNormal, pixel, 0).xyz;
    rsm_irradiance = vec4(gatherAt(worldPos, worldNormal, interleavedSet(pixel)), 0.0);
}
