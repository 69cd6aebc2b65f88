// S3HO: local occlusion as spherical harmonics.
// Herholz, Schairer, Schilling and Straßer 2012, "Screen Space Spherical Harmonic Occlusion", Eq. 2:
//   c_i(P) = 4π/2N Σ V(s_j) y_i(s_j) (n·s_j)
// Here the directions have the density cosθ/π, so that (4π/2N) (n·s_j) is π/N for each; the paper's are uniform. The shader
// sums the blocked directions, because the coefficients of an open surface are known, those of the clamped cosine:
//   o_i(P) = π/N Σ (1 - V(s_j)) y_i(s_j),  c = c_cos(n) - o,
// with the same mean, and without noise where all is open. If `plain`, it sums the open directions, as the paper does.
//
// Inputs:  viewZ, viewNormal. Outputs: occlusion0 to occlusion3, the 16 coefficients o_i, view space.
// This is the plain form of the sum; s3ho.moments.frag is the fast one.

#include "s3ho.blocked.glsl"
#include "lib/sh.glsl"

const bool plain;

layout(location = 0) out vec4 occlusion0;
layout(location = 1) out vec4 occlusion1;
layout(location = 2) out vec4 occlusion2;
layout(location = 3) out vec4 occlusion3;

void main() {
    Receiver receiver;
    occlusion0 = occlusion1 = occlusion2 = occlusion3 = vec4(0.0);
    if (!receiverHere(receiver)) return;

    mat4 sum = mat4(0.0);
    for (int i = 0; i < directions; ++i) {
        vec3 viewDir = normalize(receiver.frame * kernel[i].xyz);
        float blocked = blockedShare(receiver, i);
        sum += (plain ? 1.0 - blocked : blocked) * shBasis(viewDir);
    }
    sum *= PI / float(directions);
    mat4 occlusion = plain ? shClampedCosine(receiver.normal) - sum : sum;
    occlusion0 = occlusion[0];
    occlusion1 = occlusion[1];
    occlusion2 = occlusion[2];
    occlusion3 = occlusion[3];
}
