// Packs the voxels' bits into single words, so that a tap reads 4 bytes from one texture.
// Inputs:  bits0 to bits7, RGBA32UI (voxelize.frag).
// Output:  word, R32UI (lib/voxel_words.glsl).

#include "lib/voxel_words.glsl"

const int targets;

uniform usampler2D bits0;
uniform usampler2D bits1;
uniform usampler2D bits2;
uniform usampler2D bits3;
uniform usampler2D bits4;
uniform usampler2D bits5;
uniform usampler2D bits6;
uniform usampler2D bits7;

out uint word;

void main() {
    ivec2 place;
    int index;
    word = 0u;
    if (!isWord(ivec2(gl_FragCoord.xy), place, index)) return;
    int target = index >> 2;
    uvec4 four = uvec4(0u);
    if (target == 0) four = texelFetch(bits0, place, 0);
    if (targets > 1 && target == 1) four = texelFetch(bits1, place, 0);
    if (targets > 2 && target == 2) four = texelFetch(bits2, place, 0);
    if (targets > 3 && target == 3) four = texelFetch(bits3, place, 0);
    if (targets > 4 && target == 4) four = texelFetch(bits4, place, 0);
    if (targets > 5 && target == 5) four = texelFetch(bits5, place, 0);
    if (targets > 6 && target == 6) four = texelFetch(bits6, place, 0);
    if (targets > 7 && target == 7) four = texelFetch(bits7, place, 0);
    word = four[index & 3];
}
