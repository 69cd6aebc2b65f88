// SSBN, ambient light: the mean radiance of the environment in a cone around the bent normal, times the visibility.
// Klehm, Ritschel, Eisemann and Seidel 2011, "Bent Normals and Cones in Screen-space": the length of the bent normal
// determines the width of the cone.
// Difference from the paper: the width is exact for a surface that is open in just a cone around its normal. Let c be
// the cosine of the cone's half angle. The length of the mean open direction is
//   ∫ cos²θ dω / ∫ cosθ dω = 2/3 (1 + c + c²) / (1 + c)  for directions with the density cosθ/π,
//   ∫ cosθ dω / ∫ dω = 1/2 (1 + c)                       for uniform directions.
// An open surface has c = 0 and receives exactly the environment's irradiance.
//
// L = albedo × visibility × mean radiance.
// Inputs:  the surface; blocked_direction (ssbn.frag); cone_environment: mean radiance in cones, linear RGB
//          (aolab/scene/cones.py).

#include "lib/octahedral.glsl"
#include "lib/constants.glsl"

const bool uniform_weights;
const int cone_slices;     // slices of the table, from the narrowest cone to the hemisphere
const int cone_texels;     // width of a slice, without its border of one texel

uniform sampler2D blocked_direction;
uniform sampler2D cone_environment;

// The mean radiance in the cone around `worldDir`; `angle`: its half angle as a share of a right angle.
vec3 radianceInCone(vec3 worldDir, float angle) {
    float slice = clamp(angle * float(cone_slices) - 1.0, 0.0, float(cone_slices - 1));
    float lower = min(floor(slice), float(cone_slices - 2));
    float side = float(cone_texels + 2);
    vec2 inSlice = (octahedralUv(worldDir) * float(cone_texels) + 1.0) / side;
    vec3 narrow = texture(cone_environment, vec2(inSlice.x, (inSlice.y + lower) / float(cone_slices))).rgb;
    vec3 wide = texture(cone_environment, vec2(inSlice.x, (inSlice.y + lower + 1.0) / float(cone_slices))).rgb;
    return mix(narrow, wide, slice - lower);
}

vec3 ambientAt(Surface surface) {
    vec3 worldNormal = worldNormalOf(surface);
    vec4 blocked = texelFetch(blocked_direction, surface.pixel, 0);
    // visibility, (1/π) ∫ V cosθ dω; for uniform directions it follows from the component of b along the normal
    float visibility = clamp(1.0 - (uniform_weights ? 2.0 * dot(blocked.xyz, worldNormal) : blocked.w), 0.0, 1.0);
    vec3 bent = (uniform_weights ? 1.0 / 2.0 : 2.0 / 3.0) * worldNormal - blocked.xyz;
    float size = length(bent) / max(1.0 - blocked.w, 1e-4);
    float k = clamp(1.5 * size - 1.0, 0.0, 0.5);  // c² - k c - k = 0
    float cosine = uniform_weights ? clamp(2.0 * size - 1.0, 0.0, 1.0) : 0.5 * (k + sqrt(k * k + 4.0 * k));
    float angle = acos(min(cosine, 1.0)) * (2.0 / PI);
    // nothing open: b has no direction, and visibility is 0 in any direction
    vec3 direction = dot(bent, bent) > 1e-12 ? bent : worldNormal;
    return surface.albedo * visibility * radianceInCone(direction, angle);
}
