// The surface that a pixel shows, as the lighting reads it from the G-buffer. Each term of the lighting is a function of it,
// which returns the linear RGB radiance that the surface sends to the eye: directAt, ambientAt, indirectAt. The plain passes
// direct.frag, ambient.frag and indirect.frag store one term each; image.frag adds them up.

#include "lib/space.glsl"
#include "lib/palette.glsl"

const bool has_palette;   // a palette stands for the buffer `albedo`

uniform sampler2D viewZ;
uniform sampler2D viewNormal;
uniform sampler2D albedo;
uniform vec4 ray_from_pixel;
uniform vec2 texel_size;
uniform mat4 world_from_view;

struct Surface {
    ivec2 pixel;
    vec3 viewPos;      // view space, scene units
    vec3 viewNormal;   // view space, unit
    vec3 albedo;       // linear RGB
};

// Reads the surface of this fragment. Returns false in the background.
bool surfaceHere(out Surface surface) {
    vec2 uv = gl_FragCoord.xy * texel_size;
    float surfaceZ = texture(viewZ, uv).r;
    vec4 normal = texture(viewNormal, uv);   // w: the number of the mesh
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 reflected = (has_palette ? paletteAlbedo(pixel, normal.w) : texture(albedo, uv)).rgb;
    surface = Surface(pixel, viewPosAt(gl_FragCoord.xy, surfaceZ, ray_from_pixel), normal.xyz, reflected);
    return !isBackground(surfaceZ);
}

// The world-space point at which light arrives, for shadow maps.
vec3 litPosOf(Surface surface) {
    vec3 viewPos = litPoint(surface.viewPos, surface.viewNormal, ray_from_pixel);
    return (world_from_view * vec4(viewPos, 1.0)).xyz;
}

vec3 worldNormalOf(Surface surface) {
    return mat3(world_from_view) * surface.viewNormal;
}
