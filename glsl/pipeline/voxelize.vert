// A vertex of the scene as the orthographic camera of a voxel grid sees it.
// Inputs: local-space vertices, world_from_local of each instance. Outputs: clip-space position, uv, alpha.

in vec3 local_position;
in vec2 texture_uv;
in vec4 vertex_color;
in mat4 world_from_local;

uniform mat4 clip_from_world;

out vec2 vertexUv;
out float vertexAlpha;

void main() {
    vertexUv = texture_uv;
    vertexAlpha = vertex_color.a;
    gl_Position = clip_from_world * (world_from_local * vec4(local_position, 1.0));
}
