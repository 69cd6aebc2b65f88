// SSDO, direct light: the environment's light from the open directions only.
// Ritschel, Grosch and Seidel 2009, "Approximating Dynamic Global Illumination in Image Space", section 3:
//   L_dir(P) = Σ ρ/π L_in(ω_i) V(ω_i) cosθ_i Δω
// Here the directions have the density cosθ/π, so that cosθ_i Δω is π/N for each; the paper's are uniform. Under a
// constant sky this is exactly SSAO with the same samples; on an open plane, exactly ρ L. ρ/π waits for the lighting.
//
// Inputs:  viewZ, viewNormal; prefiltered_environment, an octahedral map blurred to a sample's solid angle.
// Output:  irradiance: rgb the environment's irradiance with occlusion, a the visibility in [0, 1].

#include "lib/march.glsl"
#include "lib/octahedral.glsl"

uniform sampler2D prefiltered_environment;
uniform mat4 world_from_view;

out vec4 irradiance;

void main() {
    Receiver receiver;
    irradiance = vec4(0.0, 0.0, 0.0, 1.0);
    if (!receiverHere(receiver)) return;

    mat3 worldFrame = mat3(world_from_view) * receiver.frame;
    vec3 light = vec3(0.0);
    float open = 0.0;
    for (int i = 0; i < directions; ++i) {
        float openness = isWayBlocked(receiver, i) ? 0.0 : 1.0;
        light += openness * texture(prefiltered_environment, octahedralUv(worldFrame * kernel[i].xyz)).rgb;
        open += openness;
    }
    irradiance = min(vec4(PI * light, open) / float(directions), 65504.0);  // the target's largest number
}
