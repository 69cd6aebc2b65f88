// The layout of packed voxels: a texel holds 32 slices; tile i, from the lower left, has the slices from 32 i on.

const int slices;
const int columns;     // tiles in a row

// The texel of the word `index` at a place of the grid.
ivec2 wordAt(ivec2 place, int index) {
    return ivec2(index % columns, index / columns) * slices + place;
}

// The place and the word's index of a texel. Returns false for a texel beyond the last word.
bool isWord(ivec2 texel, out ivec2 place, out int index) {
    ivec2 tile = texel / slices;
    place = texel - tile * slices;
    index = tile.y * columns + tile.x;
    return index * 32 < slices;
}
