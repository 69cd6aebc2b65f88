// The grid of voxels as the camera sees it: HAO 2009 (Reinbothe, Boubekeur and Alexa), Fig. 2.
// The eye's ray goes from voxel to voxel (Amanatides and Woo 1987, "A Fast Voxel Traversal Algorithm for Ray Tracing").
// Output:  voxel_grid, a grey in [0, 1] for each face by its angle to the eye; white where the ray meets no voxel.

#include "lib/space.glsl"
#include "occluders.glsl"

uniform vec4 ray_from_pixel;

out vec4 voxel_grid;

const float FACE[3] = float[3](0.75, 0.9, 0.6);  // brightness of the faces across the grid's axes

void main() {
    voxel_grid = vec4(1.0);
    vec3 nearPos = viewPosAt(gl_FragCoord.xy, orthographic ? 0.0 : -1e-4, ray_from_pixel);
    vec3 start = (voxel_from_view * vec4(nearPos, 1.0)).xyz;
    vec3 way = mat3(voxel_from_view) * (viewPosAt(gl_FragCoord.xy, nearPos.z - 1.0, ray_from_pixel) - nearPos);
    way = mix(way, vec3(1e-9), lessThan(abs(way), vec3(1e-9)));

    // into the grid
    vec3 one = -start / way, two = (vec3(voxels) - start) / way;
    vec3 enter = min(one, two), leave = max(one, two);
    float first = max(max(enter.x, max(enter.y, enter.z)), 0.0), last = min(leave.x, min(leave.y, leave.z));
    if (first >= last) return;
    int axis = enter.x == first ? 0 : enter.y == first ? 1 : 2;
    ivec3 voxel = clamp(ivec3(floor(start + way * first)), ivec3(0), ivec3(voxels - 1));

    ivec3 step = ivec3(sign(way));
    vec3 width = 1.0 / abs(way);
    vec3 next = (vec3(voxel) + max(vec3(step), 0.0) - start) / way;
    for (int i = 0; i < 3 * voxels; ++i) {
        if (isVoxelSet(voxel)) {
            voxel_grid = vec4(vec3(FACE[axis] * (0.4 + 0.6 * abs(normalize(way)[axis]))), 1.0);
            return;
        }
        axis = next.x <= min(next.y, next.z) ? 0 : next.y <= next.z ? 1 : 2;
        voxel[axis] += step[axis];
        next[axis] += width[axis];
        if (voxel[axis] < 0 || voxel[axis] >= voxels) return;
    }
}
