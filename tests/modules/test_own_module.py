"""A module of one's own, as written in a notebook cell, is used like a built-in one."""

from typing import Literal

import numpy as np
import pytest
import small_scenes

import aolab
from aolab import Module, ParameterError, Pass, parameter
from aolab.modules.base import Directions, Radius
from aolab.modules.estimate import Estimate


class HeightFog(Module):
    """Openness that grows with height: a uniform, a constant, a choice and an include."""

    title = "Height fog"
    height: float = parameter(2.0, "Height at which all is clear.", gt=0, unit="scene units")
    bands: int = parameter(0, "Steps of brightness; 0 is smooth.", ge=0, le=8)
    inverted: bool = parameter(False, "Fog above instead of below.")
    shader = """
#include "lib/space.glsl"
const int bands;
const bool inverted;
uniform float height;
uniform sampler2D viewZ;
uniform mat4 world_from_view;
uniform vec3 world_origin;
uniform vec4 ray_from_pixel;
out float visibility;

void main() {
    float surfaceZ = texelFetch(viewZ, ivec2(gl_FragCoord.xy), 0).r;
    visibility = 1.0;
    if (isBackground(surfaceZ)) return;
    vec3 worldPos = (world_from_view * vec4(viewPosAt(gl_FragCoord.xy, surfaceZ, ray_from_pixel), 1.0)).xyz;
    visibility = clamp((worldPos.y + world_origin.y) / height, 0.0, 1.0);
    if (bands > 0) visibility = floor(visibility * float(bands)) / float(bands);
    if (inverted) visibility = 1.0 - visibility;
}
"""


def test_it_computes_the_clamped_height(lab, boxes):
    frame = lab.render(boxes, HeightFog(height=2.0, filter="none"))
    y = small_scenes.world_positions(frame, boxes.camera)[..., 1][frame.mask]
    np.testing.assert_allclose(frame["visibility"][frame.mask], np.clip(y / 2, 0, 1), atol=2e-3)


def test_its_parameters_are_uniforms_and_constants(lab, boxes):
    plain = lab.render(boxes, HeightFog(filter="none"))["visibility"]
    higher = lab.render(boxes, HeightFog(filter="none", height=4.0))["visibility"]
    np.testing.assert_allclose(higher, np.where(plain < 1, plain / 2, higher), atol=2e-3)
    banded = lab.render(boxes, HeightFog, filter="none", bands=2)["visibility"]
    assert set(np.unique(banded[np.isfinite(banded)])) <= {0.0, 0.5, 1.0}
    inverted = lab.render(boxes, HeightFog, filter="none", inverted=True)["visibility"]
    np.testing.assert_allclose(inverted, 1 - plain, atol=2e-3)


@pytest.mark.parametrize("settings", [{"filter": "bilateral"}, {"scale": 0.5}, {"accumulate": 3}])
def test_filter_scale_and_accumulation_are_there(lab, boxes, settings):
    plain = lab.render(boxes, HeightFog(filter="none"))
    frame = lab.render(boxes, HeightFog, **settings)
    error = (frame["visibility"] - plain["visibility"])[plain.mask]
    assert np.sqrt((error**2).mean()) < 0.06


def test_its_parameters_are_checked_and_described(lab, boxes):
    with pytest.raises(ParameterError, match=r"HeightFog: height = -1 is not valid: float, > 0, in scene units"):
        HeightFog(height=-1)
    with pytest.raises(ParameterError, match=r"HeightFog has no parameter 'heigth'; did you mean 'height'\?"):
        lab.render(boxes, HeightFog, heigth=1)
    assert HeightFog.model_json_schema()["properties"]["bands"]["description"] == "Steps of brightness; 0 is smooth."
    assert lab.render(boxes, HeightFog).info["module"] == "HeightFog"
    assert "HeightFog" in lab.render(boxes, HeightFog).timings


