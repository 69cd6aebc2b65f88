// Shadow maps: tiles of one atlas, and a table of their projections.

#include "lib/light.glsl"

uniform sampler2DShadow shadow_atlas;
// A row a tile: the four columns of its clip_from_world; its corner (xy) and its side (z) in the atlas, pixels, and its
// bias (w) at the distance 1, for tan α = 1.
uniform sampler2D shadow_table;

const bool one_tile;   // the table has a single row, and these uniforms hold it: on llvmpipe, the fetches take longer
uniform mat4 tile_from_world;
uniform vec4 tile_place;

mat4 tileFromWorld(int tile) {
    if (one_tile) return tile_from_world;
    return mat4(texelFetch(shadow_table, ivec2(0, tile), 0), texelFetch(shadow_table, ivec2(1, tile), 0),
                texelFetch(shadow_table, ivec2(2, tile), 0), texelFetch(shadow_table, ivec2(3, tile), 0));
}

vec4 tilePlace(int tile) {
    return one_tile ? tile_place : texelFetch(shadow_table, ivec2(4, tile), 0);
}

// The unshadowed share at `worldPos` of the light that this tile belongs to.
float tileShadow(int tile, vec3 worldPos) {
    return shadowAt(shadow_atlas, tileFromWorld(tile), tilePlace(tile).xyz, worldPos);
}

// The bias b of a tile, in scene units: the map lies by so much behind the surface at `worldPos`, along the light.
// b = (p/2) tan α × the shadow bias (SSDO, Ritschel et al. 2009, section 5), with the width p of a texel at that distance
// and the angle α between light and normal; `facing` is cos α. Below a cosine of 0.05, 5 % of the light, b grows no more.
float tileBias(int tile, vec3 worldPos, float facing) {
    float distanceFactor = (tileFromWorld(tile) * vec4(worldPos, 1.0)).w;   // 1 if the light's rays are parallel
    float cosine = clamp(facing, 0.05, 1.0);
    return tilePlace(tile).w * distanceFactor * sqrt(1.0 - cosine * cosine) / cosine;
}
