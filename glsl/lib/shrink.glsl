// Which pixel of a picture lies nearest to the centre of a pixel of its smaller copy.

ivec2 nearestLarge(vec2 smallPixel, ivec2 largeSize, vec4 rayFromPixel, vec4 smallRayFromPixel) {
    vec2 ray = viewPosAt(smallPixel, -1.0, smallRayFromPixel).xy;
    // at half the size two pixels are nearest: rounding must not choose (`Frame.world_normal` chooses the same one)
    return clamp(ivec2((ray - rayFromPixel.zw) / rayFromPixel.xy + 0.01), ivec2(0), largeSize - 1);
}
