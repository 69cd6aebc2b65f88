// Solids between peeled depth layers (SSDO, Ritschel et al. 2009, section 4): layers 0 and 1 are the front and the back
// of a solid, and so are layers 2 and 3.

// If `viewZ` lies in a solid, the index, 0 to 3, of the layer of the nearer side, front or back; otherwise -1.
// `layersZ`: viewZ of the four layers, -infinity for a missing layer. A solid without a back is assumed to be
// `thickness` deep.
int solidAt(vec4 layersZ, float viewZ, float thickness) {
    bool second = layersZ.z > viewZ;
    vec2 solid = second ? layersZ.zw : layersZ.xy;
    bool open = isBackground(solid.y);
    float backZ = open ? solid.x - thickness : solid.y;
    if (!(solid.x > viewZ && viewZ > backZ)) return -1;
    return (second ? 2 : 0) + (open || solid.x - viewZ < viewZ - solid.y ? 0 : 1);
}
