// A smaller G-buffer: the nearest pixel's surface, seen through the centre of the small pixel.
// The depth follows the surface's tangent plane from the one centre to the other, so that a plane stays one.
// Inputs: viewZ, viewNormal, facets, albedo at full size. Outputs: smallViewZ (R32F), smallNormal, smallAlbedo (RGBA16F).

#include "lib/space.glsl"
#include "lib/filter.glsl"
#include "lib/facets.glsl"
#include "lib/shrink.glsl"

const bool with_albedo;

uniform sampler2D viewZ;
uniform sampler2D viewNormal;
uniform sampler2D albedo;
uniform vec4 ray_from_pixel;         // of the full size
uniform vec4 small_ray_from_pixel;

out float smallViewZ;
out vec4 smallNormal;
out vec4 smallAlbedo;

void main() {
    vec2 ray = viewPosAt(gl_FragCoord.xy, -1.0, small_ray_from_pixel).xy;
    ivec2 nearest = nearestLarge(gl_FragCoord.xy, textureSize(viewZ, 0), ray_from_pixel, small_ray_from_pixel);
    smallViewZ = texelFetch(viewZ, nearest, 0).r;
    smallNormal = texelFetch(viewNormal, nearest, 0);
    if (with_albedo) smallAlbedo = texelFetch(albedo, nearest, 0);
    if (isBackground(smallViewZ)) return;
    vec2 nearestRay = viewPosAt(vec2(nearest) + 0.5, -1.0, ray_from_pixel).xy;
    vec3 facet = facetAt(nearest, smallNormal.xyz);
    // near a silhouette the plane is seen edge-on and would lead far away: at most 2 % are followed
    if (orthographic) {
        float limit = 0.02 * COT_22_5 * -ray_from_pixel.w;
        smallViewZ += clamp(dot(facet.xy, nearestRay - ray) / facet.z, -limit, limit);
    } else {
        smallViewZ *= clamp(dot(facet, vec3(nearestRay, -1.0)) / dot(facet, vec3(ray, -1.0)), 0.98, 1.02);
    }
}
