// Ambient light: the environment's light that the surface reflects, ambientAt of the module's "ambient.glsl".
// Inputs: viewZ, viewNormal, albedo, and those of the function. Output: ambient, linear RGB radiance; 0 in the background.

#include "lib/surface.glsl"
#include "ambient.glsl"

out vec4 ambient;

void main() {
    Surface surface;
    ambient = surfaceHere(surface) ? vec4(ambientAt(surface), 1.0) : vec4(0.0);
}
