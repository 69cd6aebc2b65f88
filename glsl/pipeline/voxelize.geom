// A triangle for the voxel grid: its corners for every fragment, and the pixels that the fragments are for.
// With `voxel_exact`, the pixels are those of the triangle's bounding rectangle; without it, those whose centre it covers.

layout(triangles) in;
layout(triangle_strip, max_vertices = 4) out;

const bool voxel_exact;
const bool dominant;   // draw only triangles whose normal is nearest to this view's axis
const int slices;      // of the grid, along each axis

in vec2 vertexUv[];
in float vertexAlpha[];

flat out vec3 corner[3];      // grid coordinates: pixels, and slices that grow away from the camera
flat out vec2 cornerUv[3];
flat out vec3 cornerAlpha;

void emit(vec4 position) {
    for (int i = 0; i < 3; ++i) {
        corner[i] = (gl_in[i].gl_Position.xyz * 0.5 + 0.5) * float(slices);
        cornerUv[i] = vertexUv[i];
        cornerAlpha[i] = vertexAlpha[i];
    }
    gl_Position = position;
    EmitVertex();
}

void main() {
    vec3 a = gl_in[0].gl_Position.xyz, b = gl_in[1].gl_Position.xyz, c = gl_in[2].gl_Position.xyz;
    vec3 normal = abs(cross(b - a, c - a));
    if (dominant && normal.z < max(normal.x, normal.y)) return;
    if (!voxel_exact) {
        for (int i = 0; i < 3; ++i) emit(gl_in[i].gl_Position);
    } else {
        float side = float(slices);
        vec2 low = floor((clamp(min(a.xy, min(b.xy, c.xy)), -1.0, 1.0) * 0.5 + 0.5) * side);
        vec2 high = ceil((clamp(max(a.xy, max(b.xy, c.xy)), -1.0, 1.0) * 0.5 + 0.5) * side);
        low = 2.0 * low / side - 1.0;
        high = max(2.0 * high / side - 1.0, low + 2.0 / side);
        for (int i = 0; i < 4; ++i) emit(vec4((i & 1) == 0 ? low.x : high.x, i < 2 ? low.y : high.y, 0.0, 1.0));
    }
    EndPrimitive();
}
