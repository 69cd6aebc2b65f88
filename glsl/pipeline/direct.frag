// Direct light: every light through its shadow map, reflected diffusely. Ambient occlusion takes no part in this.
// Inputs: viewZ, viewNormal, albedo. Output: direct, linear RGB radiance: Σ albedo/π × E_light × cosθ × shadow.

#include "lib/space.glsl"
#include "lib/lights.glsl"
#include "lib/sampling.glsl"
#include "occluders.glsl"

const int light_steps;   // samples on the screen towards each light; 0 for none

uniform sampler2D albedo;
uniform vec4 ray_from_pixel;
uniform mat4 view_from_world;
uniform float radius;     // scene units
uniform float bias;       // radii
uniform float thickness;  // radii
uniform mat4 world_from_view;

out vec4 direct;

// Does something on the screen block the segment from `viewPos` towards the light, of length `reach`?
// SSDO (Ritschel et al. 2009, section 3, "Point light"): the samples lie on the segment of length r_max to the light.
float reachesLight(vec3 viewPos, vec3 viewToLight, float reach, float offset) {
    bool blocked = false;
    for (int j = 0; j < light_steps; ++j) {
        Occluder occluder;
        vec3 samplePos = viewPos + viewToLight * (reach * (float(j) + offset) / float(light_steps));
        blocked = isBlocked(samplePos, thickness * radius, occluder) || blocked;
    }
    return blocked ? 0.0 : 1.0;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float surfaceZ = texelFetch(viewZ, pixel, 0).r;
    direct = vec4(0.0);
    if (lights == 0 || isBackground(surfaceZ)) return;

    vec3 viewPos = viewPosAt(gl_FragCoord.xy, surfaceZ, ray_from_pixel);
    vec3 normal = texelFetch(viewNormal, pixel, 0).xyz;
    vec3 lifted = viewPos + normal * liftOff(bias * radius, radius, viewPos, ray_from_pixel);
    float offset = interleavedOffset(0.5 / 16.0, interleavedSet(pixel));
    vec3 worldPos = (world_from_view * vec4(viewPos, 1.0)).xyz;
    vec3 worldNormal = mat3(world_from_view) * normal;
    vec3 irradiance = vec3(0.0);
    for (int i = 0; i < lights; ++i) {
        float arriving;
        vec3 toLight = towardsLightAt(i, worldPos, arriving);
        arriving *= max(dot(worldNormal, toLight), 0.0);
        if (arriving > 0.0) arriving *= shadowOf(i, worldPos, toLight);
        if (light_steps > 0 && arriving > 0.0) {
            float reach = light_kind[i] == DIRECTIONAL ? radius : min(radius, distance(light_position[i], worldPos));
            arriving *= reachesLight(lifted, mat3(view_from_world) * toLight, reach, offset);
        }
        irradiance += light_color[i] * arriving;
    }
    direct = vec4(texelFetch(albedo, pixel, 0).rgb / 3.14159265358979 * irradiance, 1.0);
}
