// The mean over 4 pixels in a row or column that lie on the same surface; twice, it is the mean over 4×4: every set of
// the interleaved pattern once (Umenhoffer et al. 2009, section 4.2).
// Inputs: sources (lib/sources.glsl), viewZ, viewNormal, facetNormal. Outputs: results, the sources filtered, on an even window: moved by half a pixel.

#include "lib/space.glsl"
#include "lib/filter.glsl"
#include "lib/sources.glsl"

const bool vertical;

uniform sampler2D viewZ;
uniform sampler2D viewNormal;
uniform sampler2D facetNormal;
uniform vec4 ray_from_pixel;

// Normals more than 45 degrees apart are of different surfaces: a crease lies within the plane's tolerance. Of none, 45, 26
// and 14 degrees, 45 had the least error against rays on the six scenes together (ssao and s3ho, 480×270).
const float LEAST_ALIKE = 0.7;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(viewZ, 0) - 1;
    float centreZ = texelFetch(viewZ, pixel, 0).r;
    mat4 sum = sourcesAt(pixel);
    writeResults(sum);
    if (isBackground(centreZ)) return;

    vec3 normal = texelFetch(viewNormal, pixel, 0).xyz;
    vec2 ray = viewPosAt(gl_FragCoord.xy, -1.0, ray_from_pixel).xy;
    vec3 facet = texelFetch(facetNormal, pixel, 0).xyz;
    vec2 dotRay = vec2(dot(facet.xy, ray), dot(normal.xy, ray));
    vec2 upward = vec2(facet.z, normal.z);
    vec2 planeOffset = alongNormals(dotRay, upward, centreZ);
    float tolerance = planeTolerance(centreZ, -ray_from_pixel.w);
    // the rays of a row, or column, differ in one component: by this much a pixel
    vec2 rayStep = vertical ? vec2(facet.y, normal.y) * ray_from_pixel.y : vec2(facet.x, normal.x) * ray_from_pixel.x;
    float count = 1.0;
    #pragma unroll
    for (int i = -1; i <= 2; ++i) {
        ivec2 other = clamp(pixel + (vertical ? ivec2(0, i) : ivec2(i, 0)), ivec2(0), last);
        float otherZ = texelFetch(viewZ, other, 0).r;
        float alike = dot(normal, texelFetch(viewNormal, other, 0).xyz);
        float plane = nearerPlane(alongNormals(dotRay + float(i) * rayStep, upward, otherZ) - planeOffset);
        float weight = i != 0 && plane < tolerance && alike > LEAST_ALIKE ? 1.0 : 0.0;
        sum += weight * sourcesAt(other);
        count += weight;
    }
    writeResults(sum / count);
}
