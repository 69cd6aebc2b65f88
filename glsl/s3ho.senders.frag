// S3HO, the senders of one bounce: each occluder passes on the distant light that it reflects, whatever that will be.
// Herholz et al. 2012, Eq. 5:
//   c_SSGI(P) = Σ f(P, o_i) ρ_i/π c_cos(n_i)
// with the form factor of lib/senders.glsl. The cosine lobe ends with band 2: 9 coefficients, each red, green and blue.
//
// Inputs:  viewZ, viewNormal; sender, here the albedo of each surface.
// Outputs: bounce0 to bounce6: rgb coefficients 0 to 6, view space; the alphas of 0 to 2 hold the rgb of coefficient 7,
//          those of 3 to 5 that of 8.

#include "lib/march.glsl"
#include "lib/senders.glsl"
#include "lib/sh.glsl"

layout(location = 0) out vec4 bounce0;
layout(location = 1) out vec4 bounce1;
layout(location = 2) out vec4 bounce2;
layout(location = 3) out vec4 bounce3;
layout(location = 4) out vec4 bounce4;
layout(location = 5) out vec4 bounce5;
layout(location = 6) out vec4 bounce6;

void main() {
    Receiver receiver;
    bounce0 = bounce1 = bounce2 = bounce3 = bounce4 = bounce5 = bounce6 = vec4(0.0);
    if (!receiverHere(receiver)) return;

    vec3 sum[9] = vec3[9](vec3(0), vec3(0), vec3(0), vec3(0), vec3(0), vec3(0), vec3(0), vec3(0), vec3(0));
    for (int i = 0; i < directions; ++i) {
        Occluder first;
        if (!isWayBlocked(receiver, i, first)) continue;
        vec3 normal = occluderNormal(first);
        vec3 reflected = occluderRadiance(first) / PI * formFactor(receiver, first, normal);
        mat4 lobe = shClampedCosine(normal);
        for (int k = 0; k < 9; ++k) sum[k] += reflected * lobe[k / 4][k % 4];
    }
    bounce0 = vec4(sum[0], sum[7].r);
    bounce1 = vec4(sum[1], sum[7].g);
    bounce2 = vec4(sum[2], sum[7].b);
    bounce3 = vec4(sum[3], sum[8].r);
    bounce4 = vec4(sum[4], sum[8].g);
    bounce5 = vec4(sum[5], sum[8].b);
    bounce6 = vec4(sum[6], 0.0);
}
