// The background of the picture: the environment.
// Output: image (sRGB, 8 bits).

#include "lib/background.glsl"
#include "lib/display.glsl"

uniform vec4 ray_from_pixel;
uniform mat4 world_from_view;

out vec4 image;

void main() {
    image = vec4(displayed(backgroundAt(gl_FragCoord.xy, ray_from_pixel, world_from_view)), 1.0);
}
