// SSDO, the lights: the share of their light that nothing on the screen blocks.
// Ritschel, Grosch and Seidel 2009, section 3, "Point light": the samples lie on the segment of length r_max towards the
// light. Here the segment ends at a light that is nearer, and its length is drawn as a kernel's reach is, for the falloff.
//
// Inputs:  viewZ, viewNormal; the lights with their shadow maps.
// Output:  light_share: rgb Σ E_i V_i / Σ E_i over the lights' irradiances E_i; 1 where no light arrives.

#include "lib/march.glsl"
#include "lib/lights.glsl"
#include "lib/segment.glsl"
#include "lib/fill.glsl"

const int light_steps;   // samples on the way to each light

uniform vec2 light_samples[16];   // of each set of samples: the way's length, in radii, and its first offset, in steps

out vec4 light_share;

void main() {
    Receiver receiver;
    light_share = vec4(1.0);
    if (lights == 0 || !receiverHere(receiver)) return;

    vec2 way = light_samples[receiver.set];
    vec3 surfacePos = viewPosAt(gl_FragCoord.xy, texelFetch(viewZ, receiver.pixel, 0).r, ray_from_pixel);
    vec3 worldPos = (world_from_view * vec4(litPoint(surfacePos, receiver.normal, ray_from_pixel), 1.0)).xyz;
    vec3 worldNormal = mat3(world_from_view) * receiver.normal;
    vec3 all = vec3(0.0), arriving = vec3(0.0);
    for (int i = 0; i < lights; ++i) {
        vec3 toLight;
        vec3 irradiance = irradianceFrom(i, worldPos, worldNormal, toLight);
        float reach = radius * way.x;
        reach = min(reach, distanceOf(i, worldPos));
        all += irradiance;
        if (irradiance == vec3(0.0)) continue;
        vec3 viewToLight = mat3(view_from_world) * toLight;
        if (!isSegmentOpen(receiver, viewToLight, reach, way.y, light_steps, thickness * radius)) continue;
        if (isFilledOpen(receiver, tileOf(i, toLight), surfacePos, worldPos, viewToLight, distanceOf(i, worldPos), ray_from_pixel)) {
            arriving += irradiance;
        }
    }
    light_share.rgb = mix(vec3(1.0), arriving / max(all, 1e-20), vec3(greaterThan(all, vec3(0.0))));
}
