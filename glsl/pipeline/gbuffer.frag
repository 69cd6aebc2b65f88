// The G-buffer: the surfaces that the camera sees, before any light.
// Outputs: surfaceViewZ   view-space z of the surface, negative (R32F; the background is cleared to -infinity)
//          surfaceNormal  unit view-space normal, facing the viewer's side of the triangle (RGBA16F, w 0)
//          surfaceAlbedo  linear diffuse albedo; a is 1 where a surface is, and 0 in the background (RGBA16F)
// On demand: surfaceUv       texture coordinates (RG32F)
//            surfaceTangent  unit view-space direction on the surface in which u grows, 0 without uv (RGBA16F)
//            surfaceEmission radiance that the material sends by itself, linear RGB (RGBA32F)
//            surfaceFacetNormal  unit view-space normal of the triangle, on the side of surfaceNormal (RGBA16F, w 0)
//            surfaceMotion   pixels moved since the last frame, by the camera (RG32F)

#include "lib/space.glsl"

const bool with_facetNormal;
const bool with_uv;
const bool with_tangent;
const bool with_emission;
const bool with_motion;
const bool has_last;   // there is a last frame to have moved from
const bool peel;  // draw what lies behind the layer `nearerZ`, with the mesh's own normals: a solid's back faces away

#include "lib/base_color.glsl"

uniform sampler2D nearerZ;
uniform sampler2D emission_texture;
uniform vec3 emission;  // of each mesh, times its texture
uniform bool is_smooth;  // of each mesh: its normals are not those of its triangles
uniform vec4 pixel_from_ray;
uniform mat4 last_from_view;        // the last camera's view space from this one's
uniform vec4 last_pixel_from_ray;

in vec3 viewPos;
in vec3 viewNormal;
in vec2 uv;
in vec4 color;
flat in float winding;

out float surfaceViewZ;
out vec4 surfaceNormal;
out vec4 surfaceAlbedo;
out vec4 surfaceFacetNormal;
out vec2 surfaceUv;
out vec4 surfaceTangent;
out vec4 surfaceEmission;
out vec2 surfaceMotion;

// The derivative of the position by u, of unit length and in the surface.
vec3 tangentHere(vec3 normal) {
    vec3 alongX = dFdx(viewPos), alongY = dFdy(viewPos);
    vec2 uvX = dFdx(uv), uvY = dFdy(uv);
    vec3 byU = (alongX * uvY.y - alongY * uvX.y) * sign(uvX.x * uvY.y - uvX.y * uvY.x);
    byU -= normal * dot(normal, byU);
    float size = length(byU);
    return size > 0.0 ? byU / size : vec3(0.0);
}

void main() {
    vec4 base = baseColor(uv, color);
    // peeling needs the backs of solids, be they single-sided
    if (isHole(base.a, uv, peel ? 0.0 : winding)) discard;
    if (peel && viewPos.z >= texelFetch(nearerZ, ivec2(gl_FragCoord.xy), 0).r) discard;
    // the triangle's own normal, towards the viewer; the vertices' winding need not be right for this, nor the sign of the
    // derivatives, which at a horizon reach over to what lies behind the eye
    vec3 faceNormal = cross(dFdx(viewPos), dFdy(viewPos));
    faceNormal = faceforward(faceNormal, sightTo(viewPos), faceNormal);
    surfaceViewZ = viewPos.z;
    surfaceNormal = vec4(normalize(!peel && dot(viewNormal, faceNormal) < 0.0 ? -viewNormal : viewNormal), 0.0);
    surfaceAlbedo = vec4(clamp(base.rgb, 0.0, 1.0), 1.0);
    if (with_facetNormal) {
        // derivatives over a pixel are rounded, in a large triangle: those of a flat mesh are not needed
        vec3 facet = is_smooth ? normalize(faceNormal) : surfaceNormal.xyz;
        surfaceFacetNormal = vec4(faceforward(facet, -surfaceNormal.xyz, facet), 0.0);
    }
    if (with_uv) surfaceUv = uv;
    if (with_tangent) surfaceTangent = vec4(tangentHere(surfaceNormal.xyz), 0.0);
    if (with_emission) surfaceEmission = vec4(emission * texture(emission_texture, uv).rgb, 1.0);
    if (with_motion) {
        vec3 lastPos = (last_from_view * vec4(viewPos, 1.0)).xyz;
        surfaceMotion = has_last ? pixelAt(viewPos, pixel_from_ray) - pixelAt(lastPos, last_pixel_from_ray) : vec2(0.0);
    }
}
