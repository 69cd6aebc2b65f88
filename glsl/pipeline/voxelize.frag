// Voxels: each fragment sets a bit in every slice that its triangle spans within the pixel (Eisemann and Décoret 2006, "Fast
// Scene Voxelization and Applications"). The targets are integers, and fragments are combined by OR.
// The paper sets the slice of the pixel's centre alone; then slopes steeper than 1 leave holes.
//
// Inputs:  the triangles, seen by an orthographic camera whose near and far planes are the ends of the grid.
// Outputs: bits[i], slices 128 i to 128 i + 127: four components of 32 bits.

const int targets;
const int slices;

uniform sampler2D base_texture;
uniform vec4 base_color;
uniform float alpha_cutoff;

flat in vec2 depthRange;
in vec2 uv;
in float alpha;

out uvec4 bits[targets];

// The bits `first` to `last`, as far as they lie among the 32 from `start` on.
uint bitsBetween(int first, int last, int start) {
    int low = clamp(first - start, 0, 32), high = clamp(last + 1 - start, 0, 32);
    uint below = high == 32 ? 0xffffffffu : (1u << uint(high)) - 1u;
    uint under = low == 32 ? 0xffffffffu : (1u << uint(low)) - 1u;
    return below & ~under;
}

void main() {
    if (base_color.a * alpha * texture(base_texture, uv).a < alpha_cutoff) discard;  // a hole of a cut-out
    // the plane's depth over the pixel's square, but not beyond the triangle's corners
    float reach = 0.5 * (abs(dFdx(gl_FragCoord.z)) + abs(dFdy(gl_FragCoord.z)));
    vec2 range = clamp(gl_FragCoord.z + vec2(-reach, reach), depthRange.x, depthRange.y) * float(slices);
    int first = clamp(int(floor(range.x)), 0, slices - 1);
    int last = clamp(int(floor(range.y)), 0, slices - 1);
    for (int i = 0; i < targets; ++i) {
        for (int k = 0; k < 4; ++k) bits[i][k] = bitsBetween(first, last, 128 * i + 32 * k);
    }
}
