// Occluders: the camera's depth, and what up to four more cameras see (SSDO, Ritschel et al. 2009, section 4, "Additional
// Cameras"). So hidden, grazing and off-screen surfaces take part.
// The paper does not say what to do where views disagree. What one camera sees is in the open, so a point is blocked if it
// lies behind the surface in every view that has it in its picture; of these surfaces the nearest is the occluder.
// With peeled layers in each view, it must besides be inside a solid in one of them, in place of within the thickness.

#include "lib/solids.glsl"

const int views;
const int view_layers;                       // peeled layers of each further view; 1 is plain depth

uniform sampler2D viewZ;
uniform sampler2D viewZ1;                    // of the further views: R32F, or RGBA32F with their layers
uniform sampler2D viewZ2;
uniform sampler2D viewZ3;
uniform sampler2D viewZ4;
uniform sampler2D viewNormal;
uniform sampler2D viewNormal1;
uniform sampler2D viewNormal2;
uniform sampler2D viewNormal3;
uniform sampler2D viewNormal4;
uniform sampler2D sender;                    // RGB radiance that leaves the surfaces that each view sees
uniform sampler2D sender1;
uniform sampler2D sender2;
uniform sampler2D sender3;
uniform sampler2D sender4;
uniform vec2 texel_size;                     // 1 / resolution
uniform vec4 pixel_from_ray;
uniform vec2 views_texel_size;
uniform vec4 views_pixel_from_ray;
uniform mat4 view_from_camera[4];            // a further view's space from the camera's view space
uniform mat4 camera_from_view[4];

const float UNKNOWN = 3.0e38;

// What blocks: where, in the camera's view space, and where its properties are stored. View 0 is the camera.
struct Occluder {
    vec3 viewPos;
    vec2 uv;
    int view;
};

vec4 depthsOf(int view, vec2 uv) {
    if (view == 1) return texture(viewZ1, uv);
    if (view == 2) return texture(viewZ2, uv);
    if (view == 3) return texture(viewZ3, uv);
    return texture(viewZ4, uv);
}

// Is the view-space point `samplePos` blocked, and by what? Off a view's picture its depth is +infinity: it has no say.
bool isBlocked(vec3 samplePos, float thickness, out Occluder occluder) {
    occluder.view = 0;
    occluder.uv = pixelAt(samplePos, pixel_from_ray) * texel_size;
    float surfaceZ = texture(viewZ, occluder.uv).r;
    bool onScreen = all(lessThan(abs(occluder.uv - 0.5), vec2(0.5)));
    float depthBehind = onScreen ? surfaceZ - samplePos.z : UNKNOWN;
    bool insideSolid = false;
    vec3 thereOfNearest = samplePos;
    float nearestZ = surfaceZ;
    for (int k = 1; k <= views; ++k) {
        vec3 there = (view_from_camera[k - 1] * vec4(samplePos, 1.0)).xyz;
        vec2 uv = pixelAt(there, views_pixel_from_ray) * views_texel_size;
        vec4 z = depthsOf(k, uv);
        if (view_layers > 1) insideSolid = insideSolid || solidAt(z, there.z, thickness) >= 0;
        float behind = z.x - there.z;
        // a texel's depth is its centre's, and P was lifted for the camera's pixels, not for these: where the camera has no
        // say, nothing within two pixels' width blocks, so that a plane up to 63 degrees off does not block itself
        if (!onScreen) behind += 2.0 * there.z / views_pixel_from_ray.x;
        if (behind < depthBehind) {
            depthBehind = behind;
            occluder.view = k;
            occluder.uv = uv;
            thereOfNearest = there;
            nearestZ = z.x;
        }
    }
    occluder.viewPos = thereOfNearest * (nearestZ / thereOfNearest.z);
    if (occluder.view > 0) occluder.viewPos = (camera_from_view[occluder.view - 1] * vec4(occluder.viewPos, 1.0)).xyz;
    if (view_layers > 1) return insideSolid && depthBehind > 0.0;
    return abs(depthBehind - 0.5 * thickness) < 0.5 * thickness;
}

// The occluder's unit normal, in the camera's view space.
vec3 occluderNormal(Occluder occluder) {
    if (occluder.view == 1) return mat3(camera_from_view[0]) * texture(viewNormal1, occluder.uv).xyz;
    if (occluder.view == 2) return mat3(camera_from_view[1]) * texture(viewNormal2, occluder.uv).xyz;
    if (occluder.view == 3) return mat3(camera_from_view[2]) * texture(viewNormal3, occluder.uv).xyz;
    if (occluder.view == 4) return mat3(camera_from_view[3]) * texture(viewNormal4, occluder.uv).xyz;
    return texture(viewNormal, occluder.uv).xyz;
}

// The light that leaves the occluder.
vec3 occluderRadiance(Occluder occluder) {
    if (occluder.view == 1) return texture(sender1, occluder.uv).rgb;
    if (occluder.view == 2) return texture(sender2, occluder.uv).rgb;
    if (occluder.view == 3) return texture(sender3, occluder.uv).rgb;
    if (occluder.view == 4) return texture(sender4, occluder.uv).rgb;
    return texture(sender, occluder.uv).rgb;
}
