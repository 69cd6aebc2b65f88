// The albedo of a scene whose meshes have one albedo each, from the number of the mesh.
// Inputs: viewNormal, palette. Output: albedo, linear RGB; a is 1 where a surface is, and 0 in the background.

uniform sampler2D viewNormal;   // w: the number of the mesh
uniform sampler2D palette;      // albedos by the number of the mesh

out vec4 albedo;

void main() {
    float number = texelFetch(viewNormal, ivec2(gl_FragCoord.xy), 0).w;
    albedo = texelFetch(palette, ivec2(number, 0), 0);
}
