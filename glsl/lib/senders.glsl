// How much of the light that leaves an occluder arrives at the receiver, for every method that bounces light from
// occluders. The irradiance that occluder i causes is its radiance times
//   rays:     π/N, the share of direction i of N under the density cosθ/π: Monte Carlo integration, as a ray tracer has it;
//   patches:  A_s cosθ_s cosθ_r / d_i² × 1/(2 cosθ_i),  A_s = π r_max²/N  (Ritschel, Grosch and Seidel 2009, section 3).
// The paper's sum of patches is over uniform directions; 1/(2 cosθ_i) is the ratio of the two densities, uniform to cosine.
// The paper clamps d to at least 1; here the clamp is `distance_clamp`, in scene units. A sender that faces away from the
// receiver, or lies below its triangle's plane, contributes 0. `bleeding` scales both.

const bool patches;

uniform float bleeding;
uniform float distance_clamp;  // scene units

// `occluder` is the first one on direction `i`, and `occluderNormal` its unit normal in view space.
float formFactor(Receiver receiver, int i, Occluder occluder, vec3 occluderNormal) {
    vec3 toSender = occluder.viewPos - receiver.viewPos;
    float facing = dot(occluderNormal, -toSender);   // d cosθ_s
    float rising = max(dot(receiver.normal, toSender), 0.0);   // d cosθ_r
    float share = facing > 0.0 && dot(receiver.facet, toSender) > 0.0 ? 1.0 : 0.0;
    if (patches) {
        float squaredDistance = max(dot(toSender, toSender), 1e-20);
        float clamped = max(squaredDistance, distance_clamp * distance_clamp);
        float cosine = normalize(kernel[i].xyz).z;   // a kernel's vector is as long as it reaches
        share *= radius * radius * rising * facing / (squaredDistance * clamped) / (2.0 * cosine);
    }
    return bleeding * PI / float(directions) * share;
}
