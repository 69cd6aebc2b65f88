// Positions from depth: the G-buffer keeps one number of a pixel's surface, its depth, and everything else follows from it.
//
// Inputs:  viewZ, the depth of each pixel's surface (scene units, negative; -infinity in the background);
//          ray_from_pixel and pixel_from_ray, scale (xy) and offset (zw) of a camera ray: see viewPosAt and pixelAt.
// Outputs: view_position and world_position: xyz the surface point, w 1 where there is a surface;
//          pixel_again: xy the pixel that sees the view-space point, which is this pixel;
//          depth_normal: xyz the unit normal in world space.

#include "lib/space.glsl"

uniform sampler2D viewZ;
uniform vec4 ray_from_pixel;
uniform vec4 pixel_from_ray;
uniform mat4 world_from_view;

out vec4 view_position;
out vec4 world_position;
out vec4 pixel_again;
out vec4 depth_normal;

const float FAR_AWAY = -1e30;  // the depth beyond the border of the picture

// The view-space point of the surface that `pixel` sees. Pixels are whole numbers here; their centres are at .5.
vec3 viewPosOf(ivec2 pixel) {
    if (pixel != clamp(pixel, ivec2(0), textureSize(viewZ, 0) - 1)) return vec3(0.0, 0.0, FAR_AWAY);
    return viewPosAt(vec2(pixel) + 0.5, texelFetch(viewZ, pixel, 0).r, ray_from_pixel);
}

// The same point in world space.
vec3 worldPosOf(vec3 viewPos) {
    return (world_from_view * vec4(viewPos, 1.0)).xyz;
}

// The vector along the surface from one pixel to the next in the direction `toNext`. Of the two neighbours, the one whose
// depth differs less is more likely to be on the same surface.
vec3 tangentAlong(ivec2 pixel, ivec2 toNext) {
    vec3 here = viewPosOf(pixel);
    vec3 after = viewPosOf(pixel + toNext) - here;
    vec3 before = here - viewPosOf(pixel - toNext);
    return abs(after.z) < abs(before.z) ? after : before;
}

// The unit normal of the surface, view space, which faces the camera.
vec3 normalFromDepth(ivec2 pixel) {
    return normalize(cross(tangentAlong(pixel, ivec2(1, 0)), tangentAlong(pixel, ivec2(0, 1))));
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    view_position = world_position = pixel_again = depth_normal = vec4(0.0);
    if (isBackground(texelFetch(viewZ, pixel, 0).r)) return;

    vec3 viewPos = viewPosOf(pixel);
    view_position = vec4(viewPos, 1.0);
    world_position = vec4(worldPosOf(viewPos), 1.0);
    pixel_again = vec4(pixelAt(viewPos, pixel_from_ray), 0.0, 1.0);
    depth_normal = vec4(mat3(world_from_view) * normalFromDepth(pixel), 1.0);
}
