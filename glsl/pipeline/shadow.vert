// A light's view of an instance: depth only.

in vec3 local_position;
in vec2 texture_uv;
in vec4 vertex_color;
in mat4 world_from_local;
in float instance_number;

uniform mat4 clip_from_world;

out vec2 uv;
out float alpha;
flat out float winding;
flat out float instance;

void main() {
    uv = texture_uv;
    alpha = vertex_color.a;
    instance = instance_number;
    winding = sign(determinant(mat3(world_from_local)));
    gl_Position = clip_from_world * (world_from_local * vec4(local_position, 1.0));
}
