// Gathering from reflective shadow maps (aolab/modules/rsm.py): the irradiance from samples of their pixel lights.
//
// If `rotated`, the samples of a pixel lie on a line (lib/line.glsl). If not, those of all pixels are rsm_kernel[i], from
// aolab/maths/sampling.py: xy, the place of sample i in the unit disc; z, the share of the disc that it stands for.

#include "lib/line.glsl"
#include "lib/pixel_light.glsl"

const int rsm_samples;
const int rsm_tiles;         // maps, one beside the other
const bool rotated;

uniform float rsm_radius;    // half the side of the square of samples, as a share of the map's side
uniform vec4 rsm_kernel[rsm_samples];
uniform vec3 line_start;     // of lib/line.glsl
uniform vec4 rsm_box;        // of lib/pixel_light.glsl
uniform sampler2D rsm_table; // a row a map: the four columns of its clip_from_world; then (light, width, resolution, 0)
uniform usampler2D rsm_packed;

// The irradiance at a point from a pixel light that stands for `count` like it. Dachsbacher and Stamminger 2005, Eq. 1:
// E_p(x, n) = Φ_p/π max(0, ⟨n_p, x - x_p⟩) max(0, ⟨n, x_p - x⟩) / ‖x - x_p‖⁴.
// The paper leaves out 1/π, the radiance of a diffuse surface by its flux. Its point has no size, so that E_p has no bound;
// a disc of the area A sends less to near points: A / (d² + A/π) in place of A / d² (Wallace, Elmquist and Haines 1989).
// If `rotated`, 16 pixels with other samples share the area.
vec3 irradianceFromPixel(PixelLight light, float count, vec3 worldPos, vec3 worldNormal) {
    vec3 there = worldPos - light.worldPos;
    float squared = dot(there, there);
    float cosines = max(dot(light.normal, there), 0.0) * max(-dot(worldNormal, there), 0.0);
    float area = count * light.area / (rotated ? 16.0 : 1.0);
    return light.flux * (count / PI * cosines / max(squared * (squared + area / PI), 1e-20));
}

// The factor that moves a sample of the unit disc away from its centre, so that the disc fills the square around it.
float stretchToSquare(vec2 onDisc) { return length(onDisc) / max(abs(onDisc.x), abs(onDisc.y)); }

// The place in a map around which a point gathers, from its clip space. Beyond the map's sides, a point has no neighbours
// there: the farther it is, the nearer to the map's middle it gathers. Behind the light, it gathers around the middle.
vec2 centreInMap(vec4 clip) {
    vec2 fromMiddle = clip.w > 0.0 ? clip.xy / clip.w : vec2(0.0);
    float sides = max(max(abs(fromMiddle.x), abs(fromMiddle.y)), 1.0);
    return 0.5 + 0.5 * fromMiddle / (sides * sides);
}

// The irradiance at a point from all maps, by samples around its projection into each. `set`: the pixel's set of samples.
// All samples lie in a square that the map holds: those that leave it on a side enter at the opposite side.
vec3 gatherAt(vec3 worldPos, vec3 worldNormal, int set) {
    Line line = lineOf(set, line_start);
    float lineStretch = stretchToSquare(line.direction), side = 2.0 * rsm_radius;
    vec3 sum = vec3(0.0);
    for (int tile = 0; tile < rsm_tiles; ++tile) {
        mat4 clipFromWorld = mat4(texelFetch(rsm_table, ivec2(0, tile), 0), texelFetch(rsm_table, ivec2(1, tile), 0),
                                  texelFetch(rsm_table, ivec2(2, tile), 0), texelFetch(rsm_table, ivec2(3, tile), 0));
        int size = int(texelFetch(rsm_table, ivec2(4, tile), 0).z);
        vec2 centre = centreInMap(clipFromWorld * vec4(worldPos, 1.0));
        vec2 corner = clamp(centre - rsm_radius, 0.0, 1.0 - side);
        for (int i = 0; i < rsm_samples; ++i) {  // unrolled, it takes 1.7 times as long (llvmpipe)
            vec3 onDisc = rotated ? onLine(line, i, rsm_samples) : rsm_kernel[i].xyz;
            float stretch = rotated ? lineStretch : stretchToSquare(onDisc.xy);
            vec2 at = corner + side * fract((centre - corner) / side + 0.5 * stretch * onDisc.xy);
            ivec2 texel = min(ivec2(at * float(size)), size - 1) + ivec2(tile * size, 0);
            float share = PI / 4.0 * stretch * stretch * onDisc.z;  // of the square
            float count = share * side * side * float(size) * float(size);
            PixelLight light = pixelLightOf(texelFetch(rsm_packed, texel, 0), rsm_box);
            sum += irradianceFromPixel(light, count, worldPos, worldNormal);
        }
    }
    return sum;
}
