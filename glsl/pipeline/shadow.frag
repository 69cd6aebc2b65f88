// A light's view of an instance: depth only; holes of a cut-out texture let light through.

uniform sampler2D base_texture;
uniform vec4 base_color;
uniform float alpha_cutoff;

in vec2 uv;
in float alpha;

void main() {
    if (base_color.a * alpha * texture(base_texture, uv).a < alpha_cutoff) discard;
}
