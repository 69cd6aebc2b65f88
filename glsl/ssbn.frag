// SSBN: the mean open direction, the bent normal, and how much is open.
// Klehm, Ritschel, Eisemann and Seidel 2011, "Bent Normals and Cones in Screen-space":
//   b(P) = 1/N Σ V(s_j) s_j
// Directions have the density cosθ/π; `uniform_weights`, 1 / (2 cosθ), makes them count as if they were uniform over the
// hemisphere, as the paper's are. As in s3ho.frag what is summed are the blocked ones: of an open surface b is known, 2/3 n,
// or 1/2 n if uniform; so b = 2/3 n - 1/N Σ (1 - V) s_j, the same in the mean, and without noise where all is open.
//
// Inputs:  viewZ, viewNormal.
// Output:  blocked_direction: xyz 1/N Σ (1 - V) w_j s_j, world space, w the blocked share, Σ (1 - V) w_j / Σ w_j.

#include "lib/march.glsl"

const bool uniform_weights;

uniform mat4 world_from_view;

out vec4 blocked_direction;

void main() {
    Receiver receiver;
    blocked_direction = vec4(0.0);
    if (!receiverHere(receiver)) return;

    vec4 blocked = vec4(0.0);
    float weights = 0.0;
    for (int i = 0; i < directions; ++i) {
        vec4 direction = vec4(normalize(kernel[i].xyz), 1.0);  // a kernel's vector is as long as it reaches
        if (uniform_weights) direction *= 0.5 / direction.z;
        weights += direction.w;
        blocked += isWayBlocked(receiver, i) ? direction : vec4(0.0);
    }
    // the weights of N directions add up to N in the mean only: of themselves, what is closed is wholly closed
    blocked = vec4(blocked.xyz / float(directions), uniform_weights ? blocked.w / weights : blocked.w / float(directions));
    blocked_direction = vec4(mat3(world_from_view) * (receiver.frame * blocked.xyz), blocked.w);
}
