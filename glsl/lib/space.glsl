// Transformations between pixels and view space.
// View space is right-handed and looks along -z. The ray through a pixel is (ray.xy, -1); the ray times -viewZ is the
// surface point. `rayFromPixel`: scale (xy) and offset (zw) of ray.xy = pixel * scale + offset; `pixelFromRay`: those
// of the inverse. Pixels are window coordinates: centres at .5, y up. The rays of an orthographic camera are parallel:
// its ray.xy is a position, in scene units, and the surface point is (ray.xy, viewZ).

const bool orthographic;

// The view-space point seen at `pixel`, at depth `viewZ` (negative, scene units).
vec3 viewPosAt(vec2 pixel, float viewZ, vec4 rayFromPixel) {
    return vec3((pixel * rayFromPixel.xy + rayFromPixel.zw) * (orthographic ? 1.0 : -viewZ), viewZ);
}

// The pixel that sees `viewPos`. A point behind the eye, or at its depth, gives a pixel far outside the screen.
vec2 pixelAt(vec3 viewPos, vec4 pixelFromRay) {
    return viewPos.xy / (orthographic ? 1.0 : max(-viewPos.z, 1e-20)) * pixelFromRay.xy + pixelFromRay.zw;
}

// The point at depth `viewZ` on the eye's ray through `viewPos`.
vec3 onRayOf(vec3 viewPos, float viewZ) {
    return orthographic ? vec3(viewPos.xy, viewZ) : viewPos * (viewZ / viewPos.z);
}

// The direction in which the eye sees `viewPos`, of any length.
vec3 sightTo(vec3 viewPos) {
    return orthographic ? vec3(0.0, 0.0, -1.0) : viewPos;
}

// The point at which light arrives on the surface at `viewPos`, for shadow maps: above the surface by more than the error
// of its depth. A rasteriser moves vertices to a grid, mostly of 1/256 of a pixel (GL_SUBPIXEL_BITS = 8). That moves a
// plane by at most 1/362 of a pixel's width.
vec3 litPoint(vec3 viewPos, vec3 normal, vec4 rayFromPixel) {
    return viewPos + normal * (orthographic ? 1.0 : -viewPos.z) * rayFromPixel.x / 256.0;
}

// True if no surface was drawn: the G-buffer is cleared to viewZ = -infinity.
bool isBackground(float viewZ) {
    return viewZ < -3.0e38;
}

// The distance, in scene units, to lift a point along its triangle's normal before points within `reach` are tested for blocking:
// the `bias`, but at least a pixel's width at the farthest tested point. A texel stores the depth of its centre, which
// is up to half a pixel from the lookup in x and in y. That moves a plane by at most 0.71 pixels, so it cannot block
// itself.
float liftOff(float bias, float reach, vec3 viewPos, vec4 rayFromPixel) {
    return max(bias, (orthographic ? 1.0 : reach - viewPos.z) * rayFromPixel.x);
}
