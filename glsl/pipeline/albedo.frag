// The albedo of a scene with a palette.
// Inputs: viewNormal, and those of lib/palette.glsl. Output: albedo, linear RGB; a is 1 where a surface is, and 0 in the background.

#include "lib/palette.glsl"

uniform sampler2D viewNormal;   // w: the number of the mesh

out vec4 albedo;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    albedo = paletteAlbedo(pixel, texelFetch(viewNormal, pixel, 0).w);
}
