// SSBN, the environment's light: as much as is open of what a cone around the bent normal sees.
// Klehm, Ritschel, Eisemann and Seidel 2011: the cone's width follows from the bent normal's length. Here it is exact for a
// surface that is open in just such a cone: there, with c the cosine of its half angle, the mean direction's length is
//   ∫ cos²θ dω / ∫ cosθ dω = 2/3 (1 + c + c²) / (1 + c)  over the density cosθ/π,
//   ∫ cosθ dω / ∫ dω = 1/2 (1 + c)                       if directions are uniform.
// Where all is open c is 0, and E is exactly the environment's irradiance.
// Inputs: viewNormal, albedo, blocked_direction; cone_environment, the mean radiance in cones (aolab/scene/cones.py).
// Output: ambient, linear RGB radiance: albedo × visibility × mean radiance.

#include "lib/octahedral.glsl"

const bool uniform_weights;
const int cone_slices;     // of the table, from the narrowest cone to the hemisphere
const int cone_texels;     // of a slice's side, a border of one around it

uniform sampler2D viewNormal;
uniform sampler2D albedo;
uniform sampler2D blocked_direction;
uniform sampler2D cone_environment;
uniform mat4 world_from_view;

out vec4 ambient;

// The mean radiance in the cone of half angle `angle`, a share of the right angle, around `worldDir`.
vec3 radianceInCone(vec3 worldDir, float angle) {
    float slice = clamp(angle * float(cone_slices) - 1.0, 0.0, float(cone_slices - 1));
    float lower = min(floor(slice), float(cone_slices - 2));
    float side = float(cone_texels + 2);
    vec2 inSlice = (octahedralUv(worldDir) * float(cone_texels) + 1.0) / side;
    vec3 narrow = texture(cone_environment, vec2(inSlice.x, (inSlice.y + lower) / float(cone_slices))).rgb;
    vec3 wide = texture(cone_environment, vec2(inSlice.x, (inSlice.y + lower + 1.0) / float(cone_slices))).rgb;
    return mix(narrow, wide, slice - lower);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 surfaceAlbedo = texelFetch(albedo, pixel, 0);
    ambient = vec4(0.0);
    if (surfaceAlbedo.a == 0.0) return;  // background

    vec3 worldNormal = mat3(world_from_view) * texelFetch(viewNormal, pixel, 0).xyz;
    vec4 blocked = texelFetch(blocked_direction, pixel, 0);
    // ∫ V cosθ dω is there both times: of uniform directions it is the part of b along the normal
    float visibility = clamp(1.0 - (uniform_weights ? 2.0 * dot(blocked.xyz, worldNormal) : blocked.w), 0.0, 1.0);
    vec3 bent = (uniform_weights ? 1.0 / 2.0 : 2.0 / 3.0) * worldNormal - blocked.xyz;
    float size = length(bent) / max(1.0 - blocked.w, 1e-4);
    float k = clamp(1.5 * size - 1.0, 0.0, 0.5);  // c² - k c - k = 0
    float cosine = uniform_weights ? clamp(2.0 * size - 1.0, 0.0, 1.0) : 0.5 * (k + sqrt(k * k + 4.0 * k));
    float angle = acos(min(cosine, 1.0)) * (2.0 / 3.14159265358979);
    // nothing open, nothing bent: any direction will do
    vec3 direction = dot(bent, bent) > 1e-12 ? bent : worldNormal;
    ambient = vec4(surfaceAlbedo.rgb * visibility * radianceInCone(direction, angle), 1.0);
}
