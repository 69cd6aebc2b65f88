// S3HO, the fast form of s3ho.frag: it sums moments of the directions (lib/sh_moments.glsl), and converts them to the
// coefficients once a pixel.
//
// Inputs:  viewZ, viewNormal. Outputs: occlusion0 to occlusion3, the 16 coefficients o_i, view space.

#include "s3ho.blocked.glsl"
#include "lib/sh_moments.glsl"

const bool plain;

layout(location = 0) out vec4 occlusion0;
layout(location = 1) out vec4 occlusion1;
layout(location = 2) out vec4 occlusion2;
layout(location = 3) out vec4 occlusion3;

void main() {
    Receiver receiver;
    occlusion0 = occlusion1 = occlusion2 = occlusion3 = vec4(0.0);
    if (!receiverHere(receiver)) return;

    Moments moments = NO_MOMENTS;
    for (int i = 0; i < directions; ++i) {
        vec3 viewDir = normalize(receiver.frame * kernel[i].xyz);
        float blocked = blockedShare(receiver, i);
        addDirection(moments, viewDir, plain ? 1.0 - blocked : blocked);
    }
    mat4 sum = shFromMoments(moments) * (PI / float(directions));
    mat4 occlusion = plain ? shClampedCosine(receiver.normal) - sum : sum;
    occlusion0 = occlusion[0];
    occlusion1 = occlusion[1];
    occlusion2 = occlusion[2];
    occlusion3 = occlusion[3];
}
