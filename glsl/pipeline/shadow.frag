// A light's view of an instance: depth only; holes of a cut-out texture let light through.

#include "lib/base_color.glsl"

in vec2 uv;
in float alpha;
flat in float winding;
flat in float instance;

void main() {
    if (isHole(baseColor(uv, vec4(alpha)).a, uv, winding, instance)) discard;
}
