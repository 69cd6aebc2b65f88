// S3HO, the senders of one bounce: each occluder reflects distant light that is not known yet.
// Herholz et al. 2012, Eq. 5:
//   c_SSGI(P) = Σ f(P, o_i) ρ_i/π c_cos(n_i)
// with the form factor of lib/senders.glsl. An occluder reflects as much as it blocks (s3ho.blocked.glsl). The clamped
// cosine has no band 3, so that 9 coefficients are enough: each is red, green and blue.
//
// Inputs:  viewZ, viewNormal; sender, here the albedo of each surface.
// Outputs: bounce0 to bounce6: the coefficients, view space, and Σ w_i |d_i|², as s3ho.packing.glsl packs them.
//          sender_offset: rgb Σ w_i d_i, a Σ w_i, where w_i is the form factor of occluder i and d_i its offset from P, view
//          space, in radii: s3ho.indirect.frag looks the lights' shadows up there.

#include "s3ho.blocked.glsl"
#include "lib/senders.glsl"
#include "lib/sh.glsl"
#include "s3ho.packing.glsl"

out vec4 bounce0;
out vec4 bounce1;
out vec4 bounce2;
out vec4 bounce3;
out vec4 bounce4;
out vec4 bounce5;
out vec4 bounce6;
out vec4 sender_offset;

void main() {
    Receiver receiver;
    bounce0 = bounce1 = bounce2 = bounce3 = bounce4 = bounce5 = bounce6 = sender_offset = vec4(0.0);
    if (!receiverHere(receiver)) return;

    vec3 sum[9] = vec3[9](vec3(0), vec3(0), vec3(0), vec3(0), vec3(0), vec3(0), vec3(0), vec3(0), vec3(0));
    float squaredOffset = 0.0;
    for (int i = 0; i < directions; ++i) {
        Occluder first;
        float blocked = blockedShare(receiver, i, first);
        if (blocked == 0.0) continue;
        vec3 normal = occluderNormal(first);
        float weight = blocked * formFactor(receiver, i, first, normal);
        vec3 reflected = occluderRadiance(first) / PI * weight;
        mat4 lobe = shClampedCosine(normal);
        for (int k = 0; k < 9; ++k) sum[k] += reflected * lobe[k / 4][k % 4];
        vec3 offset = (first.viewPos - receiver.viewPos) / radius;
        sender_offset += weight * vec4(offset, 1.0);
        squaredOffset += weight * dot(offset, offset);
    }
    vec4 texels[7] = packBounce(sum, squaredOffset);
    bounce0 = texels[0];
    bounce1 = texels[1];
    bounce2 = texels[2];
    bounce3 = texels[3];
    bounce4 = texels[4];
    bounce5 = texels[5];
    bounce6 = texels[6];
}
