// From radiance to the screen: exposure, tone map, sRGB.

#include "lib/color.glsl"

const bool filmic_tone;

uniform float exposure;

// The sRGB code of a linear RGB radiance.
vec3 displayed(vec3 radiance) {
    vec3 exposed = radiance * exposure;
    return srgbFromLinear(filmic_tone ? filmic(exposed) : clamp(exposed, 0.0, 1.0));
}
