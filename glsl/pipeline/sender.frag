// The light that leaves each surface before any bounce: direct + ambient.
// Inputs: direct, ambient. Output: sender, linear RGB radiance.

uniform sampler2D direct;
uniform sampler2D ambient;

out vec4 sender;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    sender = texelFetch(direct, pixel, 0) + texelFetch(ambient, pixel, 0);
}
