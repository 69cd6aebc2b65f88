// The mean over 4 pixels in a row or column that lie on the same surface; twice, it is the mean over 4×4: every set of
// the interleaved pattern once (Umenhoffer et al. 2009, section 4.2).
// Inputs: sources (lib/sources.glsl), viewZ, viewNormal, facets. Outputs: results, the sources filtered, on an even window: moved by half a pixel.

#include "lib/space.glsl"
#include "lib/filter.glsl"
#include "lib/facets.glsl"
#include "lib/sources.glsl"

const bool vertical;

uniform sampler2D viewZ;
uniform sampler2D viewNormal;
uniform vec4 ray_from_pixel;
uniform vec2 texel_size;

// Normals more than 45 degrees apart are of different surfaces: a crease lies within the plane's tolerance. Of none, 45, 26
// and 14 degrees, 45 had the least error against rays on the six scenes together (ssao and s3ho, 480×270).
const float LEAST_ALIKE = 0.7;

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
    float count = 1.0;
    for (int i = -1; i <= 2; ++i) {
        vec2 other = uv + float(i) * uvStep;
        float otherZ = texture(viewZ, other).r;   // beyond the edge, that of the background
        float alike = dot(normal, texture(viewNormal, other).xyz);
        float plane = nearerPlane(alongNormals(dotRay + float(i) * rayStep, upward, otherZ) - planeOffset);
        float weight = i != 0 && plane < tolerance && alike > LEAST_ALIKE ? 1.0 : 0.0;
        sum += weight * sourcesAt(other);
        count += weight;
    }
    writeResults(sum / count);
}