def test_it_may_share_the_parts_of_the_built_in_ones(lab, wall):
    """Sampling and occluders by include: this is SSAO with one step, written anew."""

    class MySSAO(Module):
        radius: Radius = "auto"
        directions: Directions = 16
        shader = """
#include "occluders.glsl"
const int directions;
uniform float radius;
uniform vec4 kernel[directions];
uniform vec4 ray_from_pixel;
out float visibility;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float centreZ = texelFetch(viewZ, pixel, 0).r;
    visibility = 1.0;
    if (isBackground(centreZ)) return;
    vec3 normal = texelFetch(viewNormal, pixel, 0).xyz, viewPos = viewPosAt(gl_FragCoord.xy, centreZ, ray_from_pixel);
    viewPos += normal * liftOff(0.01 * radius, radius, viewPos, ray_from_pixel);
    Receiver receiver = receiverAt(pixel, viewPos, normal, texel_size);
    float blocked = 0.0;
    for (int i = 0; i < directions; ++i) {
        Occluder occluder;
        vec3 way = receiver.frame * kernel[i].xyz * interleavedOffset(kernel[i].w, receiver.set);
        blocked += float(isBlocked(receiver, viewPos + radius * way, 0.8 * radius, occluder));
    }
    visibility = 1.0 - blocked / float(directions);
}
"""

        def samples(self, seed: int) -> dict[str, bytes]:
            return aolab.SSAO(directions=self.directions).samples(seed)

    mine = lab.render(wall, MySSAO(radius=1.0))
    built_in = lab.render(wall, aolab.SSAO(radius=1.0, directions=16, steps=1, thickness=0.8))
    np.testing.assert_allclose(mine["visibility"], built_in["visibility"], atol=1e-3)
    assert np.nanmin(mine["visibility"]) < 0.9


def test_several_passes_and_buffers_of_its_own(lab, boxes):
    """The second pass reads what the first one gave; only what is named in `outputs` is filtered and kept."""

    class Two(Module):
        outputs = {"visibility": "R16F", "slope": "RGBA16F"}  # noqa: RUF012
        kind: Literal["half", "whole"] = parameter("half", "How much.")

        def passes(self) -> list[Pass]:
            first = """
uniform sampler2D viewNormal;
out vec4 scratch;
void main() { scratch = texelFetch(viewNormal, ivec2(gl_FragCoord.xy), 0) * 0.5; }
"""
            second = """
const float share;
uniform sampler2D scratch;
layout(location = 0) out float visibility;
layout(location = 1) out vec4 slope;
void main() {
    slope = texelFetch(scratch, ivec2(gl_FragCoord.xy), 0);
    visibility = share;
}
"""
            share = {"share": 0.5 if self.kind == "half" else 1.0}
            return [Pass("first", first, {"scratch": "RGBA16F"}), Pass("second", second, self.outputs, share)]

    frame = lab.render(boxes, Two(filter="none"))
    np.testing.assert_allclose(frame["slope"][frame.mask][:, :3], 0.5 * frame["viewNormal"][frame.mask], atol=1e-3)
    assert (frame["visibility"][frame.mask] == 0.5).all()
    assert (lab.render(boxes, Two(kind="whole"))["visibility"][frame.mask] == 1).all()
    assert "scratch" not in frame.buffers
    assert {"first", "second"} <= set(frame.timings)


def test_a_module_may_give_the_ambient_irradiance_and_a_bounce(lab, boxes):
    """Both are reflected by the lighting: albedo / π × irradiance."""

    class Glow(Module):
        outputs = {"visibility": "R16F", "irradiance": "RGBA16F"}  # noqa: RUF012
        shader = """
layout(location = 0) out float visibility;
layout(location = 1) out vec4 irradiance;
void main() { visibility = 0.5; irradiance = vec4(0.25, 0.0, 0.0, 1.0); }
"""

        def bounce(self) -> Estimate:
            text = """
uniform sampler2D sender;
out vec4 bounce;
void main() { bounce = 3.0 * texelFetch(sender, ivec2(gl_FragCoord.xy), 0); }
"""
            given = {"bounce": "RGBA16F"}
            return Estimate([Pass("glow bounce", text, given)], given)

    frame = lab.render(boxes, Glow(filter="none"))
    ambient = frame["albedo"] / np.pi * (0.25, 0.0, 0.0)
    np.testing.assert_allclose(frame["ambient"], ambient, atol=1e-3)
    np.testing.assert_allclose(frame["indirect"], frame["albedo"] / np.pi * 3 * ambient, atol=1e-3)
    total = frame["direct"] + frame["ambient"] + frame["indirect"]
    np.testing.assert_allclose(frame["radiance"][frame.mask], total[frame.mask], atol=1e-3)


def test_a_shader_file_of_ones_own_is_found_in_the_glsl_folder(shaders, boxes):
    (shaders / "mine.frag").write_text("// mine\nout float visibility;\nvoid main() { visibility = 0.5; }\n")

    class Mine(Module):
        shader = "mine.frag"

    assert np.nanmax(aolab.Lab((8, 8)).render(boxes, Mine())["visibility"]) == 0.5


