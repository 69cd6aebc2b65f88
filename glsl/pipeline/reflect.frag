// Diffuse reflection of an irradiance: albedo/π × E. Occlusion, where there is any, is in E already.
// Inputs: albedo, source (rgb irradiance); where `adds`, more, a radiance that is there already. Output: reflected, linear RGB radiance.

#include "lib/constants.glsl"

const bool adds;

uniform sampler2D albedo;
uniform sampler2D source;
uniform sampler2D more;

out vec4 reflected;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 surfaceAlbedo = texelFetch(albedo, pixel, 0);
    reflected = vec4(surfaceAlbedo.rgb / PI * texelFetch(source, pixel, 0).rgb, 1.0) * surfaceAlbedo.a;
    if (adds) reflected.rgb += texelFetch(more, pixel, 0).rgb;
}
