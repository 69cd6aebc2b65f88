// Benchmark: the least cost of SSAO's taps. The shader fetches the same texels in the same order as ssao.frag and adds
// them up, without the occluder test. `aolab bench` prints the ratio to ssao.frag: the cost of the test.
// Inputs: viewZ (scene units, negative), viewNormal (view space). Output: sum, without meaning.

#include "lib/space.glsl"
#include "lib/sampling.glsl"

const int directions;
const int steps;

uniform float radius;
uniform float bias;
uniform vec4 kernel[directions];
uniform sampler2D viewZ;
uniform sampler2D viewNormal;
uniform vec2 texel_size;
uniform vec4 ray_from_pixel;
uniform vec4 pixel_from_ray;

out float visibility;  // the sum of the taps

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float centreZ = texelFetch(viewZ, pixel, 0).r;
    visibility = 1.0;
    if (isBackground(centreZ)) return;

    vec3 normal = texelFetch(viewNormal, pixel, 0).xyz;
    vec3 viewPos = viewPosAt(gl_FragCoord.xy, centreZ, ray_from_pixel);
    viewPos += normal * liftOff(bias * radius, radius, viewPos, ray_from_pixel);
    int set = interleavedSet(pixel);
    mat3 frame = interleavedFrame(normal, set) * radius;

    float sum = 0.0;
    for (int i = 0; i < directions; ++i) {
        vec3 way = frame * kernel[i].xyz;
        float offset = interleavedOffset(kernel[i].w, set);
        for (int j = 0; j < steps; ++j) {
            vec3 samplePos = viewPos + way * ((float(j) + offset) / float(steps));
            sum += texture(viewZ, pixelAt(samplePos, pixel_from_ray) * texel_size).r;
        }
    }
    visibility = sum;
}
