// Tone mapping and sRGB encoding: the last steps from linear radiance to the screen.

// The sRGB code of a linear colour (IEC 61966-2-1).
vec3 srgbFromLinear(vec3 linear) {
    vec3 low = linear * 12.92;
    vec3 high = 1.055 * pow(max(linear, 0.0), vec3(1.0 / 2.4)) - 0.055;
    return mix(high, low, lessThanEqual(linear, vec3(0.0031308)));
}

// A filmic tone curve: Narkowicz 2016, "ACES Filmic Tone Mapping Curve", an analytic fit.
vec3 filmic(vec3 radiance) {
    return clamp(radiance * (2.51 * radiance + 0.03) / (radiance * (2.43 * radiance + 0.59) + 0.14), 0.0, 1.0);
}
