// Peeled depths in one texture, so that a tap reads them all.
// Inputs: viewZ, viewZ1, viewZ2, viewZ3. Output: layersZ (RGBA32F); what was not peeled is background.

const int layers;

uniform sampler2D viewZ;
uniform sampler2D viewZ1;
uniform sampler2D viewZ2;
uniform sampler2D viewZ3;

out vec4 layersZ;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float none = uintBitsToFloat(0xff800000u);  // -infinity
    layersZ = vec4(texelFetch(viewZ, pixel, 0).r, none, none, none);
    if (layers > 1) layersZ.y = texelFetch(viewZ1, pixel, 0).r;
    if (layers > 2) layersZ.z = texelFetch(viewZ2, pixel, 0).r;
    if (layers > 3) layersZ.w = texelFetch(viewZ3, pixel, 0).r;
}
