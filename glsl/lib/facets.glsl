// The facet: the normal of the triangle that a pixel shows, on the side of viewNormal, unit, view space. The G-buffer stores
// its uv in an azimuthal map, two whole numbers of 16 bits.

#include "lib/azimuthal.glsl"

const bool has_facets;   // some surface of the scene has another normal than its triangle

uniform sampler2D facets;

// `normal`: viewNormal there.
vec3 facetAt(vec2 uv, vec3 normal) {
    return has_facets ? azimuthalDirection(texture(facets, uv).xy) : normal;
}

vec3 facetAt(ivec2 pixel, vec3 normal) {
    return has_facets ? azimuthalDirection(texelFetch(facets, pixel, 0).xy) : normal;
}
