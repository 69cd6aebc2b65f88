// One point a tile, as wide as the tile. A tile where nothing is drawn lies outside the picture. No input: numbered vertices.

const int tile_pixels;

uniform sampler2D tiles;   // a texel a tile, above 0 where the pass is drawn

void main() {
    ivec2 count = textureSize(tiles, 0);
    ivec2 tile = ivec2(gl_VertexID % count.x, gl_VertexID / count.x);
    vec2 centre = 2.0 * (vec2(tile) + 0.5) / vec2(count) - 1.0;
    gl_Position = vec4(texelFetch(tiles, tile, 0).r > 0.0 ? centre : vec2(2.0), 0.0, 1.0);
    gl_PointSize = float(tile_pixels);
}
