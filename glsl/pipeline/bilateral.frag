// One direction of a separable bilateral filter over 8 pixels: geometry decides who takes part, by the distance to the
// tangent plane and by the normal. The window is 9 wide with half weights at its ends: symmetric, and still every set of
// the 4×4 interleaved pattern is counted equally, so that the pattern cancels on a plane.
// S3HO (2012): "geometry-aware 8×8 bilateral (weights: distance and normal)".
// Inputs: source (any channels), viewZ, viewNormal. Output: filtered.

#include "lib/space.glsl"
#include "lib/filter.glsl"

const bool vertical;

uniform sampler2D source;
uniform sampler2D viewZ;
uniform sampler2D viewNormal;
uniform vec4 ray_from_pixel;

out vec4 filtered;

const int REACH = 4;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(viewZ, 0) - 1;
    float centreZ = texelFetch(viewZ, pixel, 0).r;
    filtered = texelFetch(source, pixel, 0);
    if (isBackground(centreZ)) return;

    vec3 centrePos = viewPosAt(gl_FragCoord.xy, centreZ, ray_from_pixel);
    vec3 normal = texelFetch(viewNormal, pixel, 0).xyz;
    vec4 sum = filtered;
    float weights = 1.0;
    for (int i = -REACH; i <= REACH; ++i) {
        if (i == 0) continue;
        ivec2 other = clamp(pixel + (vertical ? ivec2(0, i) : ivec2(i, 0)), ivec2(0), last);
        vec3 otherPos = viewPosAt(vec2(other) + 0.5, texelFetch(viewZ, other, 0).r, ray_from_pixel);
        float plane = planeDistance(centrePos, normal, otherPos) / PLANE_TOLERANCE;
        float alike = max(dot(normal, texelFetch(viewNormal, other, 0).xyz), 0.0);
        float weight = (abs(i) == REACH ? 0.5 : 1.0) * max(1.0 - plane * plane, 0.0) * pow(alike, 8.0);
        if (weight > 0.0) {  // the background's plane distance is infinite
            sum += weight * texelFetch(source, other, 0);
            weights += weight;
        }
    }
    filtered = sum / weights;
}
