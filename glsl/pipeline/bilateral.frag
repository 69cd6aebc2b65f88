// One direction of a separable bilateral filter over 8 pixels: geometry decides who takes part, by the distance to the
// tangent plane and by the normal. The window is 9 wide with half weights at its ends: symmetric, and still every set of
// the 4×4 interleaved pattern is counted equally, so that the pattern cancels on a plane.
// S3HO (2012): "geometry-aware 8×8 bilateral (weights: distance and normal)".
// Inputs: sources (lib/sources.glsl), viewZ, viewNormal, facets. Outputs: results, the sources filtered.

#include "lib/space.glsl"
#include "lib/filter.glsl"
#include "lib/facets.glsl"
#include "lib/sources.glsl"

const bool vertical;

uniform sampler2D viewZ;
uniform sampler2D viewNormal;
uniform vec4 ray_from_pixel;
uniform vec2 texel_size;

const int REACH = 4;

void main() {
    vec2 uv = gl_FragCoord.xy * texel_size;
    vec2 uvStep = vertical ? vec2(0.0, texel_size.y) : vec2(texel_size.x, 0.0);
    float centreZ = texture(viewZ, uv).r;
    mat4 sum = sourcesAt(uv);
    writeResults(sum);
    if (isBackground(centreZ)) return;

    vec3 normal = texture(viewNormal, uv).xyz;
    vec2 ray = viewPosAt(gl_FragCoord.xy, -1.0, ray_from_pixel).xy;
    vec3 facet = facetAt(uv, normal);
    vec2 dotRay = vec2(dot(facet.xy, ray), dot(normal.xy, ray));
    vec2 upward = vec2(facet.z, normal.z);
    vec2 planeOffset = alongNormals(dotRay, upward, centreZ);
    float tolerance = planeTolerance(centreZ, -ray_from_pixel.w);
    // the rays of a row, or column, differ in one component: by this much a pixel
    vec2 rayStep = vertical ? vec2(facet.y, normal.y) * ray_from_pixel.y : vec2(facet.x, normal.x) * ray_from_pixel.x;
    float weights = 1.0;
    for (int i = -REACH; i <= REACH; ++i) {
        vec2 other = uv + float(i) * uvStep;
        float otherZ = texture(viewZ, other).r;   // beyond the edge, that of the background
        float plane = nearerPlane(alongNormals(dotRay + float(i) * rayStep, upward, otherZ) - planeOffset) / tolerance;
        float alike = max(dot(normal, texture(viewNormal, other).xyz), 0.0);
        float share = i == 0 ? 0.0 : abs(i) == REACH ? 0.5 : 1.0;  // the centre is in the sum already
        // the background's plane distance is infinite
        float weight = abs(plane) < 1.0 ? share * (1.0 - plane * plane) * pow(alike, 8.0) : 0.0;
        sum += weight * sourcesAt(other);
        weights += weight;
    }
    writeResults(sum / weights);
}
