// Words of voxels: the bits of one view along an axis, in up to eight targets of 128 slices.

const int slices;
const int targets;
const int columns;     // tiles in a row of the packed words

uniform usampler2D bits0_0;
uniform usampler2D bits0_1;
uniform usampler2D bits0_2;
uniform usampler2D bits0_3;
uniform usampler2D bits0_4;
uniform usampler2D bits0_5;
uniform usampler2D bits0_6;
uniform usampler2D bits0_7;

// The 32 slices from 32 `index` on, of the view along z.
uint wordAlongZ(ivec2 texel, int index) {
    int target = index >> 2;
    uvec4 four = uvec4(0u);
    if (target == 0) four = texelFetch(bits0_0, texel, 0);
    if (targets > 1 && target == 1) four = texelFetch(bits0_1, texel, 0);
    if (targets > 2 && target == 2) four = texelFetch(bits0_2, texel, 0);
    if (targets > 3 && target == 3) four = texelFetch(bits0_3, texel, 0);
    if (targets > 4 && target == 4) four = texelFetch(bits0_4, texel, 0);
    if (targets > 5 && target == 5) four = texelFetch(bits0_5, texel, 0);
    if (targets > 6 && target == 6) four = texelFetch(bits0_6, texel, 0);
    if (targets > 7 && target == 7) four = texelFetch(bits0_7, texel, 0);
    return four[index & 3];
}
