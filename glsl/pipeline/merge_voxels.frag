// Merges the words of three views, along the grid's z, x and y axis: a voxel is set that any of the views has set.
// Inputs:  words0 (along z), words1 (along x), words2 (along y), R32UI, each packed along its own axis.
// Output:  word, R32UI, packed along z (lib/voxel_words.glsl).

#include "lib/voxel_words.glsl"

uniform usampler2D words0;
uniform usampler2D words1;
uniform usampler2D words2;

out uint word;

uint bitOf(usampler2D words, ivec2 place, int slice) {
    return (texelFetch(words, wordAt(place, slice >> 5), 0).r >> uint(slice & 31)) & 1u;
}

void main() {
    ivec2 place;
    int index;
    word = 0u;
    if (!isWord(ivec2(gl_FragCoord.xy), place, index)) return;
    word = texelFetch(words0, ivec2(gl_FragCoord.xy), 0).r;
    int last = slices - 1;
    for (int i = 0; i < 32; ++i) {
        int z = 32 * index + i;  // z grows away from the camera, so each view's last axis is mirrored
        uint alongX = bitOf(words1, ivec2(place.y, last - z), last - place.x);
        uint alongY = bitOf(words2, ivec2(last - z, place.x), last - place.y);
        word |= (alongX | alongY) << uint(i);
    }
}
