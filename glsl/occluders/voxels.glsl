// Occluders: a grid of voxels around the scene, a bit each (HAO, Reinbothe, Boubekeur and Alexa 2009, sections 5 and 6).
// Surfaces behind others, and outside the picture, block as well. A voxel is a shell of the surface: solids are hollow, and a
// step longer than a voxel may pass through a wall. `thickness` means nothing here.
//
// The receiver lies in a voxel itself. A point in a voxel that the receiver's plane touches is at most
// |n_x| + |n_y| + |n_z| voxels above the plane (n along the grid's axes), so that points lower than this are open.

#include "occluders/surfaces.glsl"

const int voxels;

uniform usampler2D voxelWords;   // R32UI: tiles of 32 slices, eight in a row
uniform mat4 voxel_from_view;    // view space to voxels: the integer part is a voxel's index
uniform mat4 view_from_voxel;

const float OWN_VOXELS = 1.05;   // 5 % beyond the bound: rounding of positions

// What blocks: the voxel's centre in view space.
struct Occluder {
    vec3 viewPos;
};

bool isVoxelSet(ivec3 voxel) {
    if (any(lessThan(voxel, ivec3(0))) || any(greaterThanEqual(voxel, ivec3(voxels)))) return false;
    int index = voxel.z >> 5;
    ivec2 tile = ivec2(index & 7, index >> 3);
    uint word = texelFetch(voxelWords, tile * voxels + voxel.xy, 0).r;
    return ((word >> uint(voxel.z & 31)) & 1u) == 1u;
}

// Is the view-space point `samplePos` in a set voxel that the receiver's own plane does not touch?
bool isBlocked(Receiver receiver, vec3 samplePos, float thickness, out Occluder occluder) {
    vec3 place = (voxel_from_view * vec4(samplePos, 1.0)).xyz;
    vec3 above = mat3(voxel_from_view) * (samplePos - receiver.viewPos);  // voxels
    vec3 normal = normalize(mat3(voxel_from_view) * receiver.normal);     // the grid is a rotation and one scale
    ivec3 voxel = ivec3(floor(place));
    occluder.viewPos = (view_from_voxel * vec4(vec3(voxel) + 0.5, 1.0)).xyz;
    bool own = dot(normal, above) < OWN_VOXELS * dot(abs(normal), vec3(1.0));
    return !own && isVoxelSet(voxel);
}

// Voxels have neither normals nor light: of an occluder that the camera sees, the G-buffer has both; others send nothing.
bool isSeen(Occluder occluder, out vec2 uv) {
    uv = pixelAt(occluder.viewPos, pixel_from_ray) * texel_size;
    float voxelSize = length(view_from_voxel[0].xyz);
    return abs(texture(viewZ, uv).r - occluder.viewPos.z) < 2.0 * voxelSize;
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
