// Occluders: one depth layer, of a view whose picture is a tile of an atlas. Otherwise as in depth.glsl.

#include "occluders/surfaces.glsl"

uniform vec4 view_region;   // the tile, uv of the atlas: lower left corner (xy), upper right corner (zw)

struct Occluder {
    vec3 viewPos;
    vec2 uv;
};

bool isBlocked(Receiver receiver, vec3 samplePos, float thickness, out Occluder occluder) {
    occluder.uv = pixelAt(samplePos, pixel_from_ray) * texel_size;
    float surfaceZ = texture(viewZ, occluder.uv).r;
    occluder.viewPos = onRayOf(samplePos, surfaceZ);
    bool inPicture = occluder.uv == clamp(occluder.uv, view_region.xy, view_region.zw);
    return inPicture && abs(surfaceZ - samplePos.z - 0.5 * thickness) < 0.5 * thickness;
}

vec3 occluderNormal(Occluder occluder) {
    return texture(viewNormal, occluder.uv).xyz;
}

vec3 occluderRadiance(Occluder occluder) {
    return texture(sender, occluder.uv).rgb;
}
