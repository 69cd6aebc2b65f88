// S3HO, the fast form of s3ho.frag: what is summed are moments of the blocked directions (lib/sh_moments.glsl), from which
// the coefficients are made once a pixel.
//
// Inputs:  viewZ, viewNormal. Outputs: occlusion0 to occlusion3, the 16 coefficients o_i, view space.

#include "s3ho.blocked.glsl"
#include "lib/sh_moments.glsl"

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
        addDirection(moments, viewDir, blockedShare(receiver, i));
    }
    mat4 blocked = shFromMoments(moments) * (PI / float(directions));
    occlusion0 = blocked[0];
    occlusion1 = blocked[1];
    occlusion2 = blocked[2];
    occlusion3 = blocked[3];
}
