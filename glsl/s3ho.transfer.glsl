// What S3HO knows of a pixel: the transfer from distant light to irradiance, occlusion and cosine in one; view space.

#include "lib/sh.glsl"

uniform sampler2D occlusion0;
uniform sampler2D occlusion1;
uniform sampler2D occlusion2;
uniform sampler2D occlusion3;

// c = c_cos(n) - o: what an open surface has, less what is blocked (s3ho.frag).
mat4 transferAt(ivec2 pixel, vec3 normal) {
    return shClampedCosine(normal) - mat4(texelFetch(occlusion0, pixel, 0), texelFetch(occlusion1, pixel, 0),
                                               texelFetch(occlusion2, pixel, 0), texelFetch(occlusion3, pixel, 0));
}
