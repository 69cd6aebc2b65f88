// Occluders: peeled depth layers of the camera (SSDO, Ritschel et al. 2009, section 4; Everitt 2001). A point between the
// two sides of a solid is blocked, and one behind it is not.

#include "occluders/surfaces.glsl"
#include "lib/solids.glsl"

uniform sampler2D layersZ;     // RGBA32F: viewZ of the layers 0 to 3, -infinity where there is none, and off the screen
uniform sampler2D viewNormal1;
uniform sampler2D viewNormal2;
uniform sampler2D viewNormal3;
uniform sampler2D sender1;     // RGB radiance that leaves the surfaces of each layer
uniform sampler2D sender2;
uniform sampler2D sender3;

// A blocker: its position in view space, and the place of its properties in the textures.
struct Occluder {
    vec3 viewPos;
    vec2 uv;
    int layer;
};

// Is the view-space point `samplePos` blocked for the receiver, and by what? The occluder is the nearer side of the solid
// that it is in.
bool isBlocked(Receiver receiver, vec3 samplePos, float thickness, out Occluder occluder) {
    occluder.uv = pixelAt(samplePos, pixel_from_ray) * texel_size;
    vec4 z = texture(layersZ, occluder.uv);
    occluder.layer = solidAt(z, samplePos.z, thickness);
    occluder.viewPos = onRayOf(samplePos, z[max(occluder.layer, 0)]);
    return occluder.layer >= 0;
}

// The occluder's unit normal, view space.
vec3 occluderNormal(Occluder occluder) {
    if (occluder.layer == 1) return texture(viewNormal1, occluder.uv).xyz;
    if (occluder.layer == 2) return texture(viewNormal2, occluder.uv).xyz;
    if (occluder.layer == 3) return texture(viewNormal3, occluder.uv).xyz;
    return texture(viewNormal, occluder.uv).xyz;
}

// The light that leaves the occluder.
vec3 occluderRadiance(Occluder occluder) {
    if (occluder.layer == 1) return texture(sender1, occluder.uv).rgb;
    if (occluder.layer == 2) return texture(sender2, occluder.uv).rgb;
    if (occluder.layer == 3) return texture(sender3, occluder.uv).rgb;
    return texture(sender, occluder.uv).rgb;
}
