// Indirect light: a bounce that the surface reflects, indirectAt of the module's "indirect.glsl".
// Inputs: viewZ, viewNormal, albedo, and those of the function. Output: indirect, linear RGB radiance; 0 in the background.

#include "lib/surface.glsl"
#include "indirect.glsl"

out vec4 indirect;

void main() {
    Surface surface;
    indirect = surfaceHere(surface) ? vec4(indirectAt(surface), 1.0) : vec4(0.0);
}
