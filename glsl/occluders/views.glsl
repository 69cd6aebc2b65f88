// Occluders: the camera's depth, and what up to four more cameras see (SSDO, Ritschel et al. 2009, section 4, "Additional
// Cameras"). So hidden, grazing and off-screen surfaces take part.
// The paper leaves open what happens where views disagree. Between a camera and the surface that it sees is air, so a point
// is blocked if it lies behind the surface in every view that has it in its picture; of these surfaces the nearest is the
// occluder. With peeled layers in each view, the point must besides be inside a solid in one of them, in place of within
// the thickness.

#include "occluders/surfaces.glsl"
#include "lib/solids.glsl"

const int views;
const int view_layers;                       // peeled layers of each further view; 1 is plain depth

uniform sampler2D viewsZ;                    // atlases, a tile a view: R32F, or RGBA32F with their layers
uniform sampler2D viewsNormal;
uniform sampler2D viewsSender;               // RGB radiance that leaves the surfaces that each view sees
uniform vec4 tile_from_ray;                  // where a view's ray meets its picture, from -1 to 1
uniform vec2 tile_half;                      // half the size of a tile, as uv of the atlas
uniform float view_pixel_width;              // of a further view, at distance 1, or at all if it is orthographic
uniform mat4 view_from_camera[views];        // a further view's space from the camera's view space
uniform mat4 camera_from_view[views];

const float UNKNOWN = 3.0e38;

// A blocker: its position in the camera's view space, and the place of its properties. View 0 is the camera.
struct Occluder {
    vec3 viewPos;
    vec2 uv;         // of the camera's picture, or of the atlases
    int view;
};

// Is the view-space point `samplePos` blocked for the receiver, and by what? Outside of its picture, a view has no effect.
bool isBlocked(Receiver receiver, vec3 samplePos, float thickness, out Occluder occluder) {
    occluder.view = 0;
    occluder.uv = pixelAt(samplePos, pixel_from_ray) * texel_size;
    float surfaceZ = texture(viewZ, occluder.uv).r;
    bool onScreen = all(lessThan(abs(occluder.uv - 0.5), vec2(0.5)));
    float depthBehind = onScreen ? surfaceZ - samplePos.z : UNKNOWN;
    // a texel's depth is its centre's, and the receiver was lifted for the camera's pixels, not for a view's: off the
    // screen, nothing within two pixels' width blocks, so that a plane up to 63 degrees off does not block itself
    float margin = onScreen ? 0.0 : 2.0 * view_pixel_width;  // at distance 1, or at all distances
    bool insideSolid = false;
    vec3 thereOfNearest = samplePos;
    float nearestZ = surfaceZ;
    for (int k = 0; k < views; ++k) {
        vec3 there = (view_from_camera[k] * vec4(samplePos, 1.0)).xyz;
        vec2 inTile = pixelAt(there, tile_from_ray);
        bool inPicture = max(abs(inTile.x), abs(inTile.y)) < 1.0;
        vec2 uv = (inTile + vec2(2 * (k & 1) + 1, 2 * (k >> 1) + 1)) * tile_half;  // two tiles in a row
        vec4 z = texture(viewsZ, uv);
        if (view_layers > 1) insideSolid = insideSolid || (inPicture && solidAt(z, there.z, thickness) >= 0);
        float behind = inPicture ? z.x - there.z - margin * (orthographic ? 1.0 : -there.z) : UNKNOWN;
        if (behind < depthBehind) {
            depthBehind = behind;
            occluder.view = k + 1;
            occluder.uv = uv;
            thereOfNearest = there;
            nearestZ = z.x;
        }
    }
    occluder.viewPos = onRayOf(thereOfNearest, nearestZ);
    if (occluder.view > 0) occluder.viewPos = (camera_from_view[occluder.view - 1] * vec4(occluder.viewPos, 1.0)).xyz;
    if (view_layers > 1) return insideSolid && depthBehind > 0.0;
    return abs(depthBehind - 0.5 * thickness) < 0.5 * thickness;
}

// The occluder's unit normal, in the camera's view space.
vec3 occluderNormal(Occluder occluder) {
    if (occluder.view == 0) return texture(viewNormal, occluder.uv).xyz;
    return mat3(camera_from_view[occluder.view - 1]) * texture(viewsNormal, occluder.uv).xyz;
}

// The light that leaves the occluder.
vec3 occluderRadiance(Occluder occluder) {
    if (occluder.view == 0) return texture(sender, occluder.uv).rgb;
    return texture(viewsSender, occluder.uv).rgb;
}
