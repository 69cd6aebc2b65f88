// S3HO: local occlusion as spherical harmonics.
// Herholz, Schairer, Schilling and Straßer 2012, "Screen Space Spherical Harmonic Occlusion", Eq. 2:
//   c_i(P) = 4π/2N Σ V(s_j) y_i(s_j) (n·s_j)
// Here the directions have the density cosθ/π, so that (4π/2N) (n·s_j) is π/N for each; the paper's are uniform. And what
// is summed are the blocked directions, for an open surface's c is known, the clamped cosine's:
//   o_i(P) = π/N Σ (1 - V(s_j)) y_i(s_j),  c = c_cos(n) - o,
// the same in the mean, and without noise where all is open.
//
// Inputs:  viewZ, viewNormal. Outputs: occlusion0 to occlusion3, the 16 coefficients o_i, view space.
// This is the plain form; s3ho.moments.frag is the fast one.

#include "s3ho.blocked.glsl"
#include "lib/sh.glsl"

layout(location = 0) out vec4 occlusion0;
layout(location = 1) out vec4 occlusion1;
layout(location = 2) out vec4 occlusion2;
layout(location = 3) out vec4 occlusion3;

void main() {
    Receiver receiver;
    occlusion0 = occlusion1 = occlusion2 = occlusion3 = vec4(0.0);
    if (!receiverHere(receiver)) return;

    mat4 blocked = mat4(0.0);
    for (int i = 0; i < directions; ++i) {
        vec3 viewDir = normalize(receiver.frame * kernel[i].xyz);
        blocked += blockedShare(receiver, i) * shBasis(viewDir);
    }
    blocked *= PI / float(directions);
    occlusion0 = blocked[0];
    occlusion1 = blocked[1];
    occlusion2 = blocked[2];
    occlusion3 = blocked[3];
}
