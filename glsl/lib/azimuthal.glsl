// Lambert's azimuthal equal-area map of directions, around +z: the uv of a direction n is 0.5 + 0.5 n.xy / sqrt(2 + 2 n.z). The
// centre is +z, the circle of radius 0.5 is -z, which has no uv of its own. With 16 bits a coordinate, directions up to 30°
// behind the plane of x and y come back with an error below 1e-4. NumPy twin: _facet, aolab/notebook/microscope/receiver.py.

// `dir`: unit. Returns uv in [0, 1].
vec2 azimuthalUv(vec3 dir) {
    return 0.5 + 0.5 * dir.xy * inversesqrt(max(2.0 + 2.0 * dir.z, 1e-6));
}

// The direction at `uv`, unit.
vec3 azimuthalDirection(vec2 uv) {
    vec2 across = 2.0 * uv - 1.0;
    float depth = min(dot(across, across), 1.0);
    return vec3(across * 2.0 * sqrt(1.0 - depth), 1.0 - 2.0 * depth);
}
