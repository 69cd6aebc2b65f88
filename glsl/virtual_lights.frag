// The irradiance of virtual lights with a shadow map each: a batch of them, added to those before it.
// Ritschel, Grosch and Seidel 2009, section 5; Keller 1997. A light is far away (of an environment), or a point on a lit
// surface that sends Φ/π cosθ_p. The bias of every shadow map can be filled on the screen (lib/fill.glsl).
//
// Inputs:  viewZ, viewNormal; light_rows: three texels a light: the direction to a far light, or the position (xyz), world
//          space, and the bound of its geometry term (w); the normal (xyz) and whether it is far (w); ∫ L dω of a far one, or
//          Φ (rgb). Its shadow tile is its number.
// Output:  irradiance: rgb Σ over the batch: far, ∫ L dω cosθ; near, Φ/π min(cosθ cosθ_p / d², bound), times the shadow.

#include "lib/space.glsl"
#include "lib/fill.glsl"

const int batch;             // lights a pass: software drivers end a shader's loops after 65,535 steps in all

uniform sampler2D light_rows;
uniform int first_light;
uniform int light_count;
uniform vec4 ray_from_pixel;

out vec4 irradiance;

// The irradiance without shadow; `toLight`: unit, world space, `away` its distance.
vec3 arriving(int i, vec3 worldPos, vec3 worldNormal, out vec3 toLight, out float away) {
    vec4 place = texelFetch(light_rows, ivec2(0, i), 0);
    vec4 normal = texelFetch(light_rows, ivec2(1, i), 0);
    vec3 sent = texelFetch(light_rows, ivec2(2, i), 0).rgb;
    if (normal.w > 0.5) {
        toLight = place.xyz;
        away = 3.0e38;
        return sent * max(dot(worldNormal, toLight), 0.0);
    }
    vec3 way = place.xyz - worldPos;
    float squared = max(dot(way, way), 1e-20);
    away = sqrt(squared);
    toLight = way / away;
    float geometry = max(dot(worldNormal, toLight), 0.0) * max(-dot(normal.xyz, toLight), 0.0) / squared;
    return sent / PI * min(geometry, place.w);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float surfaceZ = texelFetch(viewZ, pixel, 0).r;
    irradiance = vec4(0.0);
    if (isBackground(surfaceZ)) return;

    vec3 surfacePos = viewPosAt(gl_FragCoord.xy, surfaceZ, ray_from_pixel);
    Receiver receiver = receiverAt(pixel, surfacePos, texelFetch(viewNormal, pixel, 0).xyz, texel_size);
    vec3 worldPos = (world_from_view * vec4(litPoint(surfacePos, receiver.normal, ray_from_pixel), 1.0)).xyz;
    vec3 worldNormal = mat3(world_from_view) * receiver.normal;
    vec3 sum = vec3(0.0);
    for (int i = first_light; i < first_light + batch; ++i) {
        if (i >= light_count) break;
        vec3 toLight;
        float away;
        vec3 light = arriving(i, worldPos, worldNormal, toLight, away);
        if (light == vec3(0.0)) continue;
        light *= tileShadow(i, worldPos);
        if (light == vec3(0.0)) continue;
        vec3 viewToLight = mat3(view_from_world) * toLight;
        sum += isFilledOpen(receiver, i, surfacePos, worldPos, viewToLight, away, ray_from_pixel) ? light : vec3(0.0);
    }
    irradiance = vec4(sum, 1.0);
}
