// Voxels: each fragment sets a bit in every slice that its triangle spans within the pixel (Eisemann and Décoret 2006, "Fast
// Scene Voxelization and Applications"). The targets are integers, and fragments are combined by OR.
// With `voxel_exact`, the triangle is clipped to the pixel's square: the voxels that it touches are set, also where the camera
// sees it edge-on. Without it, all slices are set that the triangle's plane spans in a pixel whose centre the triangle
// covers. The paper sets the slice of the pixel's centre alone; then slopes steeper than 1 leave holes.
//
// Inputs:  the triangles, seen by an orthographic camera whose near and far planes are the ends of the grid.
// Outputs: bits[i], slices 128 i to 128 i + 127: four components of 32 bits.

#include "lib/base_color.glsl"

const bool voxel_exact;
const int targets;
const int slices;

flat in vec3 corner[3];      // grid coordinates
flat in vec2 cornerUv[3];
flat in vec3 cornerAlpha;

out uvec4 bits[targets];

const float NOTHING = 1e30;
const float INSET = 1e-4;    // of a pixel: a triangle that lies in the side of two pixels belongs to one of them
const float THIN = 1e-3;     // pixels: rounding makes the area of narrower triangles meaningless, in grids of 1024

// Barycentric coordinates at this pixel's centre, and their change by a pixel in x and in y; negative coordinates if the camera
// sees the triangle edge-on.
struct Weights {
    vec3 here;
    vec3 byX;
    vec3 byY;
};

Weights weightsHere() {
    vec2 a = corner[0].xy - gl_FragCoord.xy, b = corner[1].xy - gl_FragCoord.xy, c = corner[2].xy - gl_FragCoord.xy;
    vec3 areas = vec3(b.x * c.y - b.y * c.x, c.x * a.y - c.y * a.x, a.x * b.y - a.y * b.x);  // twice
    vec3 acrossX = vec3(b.y - c.y, c.y - a.y, a.y - b.y), acrossY = vec3(c.x - b.x, a.x - c.x, b.x - a.x);
    float whole = areas.x + areas.y + areas.z;
    vec3 squares = acrossX * acrossX + acrossY * acrossY;
    float longest = sqrt(max(squares.x, max(squares.y, squares.z)));
    if (abs(whole) <= THIN * longest) return Weights(vec3(-1.0), vec3(0.0), vec3(0.0));
    return Weights(areas / whole, acrossX / whole, acrossY / whole);
}

float depthOf(vec3 weights) {
    return dot(weights, vec3(corner[0].z, corner[1].z, corner[2].z));
}

// Extends `range` by the depths of an edge within the square (Liang and Barsky 1984).
void addEdge(inout vec2 range, vec3 from, vec3 to, vec2 low, vec2 high) {
    vec3 way = to - from;
    vec2 along = mix(way.xy, vec2(1e-9), lessThan(abs(way.xy), vec2(1e-9)));
    vec2 one = (low - from.xy) / along, two = (high - from.xy) / along;
    vec2 enter = min(one, two), leave = max(one, two);
    float first = max(max(enter.x, enter.y), 0.0), last = min(min(leave.x, leave.y), 1.0);
    if (first > last) return;
    vec2 depths = from.z + vec2(first, last) * way.z;
    range = vec2(min(range.x, min(depths.x, depths.y)), max(range.y, max(depths.x, depths.y)));
}

// The least and greatest depth of the triangle within this pixel's square; empty where it does not touch the square.
vec2 exactRange(Weights weights) {
    vec2 low = gl_FragCoord.xy - 0.5 + INSET, high = gl_FragCoord.xy + 0.5 - INSET;
    vec2 range = vec2(NOTHING, -NOTHING);
    for (int i = 0; i < 3; ++i) addEdge(range, corner[i], corner[(i + 1) % 3], low, high);
    for (int i = 0; i < 4; ++i) {
        vec3 there = weights.here + (float(i & 1) - 0.5) * weights.byX + (float(i >> 1) - 0.5) * weights.byY;
        float depth = depthOf(there);
        bool inside = min(there.x, min(there.y, there.z)) >= 0.0;
        if (inside) range = vec2(min(range.x, depth), max(range.y, depth));
    }
    return range;
}

// The depths of the plane over this pixel's square, but not beyond the triangle's corners.
vec2 planeRange(Weights weights) {
    float depth = depthOf(weights.here), reach = 0.5 * (abs(depthOf(weights.byX)) + abs(depthOf(weights.byY)));
    vec3 depths = vec3(corner[0].z, corner[1].z, corner[2].z);
    float least = min(depths.x, min(depths.y, depths.z)), greatest = max(depths.x, max(depths.y, depths.z));
    return clamp(depth + vec2(-reach, reach), least, greatest);
}

// The bits `first` to `last`, as far as they lie among the 32 from `start` on.
uint bitsBetween(int first, int last, int start) {
    int low = clamp(first - start, 0, 32), high = clamp(last + 1 - start, 0, 32);
    uint below = high == 32 ? 0xffffffffu : (1u << uint(high)) - 1u;
    uint under = low == 32 ? 0xffffffffu : (1u << uint(low)) - 1u;
    return below & ~under;
}

void main() {
    Weights weights = weightsHere();
    vec3 nearest = clamp(weights.here, 1e-6, 1.0);
    nearest /= nearest.x + nearest.y + nearest.z;
    vec2 uv = nearest.x * cornerUv[0] + nearest.y * cornerUv[1] + nearest.z * cornerUv[2];
    if (isHole(baseColor(uv, vec4(dot(nearest, cornerAlpha))).a, uv, 0.0, 0.0)) discard;
    vec2 range = clamp(voxel_exact ? exactRange(weights) : planeRange(weights), -1.0, float(slices) + 1.0);
    int first = int(floor(range.x)), last = int(floor(range.y));
    for (int i = 0; i < targets; ++i) {
        for (int k = 0; k < 4; ++k) bits[i][k] = bitsBetween(first, last, 128 * i + 32 * k);
    }
}
