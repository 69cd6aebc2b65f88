// The G-buffer: the surfaces that the camera sees, before any light.
// Outputs: surfaceViewZ   view-space z of the surface, negative (R32F; the background is cleared to -infinity)
//          surfaceNormal  unit view-space normal, facing the viewer's side of the triangle; w: the number of the mesh (RGBA16F)
//          surfaceAlbedo  linear diffuse albedo; a is 1 where a surface is, and 0 in the background (RGBA16F)
// On demand: surfaceUv       texture coordinates (RG32F)
//            surfaceTangent  unit view-space direction on the surface in which u grows, 0 without uv (RGBA16F)
//            surfaceEmission radiance that the material sends by itself, linear RGB (RGBA32F)
//            surfaceFacets   the normal of the triangle, on the side of surfaceNormal, in an azimuthal map around +z (RG16)
//            surfaceBaked    visibility that is baked into the vertices, 1 where none is (R16F)
//            surfaceMotion   pixels moved since the last frame, by the camera (RG32F)
//            surfaceGeometricNormal  surfaceNormal without normal and height maps (RGBA16F)
//            surfaceReliefU, surfaceReliefV  gradients of u and v in view space; w: the height map's number from 1, 0 for
//                            none; and the scale of its heights, negative where the surface is seen from behind (RGBA32F)

#include "lib/space.glsl"

const bool with_facets;
const bool with_uv;
const bool with_tangent;
const bool with_emission;
const bool with_baked;
const bool with_motion;
const bool with_geometricNormal;
const bool with_reliefU;
const bool with_reliefV;
const bool bent_normals; // a mesh of the scene has a map of normals or heights
const bool has_last;   // there is a last frame to have moved from
const bool peel;  // draw what lies behind the layer `nearerZ`, with the mesh's own normals: a solid's back faces away

#include "lib/base_color.glsl"
#include "lib/relief.glsl"
#include "lib/azimuthal.glsl"

uniform sampler2D nearerZ;
uniform sampler2D emission_texture;
uniform vec3 emission;  // of each mesh, times its texture
uniform sampler2D normal_texture;
uniform float normal_scale;
uniform bool normal_mapped;
uniform int relief_number;   // of each mesh, from 1; 0 for none
uniform bool is_smooth;  // of each mesh: its normals are not those of its triangles
uniform vec4 pixel_from_ray;
uniform mat4 last_from_view;        // the last camera's view space from this one's
uniform vec4 last_pixel_from_ray;

in vec3 viewPos;
in vec3 viewNormal;
in vec2 uv;
in vec4 color;
in vec4 tangent;
flat in float localScale;
in float bakedVisibility;
flat in float winding;
flat in float instance;

out float surfaceViewZ;
out vec4 surfaceNormal;
out vec4 surfaceAlbedo;
out vec2 surfaceFacets;
out vec2 surfaceUv;
out vec4 surfaceTangent;
out vec4 surfaceEmission;
out float surfaceBaked;
out vec2 surfaceMotion;
out vec4 surfaceGeometricNormal;
out vec4 surfaceReliefU;
out vec4 surfaceReliefV;

// The derivative of the position by u, of unit length and in the surface.
vec3 tangentHere(vec3 normal) {
    vec3 alongX = dFdx(viewPos), alongY = dFdy(viewPos);
    vec2 uvX = dFdx(uv), uvY = dFdy(uv);
    vec3 byU = (alongX * uvY.y - alongY * uvX.y) * sign(uvX.x * uvY.y - uvX.y * uvY.x);
    byU -= normal * dot(normal, byU);
    float size = length(byU);
    return size > 0.0 ? byU / size : vec3(0.0);
}

