// The albedo of a pixel from a palette, which has the albedo of each mesh. Of meshes with patterns (textures, or colours of
// vertices) the albedo of each pixel is drawn.

const bool has_patterns;   // some mesh has patterns

uniform sampler2D palette;    // albedos by the number of the mesh; a is 0 for a mesh with patterns
uniform sampler2D patterns;   // the albedo of meshes with patterns; unspecified elsewhere

// `mesh`: viewNormal.w at the pixel. Returns linear RGB, and 1.
vec4 paletteAlbedo(ivec2 pixel, float mesh) {
    vec4 found = texelFetch(palette, ivec2(mesh, 0), 0);
    return has_patterns && found.a == 0.0 ? texelFetch(patterns, pixel, 0) : found;
}
