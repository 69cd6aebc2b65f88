// A bounce, reflected: albedo/π × E, times the visibility of the module if `dimmed`.
// Inputs: albedo; irradiance, rgb E; the module's openness; where `adds`, other, a bounce that is there already.
// Output: indirect, linear RGB radiance.

#include "lib/constants.glsl"
#include "openness.glsl"

const bool dimmed;
const bool adds;

uniform sampler2D albedo;
uniform sampler2D irradiance;
uniform sampler2D other;

out vec4 indirect;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 surfaceAlbedo = texelFetch(albedo, pixel, 0);
    float open = dimmed ? opennessAt(pixel) : 1.0;
    indirect = vec4(surfaceAlbedo.rgb / PI * texelFetch(irradiance, pixel, 0).rgb * open, 1.0) * surfaceAlbedo.a;
    if (adds) indirect.rgb += texelFetch(other, pixel, 0).rgb;
}
