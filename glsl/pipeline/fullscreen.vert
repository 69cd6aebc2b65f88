// One triangle that covers the screen, at the far plane: depth 1. No input: three vertices, numbered.

void main() {
    vec2 corner = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);  // (0,0) (2,0) (0,2)
    gl_Position = vec4(2.0 * corner - 1.0, 1.0, 1.0);
}
