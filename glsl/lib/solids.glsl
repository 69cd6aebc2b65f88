// Solids between peeled layers of depth (SSDO, Ritschel et al. 2009, section 4): the first and second depth are the front
// and back of one, and so are the third and fourth.

// Which layer, 0 to 3, is the nearer side of the solid that `viewZ` is in, or -1 where it is in none. `layersZ`: the depths
// of four layers, -infinity where there is none. A solid without a back is taken to be `thickness` deep.
int solidAt(vec4 layersZ, float viewZ, float thickness) {
    bool second = layersZ.z > viewZ;
    vec2 solid = second ? layersZ.zw : layersZ.xy;
    bool open = isBackground(solid.y);
    float backZ = open ? solid.x - thickness : solid.y;
    if (!(solid.x > viewZ && viewZ > backZ)) return -1;
    return (second ? 2 : 0) + (open || solid.x - viewZ < viewZ - solid.y ? 0 : 1);
}
