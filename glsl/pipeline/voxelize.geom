// A triangle for the voxel grid: its depth range, which its fragments must not leave, and the axis that it is drawn along.

layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;

const bool dominant;   // draw only triangles whose normal is nearest to this view's axis

in vec2 cornerUv[];
in float cornerAlpha[];

flat out vec2 depthRange;   // window depth, 0 to 1: least and greatest of the corners
out vec2 uv;
out float alpha;

void main() {
    vec3 a = gl_in[0].gl_Position.xyz, b = gl_in[1].gl_Position.xyz, c = gl_in[2].gl_Position.xyz;
    vec3 normal = abs(cross(b - a, c - a));
    if (dominant && normal.z < max(normal.x, normal.y)) return;
    vec3 depths = 0.5 * vec3(a.z, b.z, c.z) + 0.5;
    for (int i = 0; i < 3; ++i) {
        depthRange = vec2(min(depths.x, min(depths.y, depths.z)), max(depths.x, max(depths.y, depths.z)));
        uv = cornerUv[i];
        alpha = cornerAlpha[i];
        gl_Position = gl_in[i].gl_Position;
        EmitVertex();
    }
    EndPrimitive();
}
