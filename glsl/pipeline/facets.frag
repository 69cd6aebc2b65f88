// The normals of triangles, from their uv in an azimuthal map, which the G-buffer stores.
// Inputs: viewZ, and those of lib/facets.glsl. Output: facetNormal, unit, view space; 0 in the background.

#include "lib/space.glsl"
#include "lib/facets.glsl"

uniform sampler2D viewZ;

out vec4 facetNormal;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    facetNormal = vec4(isBackground(texelFetch(viewZ, pixel, 0).r) ? vec3(0.0) : facetAt(pixel, vec3(0.0)), 0.0);
}
