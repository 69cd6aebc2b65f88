// How much of the light that leaves an occluder arrives: SSDO's senders (Ritschel, Grosch and Seidel 2009, section 3),
// for all methods that bounce light from what blocks.
//   f_i = A_s cosθ_s cosθ_r / d_i²,  A_s = bleeding π r_max² / N
// d is clamped from below; the paper clamps to 1, we to `distance_clamp` in scene units. With `patches` off, a sender fills
// its direction's share of the hemisphere instead, π/N over the density cosθ/π: what a ray tracer would do, and without a
// singularity. Back-facing senders, and those below the receiver's horizon, give nothing.

const bool patches;

uniform float bleeding;        // scales A_s
uniform float distance_clamp;  // scene units

float formFactor(Receiver receiver, Occluder occluder, vec3 occluderNormal) {
    vec3 toSender = occluder.viewPos - receiver.viewPos;
    float squaredDistance = max(dot(toSender, toSender), 1e-20);
    float facing = dot(occluderNormal, -toSender);   // d cosθ_s
    float rising = dot(receiver.normal, toSender);   // d cosθ_r
    float share = facing > 0.0 && rising > 0.0 ? 1.0 : 0.0;
    if (patches) {
        float clamped = max(squaredDistance, distance_clamp * distance_clamp);
        share *= radius * radius * rising * facing / (squaredDistance * clamped);
    }
    return bleeding * PI / float(directions) * share;
}
