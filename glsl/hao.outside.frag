// HAO outside the region of interest: open, or the visibility that is baked into the vertices (Reinbothe, Boubekeur and Alexa 2009,
// section 4: "static regions can embed precomputed AO maps").
// Inputs:  viewZ; inside, the visibility by rays; baked, the visibility of the vertices.
// Output:  visibility, in [0, 1].

#include "lib/space.glsl"
#include "occluders.glsl"

const bool from_vertices;

uniform sampler2D inside;
uniform sampler2D baked;
uniform vec4 ray_from_pixel;

out float visibility;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float centreZ = texelFetch(viewZ, pixel, 0).r;
    visibility = 1.0;
    if (isBackground(centreZ)) return;
    vec3 viewPos = viewPosAt(gl_FragCoord.xy, centreZ, ray_from_pixel);
    if (inRegion(viewPos)) visibility = texelFetch(inside, pixel, 0).r;
    else if (from_vertices) visibility = texelFetch(baked, pixel, 0).r;
}
