// SSDO, one bounce: every occluder is a small patch that reflects the direct light stored for its pixel.
// Ritschel, Grosch and Seidel 2009, section 3:
//   L_ind(P) = Σ ρ/π L_pixel (1 - V(ω_i)) A_s cosθ_s cosθ_r / d_i²,  A_s = π r_max² / N
// d is clamped from below; the paper clamps to 1, we to `distance_clamp` in scene units. ρ/π waits for the lighting.
// With `patches` off, a sender fills its direction's share of the hemisphere instead, π/N over the density cosθ/π:
//   L_ind(P) = Σ ρ/π L_pixel (1 - V(ω_i)) π/N,
// which is what a ray tracer would do, and has no singularity. Back-facing senders, and those below the receiver's horizon, give nothing.
//
// Inputs:  viewZ, viewNormal; sender, the direct and ambient light that leaves each pixel (RGB radiance).
// Output:  bounce: rgb the irradiance from the senders.

#include "lib/space.glsl"
#include "lib/sampling.glsl"
#include "occluders.glsl"

const int directions;
const int steps;
const bool patches;

uniform float radius;          // scene units
uniform float bias;            // radii
uniform float thickness;       // radii
uniform float bleeding;        // scales A_s
uniform float distance_clamp;  // scene units
uniform vec4 kernel[directions];
uniform vec4 ray_from_pixel;

out vec4 bounce;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float centreZ = texelFetch(viewZ, pixel, 0).r;
    bounce = vec4(0.0);
    if (isBackground(centreZ)) return;

    vec3 normal = texelFetch(viewNormal, pixel, 0).xyz;
    vec3 viewPos = viewPosAt(gl_FragCoord.xy, centreZ, ray_from_pixel);
    viewPos += normal * liftOff(bias * radius, radius, viewPos, ray_from_pixel);
    int set = interleavedSet(pixel);
    mat3 frame = interleavedFrame(normal, set) * radius;

    vec3 sum = vec3(0.0);
    for (int i = 0; i < directions; ++i) {
        vec3 way = frame * kernel[i].xyz;
        float offset = interleavedOffset(kernel[i].w, set);
        bool blocked = false;
        Occluder first;
        for (int j = 0; j < steps; ++j) {
            Occluder occluder;
            vec3 samplePos = viewPos + way * ((float(j) + offset) / float(steps));
            bool hit = isBlocked(samplePos, thickness * radius, occluder);
            if (hit && !blocked) first = occluder;  // the first one along the way hides the others
            blocked = blocked || hit;
        }
        if (!blocked) continue;
        vec3 toSender = first.viewPos - viewPos;
        float squaredDistance = max(dot(toSender, toSender), 1e-20);
        float facing = dot(occluderNormal(first), -toSender);  // d cosθ_s
        float rising = dot(normal, toSender);                  // d cosθ_r
        float share = facing > 0.0 && rising > 0.0 ? 1.0 : 0.0;
        if (patches) {
            float clamped = max(squaredDistance, distance_clamp * distance_clamp);
            share *= radius * radius * rising * facing / (squaredDistance * clamped);
        }
        sum += occluderRadiance(first) * share;
    }
    bounce = vec4(bleeding * PI / float(directions) * sum, 1.0);  // A_s = π r²/N: its r² is in the share
}
