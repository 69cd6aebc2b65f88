// Occluders: the relief of the receiver's own surface, a height map over its polygon, alone or together with the camera's
// depth (Umenhoffer et al. 2009, figure 3 and section 6). A point with the offset (d, Z) from the receiver, along the
// polygon and off it, is blocked if Z + h(uv) < h(uv + ∇uv d): the receiver itself lies on the relief.
//
// Reads: uv, reliefU, reliefV of the receiver; for the occluder's light, the pixel of its place on the polygon.

#include "occluders/surfaces.glsl"
#include "lib/relief.glsl"

const bool depth_too;

const float ROUNDING = 2e-3;   // of normals to half floats: the slope below which a plane does not block itself

uniform sampler2D uv;
uniform sampler2D reliefU;   // xyz the gradient of u, view space; w the map's number, 0 for none
uniform sampler2D reliefV;   // xyz the gradient of v; w the scale of the heights, negative on a surface's back

// Does the surface at this pixel have a height map? Then directions end at the relief, not at the polygon (lib/march.glsl).
#define RECEIVER_ON_RELIEF
bool isOnRelief(ivec2 pixel) {
    return texelFetch(reliefU, pixel, 0).w > 0.0;
}

// A blocker: its position in view space, its normal if it is a relief's, and the place of its light in the textures.
struct Occluder {
    vec3 viewPos;
    vec3 normal;
    bool inRelief;
    vec2 uv;
};

// Is the view-space point `samplePos` blocked for the receiver, and by what? The relief comes first.
bool isBlocked(Receiver receiver, vec3 samplePos, float thickness, out Occluder occluder) {
    vec4 byU = texelFetch(reliefU, receiver.pixel, 0), byV = texelFetch(reliefV, receiver.pixel, 0);
    int number = int(byU.w) - 1;
    float rise = 0.0;
    occluder.inRelief = false;
    if (number >= 0) {
        vec2 here = texelFetch(uv, receiver.pixel, 0).xy;
        vec4 rayFromPixel = vec4(1.0, 1.0, -pixel_from_ray.zw) / pixel_from_ray.xyxy;
        float surfaceZ = texelFetch(viewZ, receiver.pixel, 0).r;
        vec3 surfacePos = viewPosAt(vec2(receiver.pixel) + 0.5, surfaceZ, rayFromPixel);
        vec3 off = cross(byU.xyz, byV.xyz);   // the polygon's normal, on the viewer's side
        off = normalize(faceforward(off, sightTo(surfacePos), off));
        vec3 offset = samplePos - receiver.viewPos;   // the lift off the depth buffer's texels is not for the relief
        vec2 there = here + vec2(dot(byU.xyz, offset), dot(byV.xyz, offset));
        float above = dot(off, offset);
        rise = byV.w * heightAt(number, here);
        float obstacle = byV.w * heightAt(number, there) - rise;
        occluder.inRelief = above + ROUNDING * length(offset) < obstacle;
        occluder.viewPos = surfacePos + offset + off * (obstacle - above);
        vec2 slope = slopeAt(number, there);
        occluder.normal = normalize(off - byV.w * (slope.x * byU.xyz + slope.y * byV.xyz));
        occluder.uv = pixelAt(samplePos - off * above, pixel_from_ray) * texel_size;
        samplePos += off * max(rise, 0.0);    // for other surfaces the receiver stands as high as its relief
    }
    if (occluder.inRelief || !depth_too) return occluder.inRelief;
    occluder.uv = pixelAt(samplePos, pixel_from_ray) * texel_size;   // as in depth.glsl, which a product may include, too
    float behindZ = texture(viewZ, occluder.uv).r;
    occluder.viewPos = onRayOf(samplePos, behindZ);
    return abs(behindZ - samplePos.z - 0.5 * thickness) < 0.5 * thickness;
}

// The occluder's unit normal, view space.
vec3 occluderNormal(Occluder occluder) {
    return occluder.inRelief ? occluder.normal : texture(viewNormal, occluder.uv).xyz;
}

// The light that leaves the occluder.
vec3 occluderRadiance(Occluder occluder) {
    return texture(sender, occluder.uv).rgb;
}