def test_a_wrong_declaration_is_a_parameter_error():
    with pytest.raises(
        ParameterError, match=r"class Untyped: parameter 'level' has no type; write level: float = \.\.\."
    ):

        class Untyped(aolab.Module):
            level = aolab.parameter(0.5, "The visibility.")

    with pytest.raises(ParameterError, match="class Strange: Unable to generate"):

        class Strange(aolab.Module):
            level: np.ndarray = aolab.parameter(0.5, "An array.")

    with pytest.raises(ParameterError, match=r"Listed: outputs = \['visibility'\] maps no buffers to formats"):

        class Listed(aolab.Module):
            outputs = ["visibility"]  # noqa: RUF012  # pyright: ignore[reportAssignmentType]

    class Undefined(aolab.Module):
        level: "Unknown" = 0.5  # noqa: F821  # pyright: ignore[reportUndefinedVariable]

    with pytest.raises(ParameterError, match=r"class Undefined: .*you should define `Unknown`"):
        Undefined()


@pytest.mark.parametrize(
    ("declared", "message"),
    [
        (aolab.parameter(5.0, "Too large.", le=1), r"Levelled: level = 5\.0 is not valid: float, ≤ 1"),
        (aolab.parameter("a", "A word."), "Levelled: level = 'a' is not valid: float"),
        (aolab.parameter(..., "None at all."), "Levelled: level has no value: float"),
    ],
)
def test_a_wrong_default_is_named(declared, message):
    class Levelled(aolab.Module):
        level: float = declared

    with pytest.raises(ParameterError, match=message):
        Levelled()


@pytest.mark.parametrize("size", [np.array([16, 9]), [np.int64(16), 9]])
def test_a_size_may_be_an_array(size):
    assert aolab.render("boxes", size=size).size == (16, 9)
    assert aolab.reference("boxes", size=size, rays=2, buffers="visibility").size == (16, 9)


@pytest.mark.parametrize("size", [np.array([16.5, 9]), np.zeros((2, 2)), (), 0, "16x9", (16, 9, 3)])
def test_a_wrong_size_is_a_parameter_error(size):
    with pytest.raises(ParameterError, match="is not two whole numbers"):
        aolab.render("boxes", size=size)


@pytest.mark.parametrize(
    ("value", "doubt"),
    [
        ("sqrt(-1.0 - gl_FragCoord.x)", r"'visibility' is NaN or infinite in 100 % of .*division by 0"),
        ("gl_FragCoord.x > 8.0 ? 1.0 / (gl_FragCoord.y * 0.0) : 0.5", r"NaN or infinite in \d+ %"),
        ("2.5", r"'visibility' reaches from 2.5 to 2.5; it is a share, in \[0, 1\]"),
        ("-0.5", r"reaches from -0.5 to -0.5"),
    ],
)
def test_impossible_outputs_are_doubted(value, doubt):
    class Doubtful(aolab.Module):
        title = "Doubtful"
        shader = f"out float visibility;\nvoid main() {{ visibility = {value}; }}\n"

    with pytest.warns(aolab.Notice, match=f"Doubtful: .*{doubt}" if "visibility" in doubt else doubt):
        aolab.render("boxes", Doubtful, size=(32, 18), filter="none")


class Tinted(Module):
    """Tuples of numbers, one for each number of a colour."""

    tint: tuple[float, float, float] = parameter((0.1, 0.3, 0.5), "Weights of red, green and blue.")
    offset: tuple[float, float] = parameter((0.0, 0.0), "Two numbers.")
    shader = """
uniform vec3 tint;
uniform vec2 offset;
uniform sampler2D albedo;
out float visibility;
void main() { visibility = dot(tint, texelFetch(albedo, ivec2(gl_FragCoord.xy), 0).rgb) + offset.y; }
"""


def test_a_tuple_of_numbers_is_a_vector_in_the_shader(lab, boxes):
    frame = lab.render(boxes, Tinted(offset=(5.0, 0.0)), size=(32, 24), filter="none")
    expected = frame["albedo"] @ np.array((0.1, 0.3, 0.5))
    np.testing.assert_allclose(frame["visibility"][frame.mask], expected[frame.mask], atol=2e-3)
    with pytest.raises(ParameterError, match="tint"):
        Tinted(tint=(1.0, 2.0))  # type: ignore[arg-type]
    assert Tinted(**Tinted.read({"tint": "1,2,3", "offset": "[4, 5]"})) == Tinted(tint=(1, 2, 3), offset=(4, 5))
