// Direct light: the lamps' light that the surface reflects, directAt of the module's "direct.glsl".
// Inputs: viewZ, viewNormal, albedo, and those of the function. Output: direct, linear RGB radiance; 0 in the background.

#include "lib/surface.glsl"
#include "direct.glsl"

out vec4 direct;

void main() {
    Surface surface;
    direct = surfaceHere(surface) ? vec4(directAt(surface), 1.0) : vec4(0.0);
}
