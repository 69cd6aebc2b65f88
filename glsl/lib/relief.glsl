// Height maps, all in one texture (aolab/pipeline/reliefs.py). Heights in scene units of the mesh, along its normal.

const int reliefs;                    // height maps of the scene, at least 1

uniform sampler2D relief_atlas;
uniform vec4 relief_region[reliefs];  // texels of each map: lower left corner, size
uniform vec2 relief_wrap[reliefs];    // in u and in v: 0 repeats, 1 mirrors, 2 clamps

float wrapped(float at, float kind) {
    if (kind == 0.0) return fract(at);
    if (kind == 1.0) return abs(mod(at + 1.0, 2.0) - 1.0);
    return clamp(at, 0.0, 1.0);
}

// The height of map `number` at `uv`, interpolated.
float heightAt(int number, vec2 uv) {
    vec4 region = relief_region[number];
    vec2 inside = vec2(wrapped(uv.x, relief_wrap[number].x), wrapped(uv.y, relief_wrap[number].y));
    return texture(relief_atlas, (region.xy + inside * region.zw) / vec2(textureSize(relief_atlas, 0))).r;
}

// Its slope: the derivatives by u and by v, between the texels on both sides.
vec2 slopeAt(int number, vec2 uv) {
    vec2 texel = 1.0 / relief_region[number].zw;
    float byU = heightAt(number, uv + vec2(0.5 * texel.x, 0.0)) - heightAt(number, uv - vec2(0.5 * texel.x, 0.0));
    float byV = heightAt(number, uv + vec2(0.0, 0.5 * texel.y)) - heightAt(number, uv - vec2(0.0, 0.5 * texel.y));
    return vec2(byU, byV) / texel;
}
