// Packs the voxels' bits of three views, along the grid's z, x and y axis, into single words: a voxel is set that any of the
// views has set. Inputs: bits0_i (along z), bits1_i (along x), bits2_i (along y), RGBA32UI. Output: word, as pack_voxels.frag.

#include "lib/voxel_words.glsl"

uniform usampler2D bits1_0;
uniform usampler2D bits1_1;
uniform usampler2D bits2_0;
uniform usampler2D bits2_1;

out uint word;

// Bit `slice` of a view with at most two targets.
uint bitOf(usampler2D first, usampler2D second, ivec2 texel, int slice) {
    uvec4 four = slice < 128 ? texelFetch(first, texel, 0) : texelFetch(second, texel, 0);
    return (four[(slice >> 5) & 3] >> uint(slice & 31)) & 1u;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec2 tile = pixel / slices, place = pixel - tile * slices;
    int index = tile.y * columns + tile.x;
    word = 0u;
    if (index * 32 >= slices) return;
    word = wordAlongZ(place, index);
    int last = slices - 1;
    for (int i = 0; i < 32; ++i) {
        int z = 32 * index + i;  // the grid's z grows away from the camera, so each view's last axis is mirrored
        uint alongX = bitOf(bits1_0, bits1_1, ivec2(place.y, last - z), last - place.x);
        uint alongY = bitOf(bits2_0, bits2_1, ivec2(last - z, place.x), last - place.y);
        word |= (alongX | alongY) << uint(i);
    }
}
