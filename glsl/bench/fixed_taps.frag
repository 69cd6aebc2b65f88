// Benchmark: the cheapest loop with as many taps as SSAO. The kernel lies flat around the pixel, not rotated, scaled to
// the radius on the screen. `aolab bench` prints the ratio to ssao.frag: the cost of finding and testing SSAO's texels.
// Input: viewZ (scene units, negative). Output: sum, without meaning.

const int directions;
const int steps;

uniform float radius;
uniform vec4 kernel[directions];
uniform sampler2D viewZ;
uniform vec2 texel_size;
uniform vec4 pixel_from_ray;

out float visibility;  // the sum of the taps

void main() {
    float centreZ = texelFetch(viewZ, ivec2(gl_FragCoord.xy), 0).r;
    vec2 uv = gl_FragCoord.xy * texel_size;
    vec2 scale = radius / max(-centreZ, 1e-20) * pixel_from_ray.xy * texel_size;
    float sum = 0.0;
    for (int i = 0; i < directions; ++i)
        for (int j = 0; j < steps; ++j) sum += texture(viewZ, uv + kernel[i].xy * scale * (float(j + 1) / float(steps))).r;
    visibility = sum;
}
