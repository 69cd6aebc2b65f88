// Where an equirectangular environment map holds a direction (the NumPy twin is uv_from_direction, aolab/scene/environment.py).
//
// Convention: u = 0.5 + atan(d.x, -d.z) / 2pi, v = acos(d.y) / pi: v = 0 is the map's first row and looks up (+y), the
// centre column looks down -z, u grows towards +x. Uploaded first row first, v needs no flip. Sample with repeat in u,
// clamp in v, and textureLod: u jumps from 1 to 0 behind the viewer, where automatic derivatives would pick a coarse level.

const float ENVIRONMENT_PI = 3.14159265358979324;

// `worldDir`: world space, any length above 0.
vec2 environmentUv(vec3 worldDir) {
    float across = length(worldDir.xz);
    // atan(0, 0) is undefined in GLSL; at the poles every u is the same direction
    float azimuth = across > 0.0 ? atan(worldDir.x, -worldDir.z) : 0.0;
    float polar = atan(across, worldDir.y); // acos(d.y) for a unit vector, but precise near the poles
    return vec2(0.5 + azimuth / (2.0 * ENVIRONMENT_PI), polar / ENVIRONMENT_PI);
}
