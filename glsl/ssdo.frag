// SSDO, direct light: the environment's light from the open directions only.
// Ritschel, Grosch and Seidel 2009, "Approximating Dynamic Global Illumination in Image Space", section 3:
//   L_dir(P) = Σ ρ/π L_in(ω_i) V(ω_i) cosθ_i Δω
// Here the directions have the density cosθ/π, so that cosθ_i Δω is π/N for each; the paper's are uniform. Under a
// constant sky this is exactly SSAO with the same samples; on an open plane, exactly ρ L. ρ/π waits for the lighting.
//
// Inputs:  viewZ, viewNormal; prefiltered_environment, an octahedral map blurred to a sample's solid angle.
// Output:  irradiance: rgb the environment's irradiance with occlusion, a the visibility in [0, 1].
// kernel[i]: xyz a direction around +z times its reach in radii, w its first sample's offset, in steps.

#include "lib/space.glsl"
#include "lib/sampling.glsl"
#include "lib/octahedral.glsl"
#include "occluders.glsl"

const int directions;
const int steps;

uniform float radius;     // scene units
uniform float bias;       // radii
uniform float thickness;  // radii
uniform vec4 kernel[directions];
uniform sampler2D prefiltered_environment;
uniform vec4 ray_from_pixel;
uniform mat4 world_from_view;

out vec4 irradiance;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float centreZ = texelFetch(viewZ, pixel, 0).r;
    irradiance = vec4(0.0, 0.0, 0.0, 1.0);
    if (isBackground(centreZ)) return;

    vec3 normal = texelFetch(viewNormal, pixel, 0).xyz;
    vec3 viewPos = viewPosAt(gl_FragCoord.xy, centreZ, ray_from_pixel);
    viewPos += normal * liftOff(bias * radius, radius, viewPos, ray_from_pixel);
    int set = interleavedSet(pixel);
    mat3 frame = interleavedFrame(normal, set);
    mat3 worldFrame = mat3(world_from_view) * frame;
    frame *= radius;

    vec3 light = vec3(0.0);
    float open = 0.0;
    for (int i = 0; i < directions; ++i) {
        vec3 way = frame * kernel[i].xyz;
        float offset = interleavedOffset(kernel[i].w, set);
        bool blocked = false;
        for (int j = 0; j < steps; ++j) {
            Occluder occluder;
            vec3 samplePos = viewPos + way * ((float(j) + offset) / float(steps));
            blocked = isBlocked(samplePos, thickness * radius, occluder) || blocked;
        }
        float openness = blocked ? 0.0 : 1.0;
        light += openness * texture(prefiltered_environment, octahedralUv(worldFrame * kernel[i].xyz)).rgb;
        open += openness;
    }
    irradiance = min(vec4(PI * light, open) / float(directions), 65504.0);  // the target's largest number
}
