// Up to four input textures that a pass treats alike, so that it evaluates the geometry once for all of them.
// The values of a pixel are a mat4, with one column per texture.

const int sources;
const bool single;   // there is one source, of one channel

uniform sampler2D source0;
uniform sampler2D source1;
uniform sampler2D source2;
uniform sampler2D source3;

layout(location = 0) out vec4 results[sources];

// At `uv`, whose texel is the nearest one. Software drivers read a texel by uv in half the time of texelFetch.
mat4 sourcesAt(vec2 uv) {
    mat4 values = mat4(0.0);
    values[0] = texture(source0, uv);
    if (single) values[0].yzw = vec3(0.0);
    if (sources > 1) values[1] = texture(source1, uv);
    if (sources > 2) values[2] = texture(source2, uv);
    if (sources > 3) values[3] = texture(source3, uv);
    return values;
}

mat4 sourcesAt(ivec2 pixel) {
    mat4 values = mat4(0.0);
    values[0] = texelFetch(source0, pixel, 0);
    if (sources > 1) values[1] = texelFetch(source1, pixel, 0);
    if (sources > 2) values[2] = texelFetch(source2, pixel, 0);
    if (sources > 3) values[3] = texelFetch(source3, pixel, 0);
    return values;
}

void writeResults(mat4 values) {
    for (int i = 0; i < sources; ++i) results[i] = values[i];
}
