// Pixels, view space, and the way between them.
// View space is right-handed and looks down -z. A ray through a pixel is (ray.xy, -1); scaled by -viewZ it ends on the
// surface. `rayFromPixel` holds scale (xy) and offset (zw) of ray.xy = pixel * scale + offset, `pixelFromRay` those of
// the way back; pixels are window coordinates: centres at .5, y up.

// The view-space point seen at `pixel` at depth `viewZ` (negative).
vec3 viewPosAt(vec2 pixel, float viewZ, vec4 rayFromPixel) {
    return vec3((pixel * rayFromPixel.xy + rayFromPixel.zw) * -viewZ, viewZ);
}

// The pixel that sees `viewPos`. A point beside or behind the eye lands far off the screen, where nothing is stored.
vec2 pixelAt(vec3 viewPos, vec4 pixelFromRay) {
    return viewPos.xy / max(-viewPos.z, 1e-20) * pixelFromRay.xy + pixelFromRay.zw;
}

// Nothing was drawn there: the G-buffer is cleared to viewZ = -infinity.
bool isBackground(float viewZ) {
    return viewZ < -3.0e38;
}

// How far to lift a point off its surface, along the normal, before asking what blocks it within `reach` (scene units):
// `bias`, but at least a pixel's width at the farthest point asked for. A texel's depth is that of its centre, up to half
// a pixel to each side of where it is asked for, which moves a plane by at most 0.71 pixels: it cannot block itself.
float liftOff(float bias, float reach, vec3 viewPos, vec4 rayFromPixel) {
    return max(bias, (reach - viewPos.z) * rayFromPixel.x);
}
