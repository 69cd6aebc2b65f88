// The uv of a direction in an equirectangular environment map. NumPy twin: uv_from_direction,
// aolab/scene/environment.py.
//
// Convention: u = 0.5 + atan(d.x, -d.z) / 2pi, v = acos(d.y) / pi. The first row of the map, v = 0, is up (+y); the
// centre column is -z; u increases towards +x. The first row is uploaded first, so that v is not flipped. Sample with
// repeat in u, clamp in v, and textureLod: where u jumps from 1 to 0, derivatives would select a coarse level.

#include "lib/constants.glsl"

// `worldDir`: world space, of any length above 0. Returns uv in [0, 1].
vec2 environmentUv(vec3 worldDir) {
    float across = length(worldDir.xz);
    // atan(0, 0) is undefined in GLSL, and at the poles u has no effect
    float azimuth = across > 0.0 ? atan(worldDir.x, -worldDir.z) : 0.0;
    float polar = atan(across, worldDir.y); // = acos(d.y) for a unit vector, but precise near the poles
    return vec2(0.5 + azimuth / (2.0 * PI), polar / PI);
}

// Where a table of aolab/scene/irradiance.py, `size` texels, holds the normal `worldDir`: the poles are at the centres of
// the first and last row, and one column more on each side continues the circle.
vec2 irradianceUv(vec3 worldDir, ivec2 size) {
    return (environmentUv(worldDir) * vec2(size.x - 2, size.y - 1) + vec2(1.0, 0.5)) / vec2(size);
}
