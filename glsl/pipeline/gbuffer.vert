// The camera's view of an instance.
// Inputs: local-space vertices, world_from_local a instance. Outputs: view-space position and normal, uv, colour.

in vec3 local_position;
in vec3 local_normal;
in vec2 texture_uv;
in vec4 vertex_color;
in mat4 world_from_local;

uniform mat4 view_from_world;
uniform mat4 clip_from_view;

out vec3 viewPos;
out vec3 viewNormal;
out vec2 uv;
out vec4 color;
flat out float winding;

void main() {
    vec4 position = view_from_world * (world_from_local * vec4(local_position, 1.0));
    mat3 linear = mat3(world_from_local);
    // the cofactor matrix: det × inverse transpose, so it serves every scale, mirrored ones too (the fragment turns it)
    mat3 cofactor = mat3(cross(linear[1], linear[2]), cross(linear[2], linear[0]), cross(linear[0], linear[1]));
    viewPos = position.xyz;
    // normalised here, for the interpolation must not be swayed by the scale
    viewNormal = mat3(view_from_world) * normalize(cofactor * local_normal);
    uv = texture_uv;
    color = vertex_color;
    winding = sign(determinant(linear));
    gl_Position = clip_from_view * position;
}
