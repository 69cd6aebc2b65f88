// The light that leaves each surface before any bounce: direct + ambient light + emission.
// Inputs: direct, ambient, emission. Output: sender, linear RGB radiance.

const bool has_emission;

uniform sampler2D direct;
uniform sampler2D ambient;
uniform sampler2D emission;

out vec4 sender;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    sender = texelFetch(direct, pixel, 0) + texelFetch(ambient, pixel, 0);
    if (has_emission) sender.rgb += texelFetch(emission, pixel, 0).rgb;
}
