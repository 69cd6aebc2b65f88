// S3HO, one bounce: the senders' coefficients under all light, Herholz et al. 2012, Eq. 3 to 5:
//   E(P) = (c_env + Σ c_l) · c_SSGI(P)
// A light shines on the senders, so its direction and distance are those at the senders' weighted mean position. Its shadow
// is the mean over a disc around that position, as wide as the senders are scattered and perpendicular to their mean normal.
// The paper has no shadows.
//
// Inputs:  viewZ, albedo; bounce0 to bounce6 and sender_offset of s3ho.senders.frag.
// Output:  indirect, linear RGB radiance: albedo/π × E.

#include "lib/space.glsl"
#include "lib/sampling.glsl"
#include "lib/lights.glsl"
#include "lib/sh.glsl"
#include "s3ho.packing.glsl"

uniform sampler2D viewZ;
uniform sampler2D albedo;
uniform sampler2D bounce0;
uniform sampler2D bounce1;
uniform sampler2D bounce2;
uniform sampler2D bounce3;
uniform sampler2D bounce4;
uniform sampler2D bounce5;
uniform sampler2D bounce6;
uniform sampler2D sender_offset;
uniform float radius;            // scene units
uniform float light_window;      // bands
uniform vec4 ray_from_pixel;
uniform mat4 view_from_world;
uniform mat4 world_from_view;
uniform mat4 view_environment_sh[3];  // of red, green and blue

out vec4 indirect;

// Radii, along the mean normal: a mean position lies on a surface or, between two, in a solid. Of 0.02, 0.05, 0.08 and 0.12,
// 0.08 had the least difference to SSDO's bounce, which reads every sender's light, on most of the six scenes (240×136, 32
// directions, lamps alone; one layer and peeled layers).
const float SENDER_LIFT = 0.08;

// Points on the disc. With 8 the difference on `boxes` was 26 % of the mean (one layer) and 36 % (peeled layers); with the
// disc's centre alone it was 33 and 63 %, and with 16 points 25 and 37 %.
const int DISC = 8;

// The mean share of light `i` that arrives past its shadow map on a disc of `extent` around `worldPos`.
float shadowOfDisc(int i, vec3 worldPos, vec3 toLight, mat2x3 extent) {
    float lit = 0.0;
    for (int k = 0; k < DISC; ++k) {
        float angleRad = 2.39996 * float(k);  // the golden angle: Vogel's spiral, every point for the same area
        vec2 onDisc = sqrt((float(k) + 0.5) / float(DISC)) * vec2(cos(angleRad), sin(angleRad));
        lit += shadowOf(i, worldPos + extent * onDisc, toLight);
    }
    return lit / float(DISC);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float surfaceZ = texelFetch(viewZ, pixel, 0).r;
    vec4 offset = texelFetch(sender_offset, pixel, 0);
    indirect = vec4(0.0);
    if (isBackground(surfaceZ) || offset.a <= 0.0) return;  // no sender

    vec4 texels[7] = vec4[7](texelFetch(bounce0, pixel, 0), texelFetch(bounce1, pixel, 0), texelFetch(bounce2, pixel, 0),
                             texelFetch(bounce3, pixel, 0), texelFetch(bounce4, pixel, 0), texelFetch(bounce5, pixel, 0),
                             texelFetch(bounce6, pixel, 0));
    vec3 c[9] = unpackBounce(texels);

    // band 1 of a lobe around n is -n.y, n.z, -n.x times a factor: that of the sum has the mean normal
    vec3 senderNormal = vec3(-dot(c[3], vec3(1.0)), -dot(c[1], vec3(1.0)), dot(c[2], vec3(1.0)));
    if (dot(senderNormal, senderNormal) < 1e-20) return;  // black senders
    senderNormal = normalize(senderNormal);
    vec3 meanOffset = offset.xyz / offset.a;
    float spread = sqrt(max(texels[6].a / offset.a - dot(meanOffset, meanOffset), 0.0));  // the standard deviation
    vec3 viewPos = viewPosAt(gl_FragCoord.xy, surfaceZ, ray_from_pixel);
    vec3 senderPos = viewPos + radius * (meanOffset + SENDER_LIFT * senderNormal);
    vec3 worldPos = (world_from_view * vec4(senderPos, 1.0)).xyz;
    mat3 frame = mat3(world_from_view) * frameAround(senderNormal);
    mat2x3 disc = radius * spread * mat2x3(frame[0], frame[1]);

    vec4 lobe = shLightLobe(shHanning(light_window));
    mat4 light[3] = view_environment_sh;
    for (int i = 0; i < lights; ++i) {
        float arriving;
        vec3 toLight = towardsLightAt(i, worldPos, arriving);
        arriving *= shadowOfDisc(i, worldPos, toLight, disc);
        mat4 fromThere = shZonal(lobe, mat3(view_from_world) * toLight);
        for (int k = 0; k < 3; ++k) light[k] += light_color[i][k] * arriving * fromThere;
    }
    vec3 irradiance;
    for (int k = 0; k < 3; ++k) {
        mat4 transfer = mat4(c[0][k], c[1][k], c[2][k], c[3][k], c[4][k], c[5][k], c[6][k], c[7][k], c[8][k],
                             0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        irradiance[k] = shDot(light[k], transfer);
    }
    indirect = vec4(texelFetch(albedo, pixel, 0).rgb / PI * max(irradiance, 0.0), 1.0);
}
