// The nine coefficients of S3HO's bounce, each red, green and blue, and one further number, in seven texels: rgb of texel i
// is coefficient i. The alphas of texels 0 to 2 are coefficient 7, those of 3 to 5 coefficient 8; the alpha of 6 is the
// number. The NumPy twin is `unpacked` in aolab/modules/s3ho.py.

vec4[7] packBounce(vec3 c[9], float number) {
    return vec4[7](vec4(c[0], c[7].r), vec4(c[1], c[7].g), vec4(c[2], c[7].b),
                   vec4(c[3], c[8].r), vec4(c[4], c[8].g), vec4(c[5], c[8].b), vec4(c[6], number));
}

vec3[9] unpackBounce(vec4 t[7]) {
    return vec3[9](t[0].rgb, t[1].rgb, t[2].rgb, t[3].rgb, t[4].rgb, t[5].rgb, t[6].rgb,
                   vec3(t[0].a, t[1].a, t[2].a), vec3(t[3].a, t[4].a, t[5].a));
}
