// HAO's bilateral filter, one direction of its separable form (Reinbothe, Boubekeur and Alexa 2009, section 7).
//   h(x) = Σ w_d w_n w_p w_h h'(y) / Σ w_d w_n w_p w_h,   each w a Wendland kernel (Eq. 3):
//   w_d of ‖x - y‖ over the window, w_n of the normals, w_p of the distance in space, w_h of the values.
// Differences: the paper prints w_n = w(1 + n·n', 2), which is 0 for equal normals; the sign here is -. Its w_p ends at d_max,
// here at a share of the viewing distance, so that other methods may choose this filter too. A separable form of weights that
// do not factor is an approximation, in the paper as well.
//
// Inputs:  sources (lib/sources.glsl), viewZ, viewNormal. Outputs: results.

#include "lib/space.glsl"
#include "lib/sources.glsl"
#include "lib/wendland.glsl"

const bool vertical;
const int filter_size;

uniform sampler2D viewZ;
uniform sampler2D viewNormal;
uniform vec4 ray_from_pixel;
uniform vec2 texel_size;
uniform float filter_distance;

void main() {
    vec2 uv = gl_FragCoord.xy * texel_size;
    vec2 way = vertical ? vec2(0.0, 1.0) : vec2(1.0, 0.0);   // pixels
    float centreZ = texture(viewZ, uv).r;
    mat4 centre = sourcesAt(uv);
    writeResults(centre);
    if (isBackground(centreZ)) return;

    vec3 centrePos = viewPosAt(gl_FragCoord.xy, centreZ, ray_from_pixel);
    vec3 normal = texture(viewNormal, uv).xyz;
    float farthest = filter_distance * -centreZ;
    mat4 sum = mat4(0.0);
    vec4 weights = vec4(0.0);
    for (int i = -filter_size / 2; i <= filter_size / 2; ++i) {
        vec2 otherPixel = gl_FragCoord.xy + float(i) * way;
        vec2 other = otherPixel * texel_size;
        float otherZ = texture(viewZ, other).r;
        if (isBackground(otherZ)) continue;   // or beyond the edge
        vec3 otherPos = viewPosAt(otherPixel, otherZ, ray_from_pixel);
        float weight = wendland(abs(float(i)), float(filter_size));                                  // Eq. 6
        weight *= wendland(1.0 - dot(normal, texture(viewNormal, other).xyz), 2.0);            // Eq. 7
        weight *= wendland(distance(centrePos, otherPos), farthest);
        mat4 value = sourcesAt(other);
        for (int k = 0; k < sources; ++k) {
            float w = weight * wendland(distance(centre[k], value[k]), 1.0);
            sum[k] += w * value[k];
            weights[k] += w;
        }
    }
    for (int k = 0; k < sources; ++k) sum[k] /= max(weights[k], 1e-10);
    writeResults(sum);
}
