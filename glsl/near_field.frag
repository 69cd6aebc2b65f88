// The light of near surfaces that the clamp of virtual lights takes away, bounced on the screen (SSDO, Ritschel, Grosch and
// Seidel 2009, section 5, Fig. 12). A virtual light's geometry term G = cosθ cosθ_p / d² is clamped to c = a + b L, where L is
// the luminance that its surface sends. The rest of the integral has the weight (G - c)/G, and the first occluder on each
// direction is its sender:
//   E(P) = π/N Σ L_i max(0, 1 - c_i/G_i),   cosine-distributed directions.
//
// Inputs:  viewZ, viewNormal; sender, the lamps' light that each pixel reflects (RGB radiance).
// Output:  bounce: rgb the irradiance from the senders.

#include "lib/march.glsl"
#include "lib/constants.glsl"

uniform vec2 vpl_bound;   // (a, b) of the virtual lights' clamp, see aolab/pipeline/virtual_lights.py

const vec3 LUMINANCE = vec3(0.2126, 0.7152, 0.0722);   // of linear sRGB (ITU-R BT.709)

out vec4 bounce;

void main() {
    Receiver receiver;
    bounce = vec4(0.0);
    if (!receiverHere(receiver)) return;

    vec3 sum = vec3(0.0);
    for (int i = 0; i < directions; ++i) {
        Occluder first;
        if (firstBlocked(receiver, i, first) == OPEN) continue;
        vec3 toSender = first.viewPos - receiver.viewPos;
        float facing = dot(occluderNormal(first), -toSender), rising = dot(receiver.normal, toSender);
        if (facing <= 0.0 || rising <= 0.0) continue;
        float squared = dot(toSender, toSender);
        float geometry = facing * rising / max(squared * squared, 1e-20);
        vec3 radiance = occluderRadiance(first);
        float bound = vpl_bound.x + vpl_bound.y * dot(radiance, LUMINANCE);
        sum += radiance * max(1.0 - bound / geometry, 0.0);
    }
    bounce = vec4(PI / float(directions) * sum, 1.0);
}
