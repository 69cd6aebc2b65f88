// The camera's view of an instance.
// Inputs: local-space vertices, world_from_local and number of each instance.
// Outputs: view-space position, normal and tangent, uv, colour, baked visibility.

in vec3 local_position;
in vec3 local_normal;
in vec2 texture_uv;
in vec4 vertex_color;
in vec4 local_tangent;
in float vertex_visibility;
in mat4 world_from_local;
in float instance_number;

const bool bent_normals;

uniform mat4 view_from_world;
uniform mat4 clip_from_view;

out vec3 viewPos;
out vec3 viewNormal;
out vec2 uv;
out vec4 color;
out vec4 tangent;          // view space, w the bitangent's sign; 0 without a map of normals
flat out float localScale; // of the instance, so that heights grow with it
out float bakedVisibility;
flat out float winding;
flat out float instance;   // the number of the mesh's instance

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
    bakedVisibility = vertex_visibility;
    winding = sign(determinant(linear));
    instance = instance_number;
    tangent = vec4(0.0);
    localScale = 1.0;
    if (bent_normals) {
        tangent = vec4(mat3(view_from_world) * (linear * local_tangent.xyz), local_tangent.w * winding);
        if (dot(tangent.xyz, tangent.xyz) > 0.0) tangent.xyz = normalize(tangent.xyz);
        localScale = pow(abs(determinant(linear)), 1.0 / 3.0);
    }
    gl_Position = clip_from_view * position;
}
