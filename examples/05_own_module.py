"""Write your own module: a class with parameters and a shader, used like a built-in module."""

from pathlib import Path

import aolab


class Creases(aolab.Module):
    """Darkens hollows: pixels whose neighbours' normals point towards them. It is the cheapest ambient occlusion."""

    name = "creases"
    shader = """
        #include "lib/space.glsl"

        uniform sampler2D viewZ;
        uniform sampler2D viewNormal;
        uniform float strength;
        uniform int reach;

        out float visibility;

        void main() {
            ivec2 pixel = ivec2(gl_FragCoord.xy);
            visibility = 1.0;
            if (isBackground(texelFetch(viewZ, pixel, 0).r)) return;
            ivec2 last = textureSize(viewZ, 0) - 1;
            vec3 left = texelFetch(viewNormal, clamp(pixel - ivec2(reach, 0), ivec2(0), last), 0).xyz;
            vec3 right = texelFetch(viewNormal, clamp(pixel + ivec2(reach, 0), ivec2(0), last), 0).xyz;
            vec3 below = texelFetch(viewNormal, clamp(pixel - ivec2(0, reach), ivec2(0), last), 0).xyz;
            vec3 above = texelFetch(viewNormal, clamp(pixel + ivec2(0, reach), ivec2(0), last), 0).xyz;
            float hollow = (left.x - right.x) + (below.y - above.y);
            visibility = clamp(1.0 - strength * hollow, 0.0, 1.0);
        }
    """

    strength: float = aolab.parameter(0.5, "Factor on the darkening of a hollow.", ge=0, le=4)
    reach: int = aolab.parameter(2, "Distance to the neighbouring pixels.", ge=1, le=16, unit="pixels")


Path("out").mkdir(exist_ok=True)
frame = aolab.render("colonnade", Creases(strength=0.8, filter="bilateral"), size=(640, 360))
frame.save("out/creases.png")
print(frame.timings)
