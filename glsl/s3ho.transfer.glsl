// The transfer function of a pixel in S3HO, occlusion and cosine in one: from distant light to irradiance. View space.
// It is included after lib/surface.glsl.

#include "lib/sh.glsl"

uniform sampler2D occlusion0;
uniform sampler2D occlusion1;
uniform sampler2D occlusion2;
uniform sampler2D occlusion3;

// The function f with the coefficients c, no larger than a function that is nowhere negative can be. For f ≥ 0,
//   |∫ f y_l dω| ≤ ∫ f dω max |y_l|,  where y_l is the vector of band l, and |y_l|² = (2l + 1)/4π everywhere:
// band l has at most √(2l + 1) times the length of band 0. Noise exceeds that where nearly all is blocked.
mat4 withinBounds(mat4 c) {
    vec3 squares = vec3(dot(c[0].yzw, c[0].yzw), dot(c[1], c[1]) + c[2].x * c[2].x, dot(c[2].yzw, c[2].yzw) + dot(c[3], c[3]));
    vec3 largest = max(c[0].x, 0.0) * sqrt(vec3(3.0, 5.0, 7.0));
    return shWindow(c, vec4(step(0.0, c[0].x), min(largest * inversesqrt(max(squares, 1e-20)), 1.0)));
}

// c = c_cos(n) - o: an open surface's, less the blocked part (s3ho.frag). Where every direction is blocked, o is the sum
// over all samples, which is c_cos in the mean only; the bounds take away the difference.
mat4 transferOf(Surface surface) {
    vec2 uv = gl_FragCoord.xy * texel_size;
    mat4 blocked = mat4(texture(occlusion0, uv), texture(occlusion1, uv), texture(occlusion2, uv), texture(occlusion3, uv));
    return withinBounds(shClampedCosine(surface.viewNormal) - blocked);
}
