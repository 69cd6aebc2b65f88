// The tiles in which a buffer differs from one value: at a pixel of the tile, or at most `reach` pixels of the buffer from it
// in x and in y. The buffer may be smaller than the picture of the tiles.
// Input: source. Output: tiles, a texel a tile: 1 where the buffer differs, else 0.

const int tile_pixels;
const int across;    // pixels of the source below a tile, in x and in y
const int reach;
const bool single;   // the source has one channel

uniform sampler2D source;
uniform float value;
uniform vec2 source_texel_size;
uniform vec4 source_from_pixel;   // a pixel of the source: pixel * xy + zw

out float tiles;

void main() {
    vec2 corner = floor(gl_FragCoord.xy) * float(tile_pixels);
    vec2 first = floor(corner * source_from_pixel.xy + source_from_pixel.zw) + 0.5;
    bool differs = false;
    for (int y = -reach; y < across + reach; ++y) {
        for (int x = -reach; x < across + reach; ++x) {
            vec4 here = texture(source, (first + vec2(x, y)) * source_texel_size);
            differs = differs || (single ? here.r != value : here != vec4(value));
        }
    }
    tiles = differs ? 1.0 : 0.0;
}
