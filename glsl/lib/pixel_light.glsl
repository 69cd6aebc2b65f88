// A pixel light in 128 bits, so that a sample of a reflective shadow map is one fetch. The words, from the lowest bits on:
//   x  16 bits of each of the position's x and y, in the cube `rsm_box` (xyz its centre, w half its side; world space)
//   y  16 bits of its z; 16 bits of √area, in halves of the cube's side
//   z  10 bits of each of the normal's x, y, z, from -1 to 1
//   w  8 bits of each of the flux's red, green, blue, and their exponent (Ward 1991, "Real Pixels")
// In a cube of 10 m, a position is exact to 0.08 mm; a normal to 0.1°; the flux to 0.4 % of its largest component.

struct PixelLight {
    vec3 worldPos;
    float area;      // squared scene units
    vec3 normal;     // world space
    vec3 flux;
};

uint bits(float value, float most) { return uint(clamp(value, 0.0, 1.0) * most + 0.5); }

uvec4 wordsOf(PixelLight light, vec4 rsm_box) {
    vec3 inBox = (light.worldPos - rsm_box.xyz) / rsm_box.w * 0.5 + 0.5;
    vec3 normal = light.normal * 0.5 + 0.5;
    float most = max(light.flux.r, max(light.flux.g, light.flux.b));
    float exponent = most > 0.0 ? clamp(ceil(log2(most / 255.0)) + 127.0, 0.0, 255.0) : 0.0;
    vec3 flux = light.flux / exp2(exponent - 127.0) / 255.0;
    return uvec4(bits(inBox.x, 65535.0) | bits(inBox.y, 65535.0) << 16,
                 bits(inBox.z, 65535.0) | bits(sqrt(light.area) / rsm_box.w, 65535.0) << 16,
                 bits(normal.x, 1023.0) | bits(normal.y, 1023.0) << 10 | bits(normal.z, 1023.0) << 20,
                 bits(flux.r, 255.0) | bits(flux.g, 255.0) << 8 | bits(flux.b, 255.0) << 16 | uint(exponent) << 24);
}

// The signed integers of the arguments convert to float faster than unsigned ones on llvmpipe.
PixelLight pixelLightOf(uvec4 words, vec4 rsm_box) {
    ivec4 low = ivec4(words & 0xffffu), high = ivec4(words >> 16u);
    float side = float(high.y) * (rsm_box.w / 65535.0);
    vec3 inBox = vec3(low.x, high.x, low.y) * (2.0 / 65535.0) - 1.0;
    ivec3 normal = ivec3(words.zzz >> uvec3(0u, 10u, 20u)) & 1023;
    ivec3 flux = ivec3(words.www >> uvec3(0u, 8u, 16u)) & 255;
    // the bits of the exponent, where a float has them, are 2 to its power
    float scale = uintBitsToFloat(words.w >> 1u & 0x7f800000u);
    return PixelLight(inBox * rsm_box.w + rsm_box.xyz, side * side, vec3(normal) * (2.0 / 1023.0) - 1.0, vec3(flux) * scale);
}
