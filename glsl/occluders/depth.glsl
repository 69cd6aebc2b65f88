// Occluders: one depth layer, the camera's. Every occluder kind has this one function.
// "A sampling point is below the surface if its distance to the viewer decreases by projecting it onto the surface"
// (SSDO, Ritschel et al. 2009, section 3).

uniform sampler2D viewZ;          // R32F; its border says -infinity: nothing is known off the screen, and nothing blocks
uniform vec2 texel_size;          // 1 / resolution
uniform vec4 pixel_from_ray;

// Is the view-space point `samplePos` blocked, and by what? What is seen there has no known back: it is taken to be
// `thickness` deep, so that a far foreground throws no halo (Umenhoffer et al. 2009, section 4.3: R > z - z* > 0).
// `occluderPos` is where the eye's ray to the point meets the surface.
bool isBlocked(vec3 samplePos, float thickness, out vec3 occluderPos) {
    float surfaceZ = texture(viewZ, pixelAt(samplePos, pixel_from_ray) * texel_size).r;
    occluderPos = samplePos * (surfaceZ / samplePos.z);
    float depthBehind = surfaceZ - samplePos.z;
    return abs(depthBehind - 0.5 * thickness) < 0.5 * thickness;  // 0 < depthBehind < thickness in one comparison
}
