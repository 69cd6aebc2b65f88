// One frame's share of a mean; blending adds the shares up.
// Inputs: source; share, 1 / frames. Output: source × share.

uniform sampler2D source;
uniform float share;

out vec4 part;

void main() {
    part = texelFetch(source, ivec2(gl_FragCoord.xy), 0) * share;
}
