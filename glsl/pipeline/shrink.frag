// A smaller G-buffer: the nearest pixel's surface, seen through the centre of the small pixel.
// The depth follows the surface's tangent plane from the one centre to the other, so that a plane stays one.
// Inputs: viewZ, viewNormal, albedo at full size. Outputs: smallViewZ (R32F), smallNormal, smallAlbedo (RGBA16F).

#include "lib/space.glsl"
#include "lib/shrink.glsl"

uniform sampler2D viewZ;
uniform sampler2D viewNormal;
uniform sampler2D albedo;
uniform vec4 ray_from_pixel;         // of the full size
uniform vec4 small_ray_from_pixel;

out float smallViewZ;
out vec4 smallNormal;
out vec4 smallAlbedo;

void main() {
    vec3 ray = viewPosAt(gl_FragCoord.xy, -1.0, small_ray_from_pixel);
    ivec2 nearest = nearestLarge(gl_FragCoord.xy, textureSize(viewZ, 0), ray_from_pixel, small_ray_from_pixel);
    smallViewZ = texelFetch(viewZ, nearest, 0).r;
    smallNormal = texelFetch(viewNormal, nearest, 0);
    smallAlbedo = texelFetch(albedo, nearest, 0);
    if (isBackground(smallViewZ)) return;
    vec3 nearestRay = viewPosAt(vec2(nearest) + 0.5, -1.0, ray_from_pixel);
    // near a silhouette the plane is seen edge-on and would lead far away: at most 2 % are followed
    float along = dot(smallNormal.xyz, nearestRay) / dot(smallNormal.xyz, ray);
    smallViewZ *= clamp(along, 0.98, 1.02);
}
