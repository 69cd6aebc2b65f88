// Noise without a texture: an integer hash with good statistics on small inputs.
// Jarzynski and Olano 2020, "Hash Functions for GPU Rendering", pcg3d.

// Three numbers in [0, 1) from a cell's whole coordinates.
vec3 hashed(ivec3 cell) {
    uvec3 v = uvec3(cell) * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> 16u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return vec3(v >> 8u) / 16777216.0;
}
