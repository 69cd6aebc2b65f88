// Direct light: every light through its shadow map, reflected diffusely. Ambient occlusion takes no part in this.
// Inputs: viewZ, viewNormal, albedo. Output: direct, linear RGB radiance: Σ albedo/π × E_light × cosθ × shadow.

#include "lib/space.glsl"
#include "lib/light.glsl"
#include "lib/sampling.glsl"
#include "occluders.glsl"

const int lights;
const int light_slots;   // the same, but at least 1: GLSL has no empty array
const int shadow_slots;
const int light_steps;   // samples on the screen towards each light; 0 for none

uniform sampler2D albedo;
uniform sampler2DShadow shadow_atlas;
uniform vec4 ray_from_pixel;
uniform mat4 view_from_world;
uniform float radius;     // scene units
uniform float bias;       // radii
uniform float thickness;  // radii
uniform mat4 world_from_view;
uniform int light_kind[light_slots];
uniform vec3 light_position[light_slots];
uniform vec3 light_direction[light_slots];
uniform vec3 light_color[light_slots];
uniform vec2 light_spot_cos[light_slots];
uniform int light_tile[light_slots];            // its first shadow tile, or -1 for none
uniform mat4 shadow_from_world[shadow_slots];
uniform vec3 shadow_tile[shadow_slots];

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
        float attenuation;
        vec3 toLight = towardsLight(light_kind[i], light_position[i], light_direction[i], light_spot_cos[i],
                                    worldPos, attenuation);
        attenuation *= max(dot(worldNormal, toLight), 0.0);
        if (attenuation > 0.0 && light_tile[i] >= 0) {
            int tile = light_tile[i];
            if (light_kind[i] == POINT) tile += cubeFace(-toLight);
            attenuation *= shadowAt(shadow_atlas, shadow_from_world[tile], shadow_tile[tile], worldPos);
        }
        if (light_steps > 0 && attenuation > 0.0) {
            float reach = light_kind[i] == DIRECTIONAL ? radius : min(radius, distance(light_position[i], worldPos));
            attenuation *= reachesLight(lifted, mat3(view_from_world) * toLight, reach, offset);
        }
        irradiance += light_color[i] * attenuation;
    }
    direct = vec4(texelFetch(albedo, pixel, 0).rgb / 3.14159265358979 * irradiance, 1.0);
}
