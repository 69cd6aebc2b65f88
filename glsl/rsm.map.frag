// Reflective shadow map: the surfaces that a light sees, and the light that each of them reflects.
// Dachsbacher and Stamminger 2005, "Reflective Shadow Maps", section 3.1; Chow 2014. A pixel of the map is a pixel light.
//
// Inputs:  the scene's lights, and rsm_table: a row a tile, see aolab/pipeline/reflective.py.
// Outputs: rsm_position  xyz the point, world space; w the area of the surface that the pixel shows, squared scene units
//          rsm_normal    the unit normal, world space, on the side of the light
//          rsm_flux      Φ, the flux that this surface reflects, RGB: albedo × irradiance × area
//          rsm_depth     the distance to the light along the map's axis, scene units; +infinity where nothing is

#include "lib/base_color.glsl"
#include "lib/lights.glsl"

uniform sampler2D rsm_table;
uniform mat4 world_from_view;

in vec3 viewPos;
in vec3 viewNormal;
in vec2 uv;
in vec4 color;
flat in float winding;
flat in float instance;

out vec4 rsm_position;
out vec4 rsm_normal;
out vec4 rsm_flux;
out float rsm_depth;

void main() {
    vec4 base = baseColor(uv, color);
    if (isHole(base.a, uv, winding, instance)) discard;
    int size = int(texelFetch(rsm_table, ivec2(4, 0), 0).z);
    vec4 about = texelFetch(rsm_table, ivec2(4, int(gl_FragCoord.x) / size), 0);
    int light = int(about.x);
    vec3 worldPos = (world_from_view * vec4(viewPos, 1.0)).xyz;
    vec3 worldNormal = normalize(mat3(world_from_view) * viewNormal);
    float arriving;
    vec3 toLight = towardsLightAt(light, worldPos, arriving);
    worldNormal = faceforward(worldNormal, -toLight, worldNormal);
    // the pixel's cross-section, perpendicular to the light's ray: of parallel rays, its area is the same everywhere
    float width = about.y * (light_kind[light] == DIRECTIONAL ? 1.0 : -viewPos.z);
    float section = width * width * (light_kind[light] == DIRECTIONAL ? 1.0 : -viewPos.z / length(viewPos));
    rsm_position = vec4(worldPos, section / max(dot(worldNormal, toLight), 0.05));
    rsm_normal = vec4(worldNormal, 0.0);
    rsm_flux = vec4(clamp(base.rgb, 0.0, 1.0) * light_color[light] * arriving * section, 1.0);
    rsm_depth = -viewPos.z;
}
