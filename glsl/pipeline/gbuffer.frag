// The G-buffer: what the camera sees, before any light.
// Outputs: surfaceViewZ   view-space z of the surface, negative (R32F; the background is cleared to -infinity)
//          surfaceNormal  unit view-space normal, facing the viewer's side of the triangle (RGBA16F, w 0)
//          surfaceAlbedo  linear diffuse albedo; a is 1 where a surface is, and 0 in the background (RGBA16F)

const bool peel;  // draw what lies behind the layer `nearerZ`, with the mesh's own normals: a solid's back faces away

#include "lib/base_color.glsl"

uniform sampler2D nearerZ;

in vec3 viewPos;
in vec3 viewNormal;
in vec2 uv;
in vec4 color;
flat in float winding;

out float surfaceViewZ;
out vec4 surfaceNormal;
out vec4 surfaceAlbedo;

void main() {
    vec4 base = baseColor(uv, color);
    // peeling needs the backs of solids, be they single-sided
    if (isHole(base.a, uv, peel ? 0.0 : winding)) discard;
    if (peel && viewPos.z >= texelFetch(nearerZ, ivec2(gl_FragCoord.xy), 0).r) discard;
    // the triangle's own normal, towards the viewer; the vertices' winding need not be right for this, nor the sign of the
    // derivatives, which at a horizon reach over to what lies behind the eye
    vec3 faceNormal = cross(dFdx(viewPos), dFdy(viewPos));
    faceNormal = faceforward(faceNormal, viewPos, faceNormal);
    surfaceViewZ = viewPos.z;
    surfaceNormal = vec4(normalize(!peel && dot(viewNormal, faceNormal) < 0.0 ? -viewNormal : viewNormal), 0.0);
    surfaceAlbedo = vec4(clamp(base.rgb, 0.0, 1.0), 1.0);
}
