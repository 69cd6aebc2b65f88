// What S3HO knows of a pixel: the transfer from distant light to irradiance, occlusion and cosine in one; view space.

#include "lib/sh.glsl"

const int directions;

uniform sampler2D occlusion0;
uniform sampler2D occlusion1;
uniform sampler2D occlusion2;
uniform sampler2D occlusion3;

// c = c_cos(n) - o: what an open surface has, less what is blocked (s3ho.frag).
// Where every direction is blocked, o is the sum over all samples, and not quite c_cos: what the difference lets through is
// noise. It fades out below one open direction, 1/N of visibility, which c's first coefficient is √π/2 times.
mat4 transferAt(ivec2 pixel, vec3 normal) {
    mat4 blocked = mat4(texelFetch(occlusion0, pixel, 0), texelFetch(occlusion1, pixel, 0),
                        texelFetch(occlusion2, pixel, 0), texelFetch(occlusion3, pixel, 0));
    mat4 transfer = shClampedCosine(normal) - blocked;
    float visibility = transfer[0].x * 1.12837917;  // 2/√π
    return transfer * clamp(visibility * float(directions), 0.0, 1.0);
}
