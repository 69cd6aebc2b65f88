// Packs the voxels' bits into single words, so that a tap reads 4 bytes from one texture.
// Inputs:  bits0_0 to bits0_7, RGBA32UI (voxelize.frag).
// Output:  word, R32UI: in tile i (from the lower left, `columns` in a row), the 32 slices from 32 i on.

#include "lib/voxel_words.glsl"

out uint word;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec2 tile = pixel / slices;
    int index = tile.y * columns + tile.x;
    word = index * 32 < slices ? wordAlongZ(pixel - tile * slices, index) : 0u;
}
