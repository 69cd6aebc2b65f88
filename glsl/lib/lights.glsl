// The scene's lights and their shadow maps, by index i from 0 to lights - 1.

#include "lib/shadow_tiles.glsl"

const int lights;
const int light_slots;   // max(lights, 1): GLSL has no empty arrays
const bool suns_alone;   // all lights are directional

uniform int light_kind[light_slots];
uniform vec3 light_position[light_slots];
uniform vec3 light_direction[light_slots];
uniform vec3 light_color[light_slots];
uniform vec2 light_spot_cos[light_slots];
uniform int light_tile[light_slots];            // the light's first shadow tile, or -1 without shadow

int kindOf(int i) { return suns_alone ? DIRECTIONAL : light_kind[i]; }

// The unit direction towards light `i`, world space. `arriving` is the factor from light_color[i] to irradiance,
// without shadows.
vec3 towardsLightAt(int i, vec3 worldPos, out float arriving) {
    return towardsLight(kindOf(i), light_position[i], light_direction[i], light_spot_cos[i], worldPos, arriving);
}

// The distance of light `i`, scene units.
float distanceOf(int i, vec3 worldPos) {
    return kindOf(i) == DIRECTIONAL ? 3.0e38 : distance(light_position[i], worldPos);
}

// The shadow tile of light `i` that sees `worldPos`; -1 for a light without shadow map.
int tileOf(int i, vec3 toLight) {
    int tile = light_tile[i];
    return tile >= 0 && kindOf(i) == POINT ? tile + cubeFace(-toLight) : tile;
}

// The unshadowed share of light `i` at `worldPos`; 1 for a light without shadow map. `toLight`: unit, world space.
float shadowOf(int i, vec3 worldPos, vec3 toLight) {
    int tile = tileOf(i, toLight);
    return tile < 0 ? 1.0 : tileShadow(tile, worldPos);
}

// The unshadowed share of a light that is a lobe of spherical harmonics; `facing` = dot(normal, toLight). A lobe also
// lights surfaces that face away from the light, although they are in their own shadow. Shadow maps are imprecise where
// light grazes, so the share fades to 0 between `facing` = TERMINATOR and 0.
const float TERMINATOR = 0.25;  // the cosine below which light grazes

float lobesShadowOf(int i, vec3 worldPos, vec3 toLight, float facing) {
    if (light_tile[i] < 0) return 1.0;
    float grazing = smoothstep(0.0, TERMINATOR, facing);
    return grazing > 0.0 ? grazing * shadowOf(i, worldPos, toLight) : 0.0;
}

// The irradiance of light `i` past its shadow map on a surface with this world-space normal, and the direction to the light.
vec3 irradianceFrom(int i, vec3 worldPos, vec3 worldNormal, out vec3 toLight) {
    float arriving;
    toLight = towardsLightAt(i, worldPos, arriving);
    arriving *= max(dot(worldNormal, toLight), 0.0);
    if (arriving > 0.0) arriving *= shadowOf(i, worldPos, toLight);
    return light_color[i] * arriving;
}
