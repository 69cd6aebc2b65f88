// SSDO, one bounce: every occluder reflects the light that is stored for its pixel.
// Ritschel, Grosch and Seidel 2009, section 3:
//   L_ind(P) = Σ ρ/π L_pixel (1 - V(ω_i)) f_i
// with the form factor f_i of lib/senders.glsl. The lighting multiplies by ρ/π.
//
// Inputs:  viewZ, viewNormal; sender, the direct and ambient light that leaves each pixel (RGB radiance).
// Output:  bounce: rgb the irradiance from the senders.

#include "lib/march.glsl"
#include "lib/senders.glsl"

out vec4 bounce;

void main() {
    Receiver receiver;
    bounce = vec4(0.0);
    if (!receiverHere(receiver)) return;

    vec3 sum = vec3(0.0);
    for (int i = 0; i < directions; ++i) {
        Occluder first;
        if (firstBlocked(receiver, i, first) != OPEN) {
            sum += occluderRadiance(first) * formFactor(receiver, i, first, occluderNormal(first));
        }
    }
    bounce = vec4(sum, 1.0);
}
