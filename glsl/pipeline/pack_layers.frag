// Peeled depths in one texture, so that a tap reads them all.
// Inputs: layer0 to layer3, the viewZ of each. Output: layersZ (RGBA32F); a layer that was not peeled is background.

const int count;   // layers that were peeled

uniform sampler2D layer0;
uniform sampler2D layer1;
uniform sampler2D layer2;
uniform sampler2D layer3;

out vec4 layersZ;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float none = uintBitsToFloat(0xff800000u);  // -infinity
    layersZ = vec4(texelFetch(layer0, pixel, 0).r, none, none, none);
    if (count > 1) layersZ.y = texelFetch(layer1, pixel, 0).r;
    if (count > 2) layersZ.z = texelFetch(layer2, pixel, 0).r;
    if (count > 3) layersZ.w = texelFetch(layer3, pixel, 0).r;
}
