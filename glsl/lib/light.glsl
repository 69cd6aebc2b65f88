// Lights without size, as in glTF's KHR_lights_punctual, and their shadow maps. Positions and directions: world space.

const int DIRECTIONAL = 0;
const int POINT = 1;
const int SPOT = 2;

// The unit direction towards the light. `attenuation` is the factor from the light's colour to the irradiance of a
// surface that faces the light, without shadows. `spotCos`: cosines of the inner and outer half angle of a spot's cone.
vec3 towardsLight(int kind, vec3 lightPos, vec3 lightDir, vec2 spotCos, vec3 worldPos, out float attenuation) {
    attenuation = 1.0;
    if (kind == DIRECTIONAL) return -lightDir;
    vec3 toLight = lightPos - worldPos;
    float squaredDistance = max(dot(toLight, toLight), 1e-12);
    vec3 direction = toLight * inversesqrt(squaredDistance);
    attenuation = 1.0 / squaredDistance;
    if (kind == SPOT) {
        float inCone = clamp((dot(-direction, lightDir) - spotCos.y) / (spotCos.x - spotCos.y), 0.0, 1.0);
        attenuation *= inCone * inCone;
    }
    return direction;
}

// The index of the shadow tile that sees the direction `fromLight`, of the six of a point light: +x -x +y -y +z -z.
int cubeFace(vec3 fromLight) {
    vec3 size = abs(fromLight);
    if (size.x >= size.y && size.x >= size.z) return fromLight.x > 0.0 ? 0 : 1;
    if (size.y >= size.z) return fromLight.y > 0.0 ? 2 : 3;
    return fromLight.z > 0.0 ? 4 : 5;
}

// The unshadowed share of a light, by percentage-closer filtering (Reeves, Salesin and Cook 1987): the mean of 2×2
// comparisons, each interpolated by the sampler. `tile`: lower corner (xy) and side (z) of the tile in the atlas, pixels.
float shadowAt(sampler2DShadow atlas, mat4 shadowFromWorld, vec3 tile, vec3 worldPos) {
    vec4 clip = shadowFromWorld * vec4(worldPos, 1.0);
    vec3 inTile = clip.xyz / clip.w * 0.5 + 0.5;
    if (clip.w <= 0.0 || inTile.z >= 1.0 || any(greaterThan(abs(inTile.xy - 0.5), vec2(0.5)))) return 1.0;
    vec2 texel = 1.0 / vec2(textureSize(atlas, 0));
    vec2 low = tile.xy + 1.0, high = tile.xy + tile.z - 1.0;  // a neighbouring tile belongs to another light
    vec2 atPx = tile.xy + inTile.xy * tile.z;
    float lit = 0.0;
    for (int i = 0; i < 4; ++i) {
        vec2 offsetPx = (vec2(i & 1, i >> 1) - 0.5) * 1.5;
        lit += texture(atlas, vec3(clamp(atPx + offsetPx, low, high) * texel, inTile.z));
    }
    return lit / 4.0;
}
