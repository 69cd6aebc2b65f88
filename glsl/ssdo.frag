// SSDO, direct light: the environment's light from the open directions.
// Ritschel, Grosch and Seidel 2009, "Approximating Dynamic Global Illumination in Image Space", section 3:
//   L_dir(P) = Σ ρ/π L_in(ω_i) V(ω_i) cosθ_i Δω
// Here the directions have the density cosθ/π, so that cosθ_i Δω is π/N for each, and the sum is ρ times the mean of
// V L_in; the paper's directions are uniform. The albedo ρ enters in ssdo.ambient.glsl.
//
// Inputs:  viewZ, viewNormal; prefiltered_environment, an octahedral map blurred to a sample's solid angle.
// Outputs: open_light: rgb the mean over all directions of V L_in, linear radiance; a the visibility in [0, 1].
//          all_light:  rgb the mean of L_in; only `estimator="blocked"` reads it.

#include "lib/march.glsl"
#include "lib/octahedral.glsl"

uniform sampler2D prefiltered_environment;

layout(location = 0) out vec4 open_light;
layout(location = 1) out vec4 all_light;

const float LARGEST = 65504.0;  // of half floats, which the outputs are

void main() {
    Receiver receiver;
    open_light = vec4(0.0, 0.0, 0.0, 1.0);
    all_light = vec4(0.0);
    if (!receiverHere(receiver)) return;

    mat3 worldFrame = mat3(world_from_view) * receiver.frame;
    vec4 open = vec4(0.0), all = vec4(0.0);
    for (int i = 0; i < directions; ++i) {
        vec4 light = vec4(texture(prefiltered_environment, octahedralUv(worldFrame * kernel[i].xyz)).rgb, 1.0);
        open += isWayBlocked(receiver, i) ? vec4(0.0) : light;
        all += light;
    }
    open_light = min(open / float(directions), LARGEST);
    all_light = min(all / float(directions), LARGEST);
}
