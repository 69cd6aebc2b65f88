// The facet: the normal of the triangle that a pixel shows, on the side of viewNormal, unit, view space.
// The G-buffer stores it as a point of an octahedral map around +z, two whole numbers of 16 bits.

#include "lib/octahedral.glsl"

const bool has_facets;   // some surface of the scene has another normal than its triangle

uniform sampler2D facets;

// `stored`: a texel, octahedralUv(facet.xzy).
vec3 facetFrom(vec2 stored) {
    return octahedralDirection(stored).xzy;
}

// `normal` is viewNormal there.
vec3 facetAt(vec2 uv, vec3 normal) {
    return has_facets ? facetFrom(texture(facets, uv).xy) : normal;
}

vec3 facetAt(ivec2 pixel, vec3 normal) {
    return has_facets ? facetFrom(texelFetch(facets, pixel, 0).xy) : normal;
}
