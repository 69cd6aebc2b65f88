// The environment behind the scene.

#include "lib/space.glsl"
#include "lib/environment.glsl"

uniform sampler2D environment;

// The radiance that the eye sees at `pixel` (window coordinates) where there is no surface.
vec3 backgroundAt(vec2 pixel, vec4 rayFromPixel, mat4 worldFromView) {
    vec3 worldDir = mat3(worldFromView) * sightTo(viewPosAt(pixel, -1.0, rayFromPixel));
    return textureLod(environment, environmentUv(normalize(worldDir)), 0.0).rgb;
}
