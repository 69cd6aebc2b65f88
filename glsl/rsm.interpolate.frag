// The bounce at full size from one at low size, where that agrees: Dachsbacher and Stamminger 2005, section 4.
// Of the four nearest small pixels, those with a similar normal and a point on the same plane count, bilinearly. If fewer
// than three do, a is 0, and rsm.complete.frag gathers for this pixel.
// Inputs: viewZ, viewNormal, facets at full size; smallViewZ, smallNormal, sources (lib/sources.glsl) at small size.
// Outputs: results, the sources at full size; a is whether they were interpolated.

#include "lib/space.glsl"
#include "lib/filter.glsl"
#include "lib/facets.glsl"
#include "lib/sources.glsl"

uniform sampler2D smallViewZ;
uniform sampler2D smallNormal;
uniform sampler2D viewZ;
uniform sampler2D viewNormal;
uniform vec4 ray_from_pixel;
uniform vec4 small_ray_from_pixel;

const float LEAST_ALIKE = 0.97;  // cosine of 14°: within it, diffuse light changes by less than its own noise

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float centreZ = texelFetch(viewZ, pixel, 0).r;
    writeResults(mat4(0.0));
    if (isBackground(centreZ)) return;

    vec2 ray = viewPosAt(gl_FragCoord.xy, -1.0, ray_from_pixel).xy;
    vec2 smallPixel = (ray - small_ray_from_pixel.zw) / small_ray_from_pixel.xy - 0.5;
    ivec2 corner = ivec2(floor(smallPixel)), last = textureSize(smallViewZ, 0) - 1;
    vec2 part = smallPixel - vec2(corner);
    vec3 normal = texelFetch(viewNormal, pixel, 0).xyz;
    vec3 facet = facetAt(pixel, normal);
    vec2 upward = vec2(facet.z, normal.z);
    vec2 planeOffset = alongNormals(vec2(dot(facet.xy, ray), dot(normal.xy, ray)), upward, centreZ);
    float tolerance = planeTolerance(centreZ, -ray_from_pixel.w);
    mat4 sum = mat4(0.0);
    float weights = 0.0, agreeing = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 step = ivec2(i & 1, i >> 1);
        ivec2 other = clamp(corner + step, ivec2(0), last);
        vec2 otherRay = viewPosAt(vec2(other) + 0.5, -1.0, small_ray_from_pixel).xy;
        float otherZ = texelFetch(smallViewZ, other, 0).r;
        vec2 otherDotRay = vec2(dot(facet.xy, otherRay), dot(normal.xy, otherRay));
        float gap = nearerPlane(alongNormals(otherDotRay, upward, otherZ) - planeOffset);
        bool agrees = gap < tolerance && dot(normal, texelFetch(smallNormal, other, 0).xyz) > LEAST_ALIKE;
        if (!agrees) continue;
        vec2 bilinear = mix(1.0 - part, part, vec2(step));
        float weight = bilinear.x * bilinear.y + 1e-3;
        sum += weight * sourcesAt(other);
        weights += weight;
        agreeing += 1.0;
    }
    mat4 mean = sum / max(weights, 1e-6);
    for (int i = 0; i < sources; ++i) mean[i].a = agreeing >= 3.0 ? 1.0 : 0.0;
    writeResults(mean);
}