// The gradients of u and v over the triangle's plane, view space: the change of uv by a step d is (dot(∇u, d), dot(∇v, d)).
void uvGradients(out vec3 byU, out vec3 byV) {
    vec3 alongX = dFdx(viewPos), alongY = dFdy(viewPos);
    vec2 uvX = dFdx(uv), uvY = dFdy(uv);
    vec3 plane = cross(alongX, alongY);
    vec3 dualX = cross(alongY, plane), dualY = cross(plane, alongX);
    float area = max(dot(plane, plane), 1e-30);
    byU = (uvX.x * dualX + uvY.x * dualY) / area;
    byV = (uvX.y * dualX + uvY.y * dualY) / area;
}

// `normal`, the vertices', bent by the map of normals, or else by the slope of the height map (Blinn 1978).
vec3 bentNormal(vec3 normal, vec3 byU, vec3 byV) {
    if (normal_mapped) {
        vec3 mapped = 2.0 * texture(normal_texture, uv).xyz - 1.0;
        mapped.xy *= normal_scale;
        vec3 upright = winding * viewNormal;                        // MikkTSpace: interpolated, not of unit length
        vec3 bitangent = tangent.w * cross(upright, tangent.xyz);
        vec3 bent = mapped.x * tangent.xyz + mapped.y * bitangent + mapped.z * upright;
        return dot(bent, bent) > 0.0 ? normalize(bent) : normal;
    }
    if (relief_number == 0) return normal;
    vec2 slope = slopeAt(relief_number - 1, uv) * localScale;
    return normalize(normal - slope.x * byU - slope.y * byV);
}

void main() {
    vec4 base = baseColor(uv, color);
    // peeling needs the backs of solids, be they single-sided
    if (isHole(base.a, uv, peel ? 0.0 : winding, instance)) discard;
    if (peel && viewPos.z >= texelFetch(nearerZ, ivec2(gl_FragCoord.xy), 0).r) discard;
    // the triangle's own normal, towards the viewer; the vertices' winding need not be right for this, nor the sign of the
    // derivatives, which at a horizon reach over to what lies behind the eye
    vec3 faceNormal = cross(dFdx(viewPos), dFdy(viewPos));
    faceNormal = faceforward(faceNormal, sightTo(viewPos), faceNormal);
    surfaceViewZ = viewPos.z;
    float side = !peel && dot(viewNormal, faceNormal) < 0.0 ? -1.0 : 1.0;
    vec3 normal = normalize(viewNormal);
    surfaceNormal = vec4(side * normal, mesh_number);
    if (with_geometricNormal) surfaceGeometricNormal = surfaceNormal;
    if (bent_normals) {
        vec3 byU, byV;
        uvGradients(byU, byV);
        float front = side * winding;  // 1 where the mesh's front faces the viewer; a mirrored instance's normals point inside
        surfaceNormal.xyz = front * bentNormal(winding * normal, byU, byV);
        if (with_reliefU) surfaceReliefU = vec4(byU, float(relief_number));
        if (with_reliefV) surfaceReliefV = vec4(byV, front * localScale);
    } else {
        if (with_reliefU) surfaceReliefU = vec4(0.0);
        if (with_reliefV) surfaceReliefV = vec4(0.0);
    }
    surfaceAlbedo = vec4(clamp(base.rgb, 0.0, 1.0), 1.0);
    if (with_facets) {
        // derivatives over a pixel are rounded, in a large triangle: those of a flat mesh are not needed
        vec3 facet = is_smooth ? normalize(faceNormal) : side * normal;
        surfaceFacets = azimuthalUv(faceforward(facet, -surfaceNormal.xyz, facet));
    }
    if (with_uv) surfaceUv = uv;
    if (with_tangent) surfaceTangent = vec4(tangentHere(surfaceNormal.xyz), 0.0);
    if (with_emission) surfaceEmission = vec4(emission * texture(emission_texture, uv).rgb, 1.0);
    if (with_baked) surfaceBaked = bakedVisibility;
    if (with_motion) {
        vec3 lastPos = (last_from_view * vec4(viewPos, 1.0)).xyz;
        surfaceMotion = has_last ? pixelAt(viewPos, pixel_from_ray) - pixelAt(lastPos, last_pixel_from_ray) : vec2(0.0);
    }
}
