// Joint bilateral upsampling (Kopf et al. 2007): the four nearest small pixels, weighted as in bilinear interpolation, and
// by whether they lie on the same surface as the full-size pixel. Where none does, the one nearest in depth is taken.
// Inputs: viewZ, viewNormal, facetNormal at full size; smallViewZ, smallNormal, sources (lib/sources.glsl) at small size.
// Outputs: results, the sources at full size.

#include "lib/space.glsl"
#include "lib/filter.glsl"
#include "lib/sources.glsl"

uniform sampler2D smallViewZ;
uniform sampler2D smallNormal;
uniform sampler2D viewZ;
uniform sampler2D viewNormal;
uniform sampler2D facetNormal;
uniform vec4 ray_from_pixel;
uniform vec4 small_ray_from_pixel;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float centreZ = texelFetch(viewZ, pixel, 0).r;
    vec2 ray = viewPosAt(gl_FragCoord.xy, -1.0, ray_from_pixel).xy;
    vec2 smallPixel = (ray - small_ray_from_pixel.zw) / small_ray_from_pixel.xy - 0.5;
    ivec2 corner = ivec2(floor(smallPixel));
    vec2 part = smallPixel - vec2(corner);
    ivec2 last = textureSize(smallViewZ, 0) - 1;
    mat4 nearest = sourcesAt(clamp(corner, ivec2(0), last));
    writeResults(nearest);
    if (isBackground(centreZ)) return;

    vec3 normal = texelFetch(viewNormal, pixel, 0).xyz;
    vec3 facet = texelFetch(facetNormal, pixel, 0).xyz;
    vec2 upward = vec2(facet.z, normal.z);
    vec2 planeOffset = alongNormals(vec2(dot(facet.xy, ray), dot(normal.xy, ray)), upward, centreZ);
    float tolerance = planeTolerance(centreZ, -ray_from_pixel.w);
    mat4 sum = mat4(0.0);
    float weights = 0.0, nearestGap = 1e30;
    for (int i = 0; i < 4; ++i) {
        ivec2 step = ivec2(i & 1, i >> 1);
        ivec2 other = clamp(corner + step, ivec2(0), last);
        float otherZ = texelFetch(smallViewZ, other, 0).r;
        mat4 value = sourcesAt(other);
        vec2 otherRay = viewPosAt(vec2(other) + 0.5, -1.0, small_ray_from_pixel).xy;
        vec2 otherDotRay = vec2(dot(facet.xy, otherRay), dot(normal.xy, otherRay));
        float gap = nearerPlane(alongNormals(otherDotRay, upward, otherZ) - planeOffset) / tolerance;
        vec2 bilinear = mix(1.0 - part, part, vec2(step));
        float alike = max(dot(normal, texelFetch(smallNormal, other, 0).xyz), 0.0);
        float weight = (bilinear.x * bilinear.y + 1e-3) * max(1.0 - gap, 0.0) * pow(alike, 8.0);
        if (weight > 0.0) {
            sum += weight * value;
            weights += weight;
        }
        if (gap < nearestGap) {
            nearestGap = gap;
            nearest = value;
        }
    }
    writeResults(weights > 1e-5 ? sum / weights : nearest);
}
