// Joint bilateral upsampling (Kopf et al. 2007): the four nearest small pixels, weighted as in bilinear interpolation, and
// by whether they lie on the same surface as the full-size pixel. Where none does, the one nearest in depth is taken.
// Inputs: viewZ, viewNormal, facets at full size; smallViewZ, smallNormal, sources (lib/sources.glsl) at small size.
// Outputs: results, the sources at full size.

#include "lib/space.glsl"
#include "lib/filter.glsl"
#include "lib/facets.glsl"
#include "lib/sources.glsl"

uniform sampler2D smallViewZ;
uniform sampler2D smallNormal;
uniform sampler2D viewZ;
uniform sampler2D viewNormal;
uniform vec2 texel_size;
uniform vec4 ray_from_pixel;
uniform vec4 small_ray_from_pixel;

void main() {
    vec2 uv = gl_FragCoord.xy * texel_size;
    vec2 ray = viewPosAt(gl_FragCoord.xy, -1.0, ray_from_pixel).xy;
    vec2 smallSize = vec2(textureSize(smallViewZ, 0));
    vec2 smallPixel = (ray - small_ray_from_pixel.zw) / small_ray_from_pixel.xy;
    vec2 corner = floor(smallPixel - 0.5) + 0.5;   // the centre of the lower left of the four
    vec2 part = smallPixel - corner;
    vec2 last = smallSize - 0.5;
    mat4 nearest = sourcesAt(clamp(corner, vec2(0.5), last) / smallSize);
    writeResults(nearest);
    float centreZ = texture(viewZ, uv).r;
    if (isBackground(centreZ)) return;

    vec3 normal = texture(viewNormal, uv).xyz;
    vec3 facet = facetAt(uv, normal);
    vec2 upward = vec2(facet.z, normal.z);
    vec2 planeOffset = alongNormals(vec2(dot(facet.xy, ray), dot(normal.xy, ray)), upward, centreZ);
    float tolerance = planeTolerance(centreZ, -ray_from_pixel.w);
    mat4 sum = mat4(0.0);
    float weights = 0.0, nearestGap = 1e30;
    for (int i = 0; i < 4; ++i) {
        vec2 step = vec2(i & 1, i >> 1);
        vec2 other = clamp(corner + step, vec2(0.5), last);
        vec2 otherUv = other / smallSize;
        float otherZ = texture(smallViewZ, otherUv).r;
        mat4 value = sourcesAt(otherUv);
        vec2 otherRay = viewPosAt(other, -1.0, small_ray_from_pixel).xy;
        vec2 otherDotRay = vec2(dot(facet.xy, otherRay), dot(normal.xy, otherRay));
        float gap = nearerPlane(alongNormals(otherDotRay, upward, otherZ) - planeOffset) / tolerance;
        vec2 bilinear = mix(1.0 - part, part, step);
        float alike = max(dot(normal, texture(smallNormal, otherUv).xyz), 0.0);
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
