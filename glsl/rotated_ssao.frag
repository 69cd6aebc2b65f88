// SSAO with a rotated kernel: samples on a line of the screen, turned by 16 angles over 4×4 pixels.
// Chow 2014, "Reflective Shadow Maps and SSAO", "Rotating Kernel Sampling". Meyer 2012 ("Shader Effects: Screen Space Ambient
// Occlusion"): each sample occludes by the cosine to the normal times an attenuation.
// Differences from the paper: the attenuation is 1 - (d/R)², which ends at the radius R, in place of 1 / (1 + d); any kind of
// occluders is tested. A sample is the point where the eye's ray meets the receiver's tangent plane: the surface there blocks
// if it is nearer to the eye, that is, above the plane.
//
// Inputs:  viewZ (scene units, negative); viewNormal (view space, unit length).
// Output:  visibility in [0, 1], 1 = open. A plane gives exactly 1.

#include "lib/space.glsl"
#include "lib/receiver.glsl"
#include "lib/facets.glsl"
#include "lib/line.glsl"
#include "occluders.glsl"

const int line_samples;

uniform float radius;     // scene units
uniform float bias;       // radii
uniform float thickness;  // radii
uniform float strength;
uniform float scale;      // of the image's resolution
uniform vec3 line_start;  // of lib/line.glsl
uniform vec4 ray_from_pixel;

out float visibility;

// The point of the plane through `planePos` on the eye's ray through `pixel`; behind the horizon, the ray's point at the
// depth `farZ`.
vec3 onPlane(vec2 pixel, vec3 planePos, vec3 normal, float farZ) {
    vec3 far = viewPosAt(pixel, farZ, ray_from_pixel);
    vec3 from = orthographic ? vec3(far.xy, 0.0) : vec3(0.0);
    vec3 way = far - from;
    float share = dot(normal, planePos - from) / min(dot(normal, way), -1e-20);  // the plane faces the eye
    return dot(normal, way) < 0.0 && share > 0.0 ? from + way * min(share, 1.0) : far;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float centreZ = texelFetch(viewZ, pixel, 0).r;
    visibility = 1.0;
    if (isBackground(centreZ)) return;

    vec3 normal = texelFetch(viewNormal, pixel, 0).xyz, facet = facetAt(pixel, normal);
    vec3 surfacePos = viewPosAt(gl_FragCoord.xy, centreZ, ray_from_pixel);
    // the depths of peeled layers are as fine as the image: at a lower resolution, pixels' centres are not their centres
    float lift = scale < 1.0 ? liftOff(bias * radius, radius, surfacePos, ray_from_pixel) : bias * radius;
    Receiver receiver = receiverAt(pixel, surfacePos + facet * lift, normal, facet, texel_size);
    Line line = lineOf(receiver.set, line_start);
    // pixels a radius, at the receiver's depth
    float reachPx = radius * pixel_from_ray.x / (orthographic ? 1.0 : -centreZ);
    float occlusion = 0.0;
    for (int i = 0; i < line_samples; ++i) {
        // a pixel's centre, whose depth is exact: a plane does not block itself
        vec2 at = floor(gl_FragCoord.xy + reachPx * onLine(line, i, line_samples).xy) + 0.5;
        vec3 samplePos = onPlane(at, receiver.viewPos, facet, centreZ - radius);
        Occluder occluder;
        if (!isBlocked(receiver, samplePos, thickness * radius, occluder)) continue;
        vec3 way = occluder.viewPos - receiver.viewPos;
        float squared = max(dot(way, way), 1e-20);
        float cosine = max(dot(normal, way), 0.0) * inversesqrt(squared);
        occlusion += cosine * max(1.0 - squared / (radius * radius), 0.0);
    }
    visibility = clamp(1.0 - strength * occlusion / float(line_samples), 0.0, 1.0);
}
