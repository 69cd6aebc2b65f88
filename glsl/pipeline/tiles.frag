// The tiles in which a buffer differs from one value: at a pixel of the tile, or at most `reach` pixels from it in x and in y.
// Input: source. Output: tiles, a texel a tile: 1 where the buffer differs, else 0.

const int tile_pixels;
const int reach;
const bool single;   // the source has one channel

uniform sampler2D source;
uniform float value;
uniform vec2 source_texel_size;

out float tiles;

void main() {
    vec2 corner = floor(gl_FragCoord.xy) * float(tile_pixels) + 0.5;
    bool differs = false;
    for (int y = -reach; y < tile_pixels + reach; ++y) {
        for (int x = -reach; x < tile_pixels + reach; ++x) {
            vec4 here = texture(source, (corner + vec2(x, y)) * source_texel_size);
            differs = differs || (single ? here.r != value : here != vec4(value));
        }
    }
    tiles = differs ? 1.0 : 0.0;
}
