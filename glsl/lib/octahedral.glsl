// The uv of a direction in an octahedral map, which unfolds the sphere onto a square with a few additions and one
// division (Engelhardt and Dachsbacher 2008, "Octahedron Environment Maps"). NumPy twin: octahedral_uv,
// aolab/scene/prefiltered.py. The centre is up (+y), the corners are down; u increases towards +x, v towards +z.

// `worldDir`: world space, of any length above 0. Returns uv in [0, 1].
vec2 octahedralUv(vec3 worldDir) {
    vec2 folded = worldDir.xz / (abs(worldDir.x) + abs(worldDir.y) + abs(worldDir.z));
    vec2 signs = vec2(folded.x >= 0.0 ? 1.0 : -1.0, folded.y >= 0.0 ? 1.0 : -1.0);
    if (worldDir.y < 0.0) folded = (1.0 - abs(folded.yx)) * signs;
    return 0.5 * folded + 0.5;
}
