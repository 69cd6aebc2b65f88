// Ambient transfer: the share of the ambient light that arrives, with the reflections of the surroundings.
// Umenhoffer, Tóth and Szirmay-Kalos 2009, "Efficient Methods for Ambient Lighting", equation 9:
//   W(x) = Σ I(p_i) / (n - Σ (1 - I(p_i)) ã(p_i)),  p_i = x + ω_i r_i,  r_i = μ⁻¹(ξ_i)
// I is 1 if none of the `steps` points x + ω_i r_i j/m is blocked; ã is the albedo of the occluder of the first of them.
// The division follows after the filter. Difference from the paper: pixels of a 4×4 block do not only turn the samples,
// but also shift their ξ_i, so that the block has 16 times as many distances.
//
// Inputs:  viewZ, viewNormal; sender: the albedo of the surfaces, or what they reflect in units of the ambient light.
//          kernel[i]: xyz the unit direction ω_i around +z, with density cosθ/π; w the share ξ_i.
// Output:  transfer_terms: rgb the denominator, a the numerator, both divided by n.

#include "lib/march.glsl"
#include "measure.glsl"

const bool silhouette_elimination;

uniform float measure_farthest;  // of a sample, radii

out vec4 transfer_terms;

// More than any surface can be in front of `samplePos`, scene units: then R > z - z* is no limit.
float solidWithoutEnd(vec3 samplePos) {
    return 2.0 * max(-samplePos.z, radius);
}

void main() {
    Receiver receiver;
    transfer_terms = vec4(1.0, 1.0, 1.0, 0.0);
    if (!receiverHere(receiver, measure_farthest * radius)) return;

    vec3 reflecting = vec3(0.0);
    float open = 0.0;
    for (int i = 0; i < directions; ++i) {
        float share = interleavedOffset(kernel[i].w, receiver.set);
        vec3 way = wayAlong(receiver, receiver.frame * kernel[i].xyz * (radius * measureInverse(share)));
        bool blocked = false;
        Occluder first;
        for (int j = 1; j <= steps; ++j) {
            vec3 samplePos = receiver.viewPos + way * (float(j) / float(steps));
            // R > z - z* > 0, section 4.3
            float solid = silhouette_elimination ? thickness * radius : solidWithoutEnd(samplePos);
            Occluder occluder;
            bool hit = isBlocked(receiver, samplePos, solid, occluder) && !blocked;
            if (hit) first = occluder;
            blocked = blocked || hit;
        }
        reflecting += blocked ? occluderRadiance(first) : vec3(0.0);
        open += blocked ? 0.0 : 1.0;
    }
    transfer_terms = vec4(float(directions) - reflecting, open) / float(directions);
}
