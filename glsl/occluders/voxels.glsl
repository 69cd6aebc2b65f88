// Occluders: a grid of voxels, a bit each (HAO, Reinbothe, Boubekeur and Alexa 2009, sections 5 and 6).
// Surfaces behind others, and outside the picture, block as well. A voxel is a shell of the surface: solids are hollow, and a
// step longer than a voxel may pass through a wall. `thickness` means nothing here.
//
// The receiver lies in a voxel itself. Its own plane, with normal n, touches voxels whose centre is at most
// ½ (|n·a| + |n·b| + |n·c|) away, for the voxel's edges a, b and c. These voxels, those below, and those next to the receiver do
// not block it.

#include "occluders/surfaces.glsl"
#include "lib/voxel_grid.glsl"

// A voxel blocks if its centre is so far above the receiver's plane, as a share of |n·a| + |n·b| + |n·c|, and so far from the
// receiver, in voxels. The exact share is ½, and any distance would do for planes; the rest is for curved surfaces. The values
// had the least error on `colonnade`, 256³ voxels and 8 steps, of some forty settings: shares 0.5 to 1.5, distances to 3.
const float ABOVE = 0.65;
const float AWAY = 1.5;

// A blocker: the voxel's centre in view space.
struct Occluder {
    vec3 viewPos;
};

// Is the view-space point `samplePos` in a set voxel that lies above the receiver's own plane?
bool isBlocked(Receiver receiver, vec3 samplePos, float thickness, out Occluder occluder) {
    ivec3 voxel = ivec3(floor((voxel_from_view * vec4(samplePos, 1.0)).xyz));
    vec3 centre = vec3(voxel) + 0.5;
    occluder.viewPos = (view_from_voxel * vec4(centre, 1.0)).xyz;
    vec3 edges = abs(receiver.facet * mat3(view_from_voxel));   // along the normal
    float height = edges.x + edges.y + edges.z;
    vec3 away = centre - (voxel_from_view * vec4(receiver.viewPos, 1.0)).xyz;
    bool own = dot(receiver.facet, occluder.viewPos - receiver.viewPos) < ABOVE * height || dot(away, away) < AWAY * AWAY;
    return !own && isVoxelSet(voxel);
}

// Voxels have neither normals nor light: of an occluder that the camera sees, the G-buffer has both; others send nothing.
bool isSeen(Occluder occluder, out vec2 uv) {
    uv = pixelAt(occluder.viewPos, pixel_from_ray) * texel_size;
    float voxelSize = length(view_from_voxel[0].xyz) + length(view_from_voxel[1].xyz) + length(view_from_voxel[2].xyz);
    return abs(texture(viewZ, uv).r - occluder.viewPos.z) < voxelSize;
}

// The occluder's unit normal, view space; 0 where it is unknown.
vec3 occluderNormal(Occluder occluder) {
    vec2 uv;
    bool seen = isSeen(occluder, uv);
    return seen ? texture(viewNormal, uv).xyz : vec3(0.0);
}

// The light that leaves the occluder; 0 where it is unknown.
vec3 occluderRadiance(Occluder occluder) {
    vec2 uv;
    bool seen = isSeen(occluder, uv);
    return seen ? texture(sender, uv).rgb : vec3(0.0);
}
