// The scene's lights and their shadow maps, by number: 0 to lights - 1.

#include "lib/light.glsl"

const int lights;
const int light_slots;   // the same, but at least 1: GLSL has no empty array
const int shadow_slots;

uniform sampler2DShadow shadow_atlas;
uniform int light_kind[light_slots];
uniform vec3 light_position[light_slots];
uniform vec3 light_direction[light_slots];
uniform vec3 light_color[light_slots];
uniform vec2 light_spot_cos[light_slots];
uniform int light_tile[light_slots];            // its first shadow tile, or -1 for none
uniform mat4 shadow_from_world[shadow_slots];
uniform vec3 shadow_tile[shadow_slots];

// The unit direction towards light `i`, world space, and the share of its color that arrives there, but for shadows.
vec3 towardsLightAt(int i, vec3 worldPos, out float arriving) {
    return towardsLight(light_kind[i], light_position[i], light_direction[i], light_spot_cos[i], worldPos, arriving);
}

// The share of it that arrives past its shadow map.
float shadowOf(int i, vec3 worldPos, vec3 toLight) {
    int tile = light_tile[i];
    if (tile < 0) return 1.0;
    if (light_kind[i] == POINT) tile += cubeFace(-toLight);
    return shadowAt(shadow_atlas, shadow_from_world[tile], shadow_tile[tile], worldPos);
}

// The same for lights that are lobes, and so shine on what faces away from them; `facing`: dot(normal, toLight). Such a
// surface is in its own shadow. A map tells that only roughly where light grazes: the shadow sets in from there on.
const float TERMINATOR = 0.25;  // of `facing`

float lobesShadowOf(int i, vec3 worldPos, vec3 toLight, float facing) {
    if (light_tile[i] < 0) return 1.0;
    float grazing = smoothstep(0.0, TERMINATOR, facing);
    return grazing > 0.0 ? grazing * shadowOf(i, worldPos, toLight) : 0.0;
}
