// Gathering from reflective shadow maps (aolab/modules/rsm.py): the irradiance from samples of their pixel lights.
//
// rsm_kernel[i], from aolab/maths/sampling.py: xy, the offset of sample i from the point's projection, in radii; z, the
// share of the disc that the sample stands for. The samples of all pixels are the same, or, if `rotated`, turned by one of
// 16 angles.

#include "lib/sampling.glsl"

const int rsm_samples;
const int rsm_tiles;         // maps, one beside the other
const bool rotated;

uniform float rsm_radius;    // of the disc of samples, as a share of the map's side
uniform vec4 rsm_kernel[rsm_samples];
uniform sampler2D rsm_table; // a row a map: the four columns of its clip_from_world; then (light, width, resolution, 0)
uniform sampler2D rsm_position;
uniform sampler2D rsm_normal;
uniform sampler2D rsm_flux;

// The irradiance at a point from the pixel light at `texel`, which stands for `count` pixels like it. Dachsbacher and
// Stamminger 2005, Eq. 1: E_p(x, n) = Φ_p/π max(0, ⟨n_p, x - x_p⟩) max(0, ⟨n, x_p - x⟩) / ‖x - x_p‖⁴.
// The paper leaves out 1/π, the radiance of a diffuse surface by its flux. Its point has no size, so that E_p has no bound;
// a disc of the area A sends less to near points: A / (d² + A/π) in place of A / d² (Wallace, Elmquist and Haines 1989).
// If `rotated`, 16 pixels with other angles share the area.
vec3 irradianceFromPixel(ivec2 texel, float count, vec3 worldPos, vec3 worldNormal) {
    vec4 pixel = texelFetch(rsm_position, texel, 0);
    vec3 there = worldPos - pixel.xyz;
    float squared = dot(there, there);
    float cosines = max(dot(texelFetch(rsm_normal, texel, 0).xyz, there), 0.0) * max(-dot(worldNormal, there), 0.0);
    float area = count * pixel.w / (rotated ? 16.0 : 1.0);
    return texelFetch(rsm_flux, texel, 0).rgb * count / PI * cosines / max(squared * (squared + area / PI), 1e-20);
}

// The irradiance at a point from all maps, by samples around its projection into each. `set`: the pixel's set of samples.
vec3 gatherAt(vec3 worldPos, vec3 worldNormal, int set) {
    float angleRad = rotated ? 2.0 * PI * float(set) / 16.0 : 0.0;
    mat2 turn = mat2(cos(angleRad), sin(angleRad), -sin(angleRad), cos(angleRad));
    vec3 sum = vec3(0.0);
    for (int tile = 0; tile < rsm_tiles; ++tile) {
        mat4 clipFromWorld = mat4(texelFetch(rsm_table, ivec2(0, tile), 0), texelFetch(rsm_table, ivec2(1, tile), 0),
                                  texelFetch(rsm_table, ivec2(2, tile), 0), texelFetch(rsm_table, ivec2(3, tile), 0));
        int size = int(texelFetch(rsm_table, ivec2(4, tile), 0).z);
        vec4 clip = clipFromWorld * vec4(worldPos, 1.0);
        // a point outside of the map gathers around the map's border, and one behind the light around its middle
        vec2 centre = clip.w > 0.0 ? clamp(clip.xy / clip.w * 0.5 + 0.5, 0.0, 1.0) : vec2(0.5);
        for (int i = 0; i < rsm_samples; ++i) {
            vec2 at = centre + rsm_radius * (turn * rsm_kernel[i].xy);
            if (at != clamp(at, 0.0, 0.99999)) continue;  // off the map
            float share = PI * rsm_radius * rsm_radius * rsm_kernel[i].z;
            ivec2 texel = ivec2(at * float(size)) + ivec2(tile * size, 0);
            sum += irradianceFromPixel(texel, share * float(size) * float(size), worldPos, worldNormal);
        }
    }
    return sum;
}
