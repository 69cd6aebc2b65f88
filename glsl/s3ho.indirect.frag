// S3HO, one bounce: the senders' coefficients under the light of all that shines, Herholz et al. 2012,
// Eq. 3 to 5: E(P) = (c_env + Σ c_l(P)) · c_SSGI(P). The lights are taken as they are at P, shadow maps included: where a
// sender stands is not known any more, but it is near. (Past no shadow map the error against rays was 43, 17 and 3 % larger
// on atrium, skyscrapers and boxes, and 0 to 6 % smaller on the other three scenes.)
// Inputs: viewZ, viewNormal, albedo, bounce0 to bounce6 (s3ho.senders.frag). Output: indirect, linear RGB radiance: albedo/π × E.

#include "lib/space.glsl"
#include "lib/lights.glsl"
#include "lib/sh.glsl"

uniform sampler2D viewZ;
uniform sampler2D viewNormal;
uniform sampler2D albedo;
uniform sampler2D bounce0;
uniform sampler2D bounce1;
uniform sampler2D bounce2;
uniform sampler2D bounce3;
uniform sampler2D bounce4;
uniform sampler2D bounce5;
uniform sampler2D bounce6;
uniform float light_window;      // bands
uniform vec4 ray_from_pixel;
uniform mat4 view_from_world;
uniform mat4 world_from_view;
uniform mat4 view_environment_sh[3];  // of red, green and blue

out vec4 indirect;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float surfaceZ = texelFetch(viewZ, pixel, 0).r;
    indirect = vec4(0.0);
    if (isBackground(surfaceZ)) return;

    vec3 worldPos = (world_from_view * vec4(viewPosAt(gl_FragCoord.xy, surfaceZ, ray_from_pixel), 1.0)).xyz;
    vec3 normal = texelFetch(viewNormal, pixel, 0).xyz;
    vec4 lobe = shLightLobe(shHanning(light_window));
    mat4 light[3] = view_environment_sh;
    for (int i = 0; i < lights; ++i) {
        float arriving;
        vec3 toLight = towardsLightAt(i, worldPos, arriving);
        vec3 viewToLight = mat3(view_from_world) * toLight;
        arriving *= lobesShadowOf(i, worldPos, toLight, dot(normal, viewToLight));
        mat4 fromThere = shZonal(lobe, viewToLight);
        for (int k = 0; k < 3; ++k) light[k] += light_color[i][k] * arriving * fromThere;
    }
    vec4 b0 = texelFetch(bounce0, pixel, 0), b1 = texelFetch(bounce1, pixel, 0), b2 = texelFetch(bounce2, pixel, 0);
    vec4 b3 = texelFetch(bounce3, pixel, 0), b4 = texelFetch(bounce4, pixel, 0), b5 = texelFetch(bounce5, pixel, 0);
    vec4 b6 = texelFetch(bounce6, pixel, 0);
    vec3 seventh = vec3(b0.a, b1.a, b2.a), eighth = vec3(b3.a, b4.a, b5.a);
    vec3 irradiance;
    for (int k = 0; k < 3; ++k) {
        mat4 transfer = mat4(b0[k], b1[k], b2[k], b3[k], b4[k], b5[k], b6[k], seventh[k], eighth[k],
                             0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        irradiance[k] = shDot(light[k], transfer);
    }
    indirect = vec4(texelFetch(albedo, pixel, 0).rgb / 3.14159265358979 * max(irradiance, 0.0), 1.0);
}
