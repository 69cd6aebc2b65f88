// Occluders: one depth layer, the camera's.
// "A sampling point is below the surface if its distance to the viewer decreases by projecting it onto the surface"
// (SSDO, Ritschel et al. 2009, section 3).

#include "occluders/surfaces.glsl"

// A blocker: its position in view space, and the place of its properties in the textures.
struct Occluder {
    vec3 viewPos;
    vec2 uv;
};

// Is the view-space point `samplePos` blocked for the receiver, and by what? The surface that is seen there has no known
// back: it is taken to be `thickness` deep, so that a far foreground throws no halo (Umenhoffer et al. 2009, section 4.3:
// R > z - z* > 0). The occluder is where the eye's ray to the point meets the surface.
bool isBlocked(Receiver receiver, vec3 samplePos, float thickness, out Occluder occluder) {
    occluder.uv = pixelAt(samplePos, pixel_from_ray) * texel_size;
    float surfaceZ = texture(viewZ, occluder.uv).r;
    occluder.viewPos = onRayOf(samplePos, surfaceZ);
    float depthBehind = surfaceZ - samplePos.z;
    return abs(depthBehind - 0.5 * thickness) < 0.5 * thickness;  // 0 < depthBehind < thickness in one comparison
}

// The occluder's unit normal, view space.
vec3 occluderNormal(Occluder occluder) {
    return texture(viewNormal, occluder.uv).xyz;
}

// The light that leaves the occluder.
vec3 occluderRadiance(Occluder occluder) {
    return texture(sender, occluder.uv).rgb;
}
