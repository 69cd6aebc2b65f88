// The grid of voxels, a bit each (aolab/modules/occluders/voxels.py).

const int voxels;

uniform usampler2D voxelWords;   // R32UI: tiles of 32 slices, eight in a row
uniform mat4 voxel_from_view;    // view space to voxels: the integer part is a voxel's index
uniform mat4 view_from_voxel;
uniform mat4 region_from_view;   // the region of interest is the cube -1 to 1

bool isVoxelSet(ivec3 voxel) {
    if (any(lessThan(voxel, ivec3(0))) || any(greaterThanEqual(voxel, ivec3(voxels)))) return false;
    int index = voxel.z >> 5;
    ivec2 tile = ivec2(index & 7, index >> 3);
    uint word = texelFetch(voxelWords, tile * voxels + voxel.xy, 0).r;
    return ((word >> uint(voxel.z & 31)) & 1u) == 1u;
}

// Is the view-space point in the region of interest?
bool inRegion(vec3 viewPos) {
    vec3 place = abs((region_from_view * vec4(viewPos, 1.0)).xyz);
    return max(place.x, max(place.y, place.z)) <= 1.0;
}
