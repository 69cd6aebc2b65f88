// SSBN: the bent normal b, the mean open direction, and the visibility.
// Klehm, Ritschel, Eisemann and Seidel 2011, "Bent Normals and Cones in Screen-space":
//   b(P) = 1/N Σ V(s_j) s_j
// Differences from the paper:
// - Directions have the density cosθ/π; the paper's are uniform over the hemisphere. `uniform_weights` gives them the
//   weights w_j = 1 / (2 cosθ), which turn the mean into the paper's. Otherwise w_j = 1.
// - The shader sums the blocked directions, like s3ho.frag. For an open surface b is known: 2/3 n, with uniform weights
//   1/2 n. So b = 2/3 n - 1/N Σ (1 - V) s_j, which has the same mean, and no noise if all directions are open.
//
// Inputs:  viewZ (scene units, negative); viewNormal (view space, unit length).
// Output:  blocked_direction: xyz = 1/N Σ (1 - V) w_j s_j, world space; w = Σ (1 - V) w_j / Σ w_j, the blocked share.

#include "lib/march.glsl"

const bool uniform_weights;

out vec4 blocked_direction;

void main() {
    Receiver receiver;
    blocked_direction = vec4(0.0);
    if (!receiverHere(receiver)) return;

    vec4 blocked = vec4(0.0);
    float weights = 0.0;
    for (int i = 0; i < directions; ++i) {
        vec4 direction = vec4(normalize(kernel[i].xyz), 1.0);  // the length of a kernel's vector is its reach
        if (uniform_weights) direction *= 0.5 / direction.z;
        weights += direction.w;
        blocked += isWayBlocked(receiver, i) ? direction : vec4(0.0);
    }
    // uniform weights add up to N in the mean only; the share of their sum is exactly 1 if all directions are blocked
    blocked = vec4(blocked.xyz / float(directions), uniform_weights ? blocked.w / weights : blocked.w / float(directions));
    blocked_direction = vec4(mat3(world_from_view) * (receiver.frame * blocked.xyz), blocked.w);
}
