// The base colour of a surface: material × vertex colour × texture, and whether there is a surface at all.
// Set for each mesh: base_texture, base_color, alpha_cutoff (below it there is a hole), blended (alpha is the share of
// the pixels that show the surface), mesh_number (from 0 on), single_sided (the surface is seen from its front only),
// has_shares (the texture's smaller levels hold shares of texels).

const bool one_sided;   // some mesh of the scene is single_sided
const bool cut_outs;    // some mesh of the scene has holes, or is blended
const bool textured;    // some mesh of the scene has a texture
const bool vertex_colored;  // some mesh of the scene has colours of its vertices

uniform sampler2D base_texture;
uniform vec4 base_color;
uniform float alpha_cutoff;
uniform bool blended;
uniform float mesh_number;
uniform bool single_sided;
uniform bool has_shares;

// Linear colour and alpha at `uv`, for a vertex colour.
vec4 baseColor(vec2 uv, vec4 vertexColor) {
    vec4 color = base_color;
    if (vertex_colored) color *= vertexColor;
    if (textured) color *= texture(base_texture, uv);
    return color;
}

// A threshold in [0, 1) for a pixel: among its neighbours, all values are as frequent. Interleaved gradient noise, Jimenez
// 2014, slide 123; shifted in each block of 4×4 pixels by another amount for each `surface`, so that of surfaces behind
// each other the pixels are independent.
float ditherThreshold(vec2 pixel, float surface) {
    float noise = fract(52.9829189 * fract(dot(floor(pixel), vec2(0.06711056, 0.00583715))));
    float shift = fract(sin(dot(vec3(floor(pixel / 4.0), surface), vec3(12.9898, 78.233, 37.719))) * 43758.5453);
    return fract(noise + shift);
}

// A hole in the surface at this pixel, or the back of a surface that has none. `winding`: 1, -1 where the instance is
// mirrored, 0 where backs count. `instance`: the number of the mesh's instance. Instances, and the fronts and backs of one
// surface, show different pixels, so that a blended bottle hides by both of its sides.
//
// Near, a texel's alpha decides (alpha_cutoff). In the texture's smaller levels alpha holds the share of the texels that
// are above the cutoff, and that share of the pixels is drawn: leaves do not vanish in the distance.
bool isHole(float alpha, vec2 uv, float winding, float instance) {
    if (one_sided && single_sided && winding != 0.0 && gl_FrontFacing == (winding < 0.0)) return true;
    if (!cut_outs || (!blended && alpha_cutoff <= 0.0)) return false;
    float surface = mesh_number + 0.37 * instance + (gl_FrontFacing ? 0.0 : 0.5);
    float threshold = ditherThreshold(gl_FragCoord.xy, surface);
    if (blended) return alpha <= threshold;
    if (!has_shares) return alpha < alpha_cutoff;
    float share = texture(base_texture, uv).a;
    if (share == 0.0 || alpha < alpha_cutoff * share) return true;  // the rest of the material may be below the cutoff
    vec2 texels = vec2(textureSize(base_texture, 0));
    vec2 right = dFdx(uv) * texels, up = dFdy(uv) * texels;
    float level = 0.5 * log2(max(max(dot(right, right), dot(up, up)), 1e-20));
    float far = clamp(level, 0.0, 1.0);
    return mix(alpha, share, far) < mix(alpha_cutoff, threshold, far);
}
