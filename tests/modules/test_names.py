"""Names of a module of one's own: a name that belongs to another part is refused, and the error names that part."""

import numpy as np
import pytest

from aolab import DirectionalLight, Module, ParameterError, Pass, ShaderError, parameter
from aolab.modules.base import Directions
from aolab.modules.estimate import Estimate
from aolab.modules.marched import Marched

HALF = "out float visibility;\nvoid main() { visibility = 0.5; }\n"
NUMBER = parameter(0.5, "A number.", ge=0, le=1)


def module_with(parameter_name: str, shader: str = HALF, base: type[Module] = Module) -> type[Module]:
    """A module of one's own with a number of this name."""
    return type("Own", (base,), {"__annotations__": {parameter_name: float}, parameter_name: NUMBER, "shader": shader})


@pytest.mark.parametrize(
    ("name", "owner"),
    [
        ("texel_size", "the view"),
        ("ray_from_pixel", "the view"),
        ("light_color", "the lights"),
        ("lights", "the lights"),
        ("irradiance_sh", "the environment"),
        ("kernel", "the samples"),
        ("base_color", "the mesh"),
        ("layers", r"occluders='layers'"),
        ("view_scale", r"occluders='views'"),
        ("camera_from_view", r"occluders='views'"),
        ("samples", "the class Module"),
        ("passes", "the class Module"),
    ],
)
@pytest.mark.filterwarnings("ignore:Field name .* shadows an attribute:UserWarning")  # pydantic's own word on it
def test_a_parameter_with_a_name_of_another_part_is_refused_when_the_class_is_made(name, owner):
    message = rf"Own: the parameter '{name}' has a name that belongs to {owner}; rename the parameter"
    with pytest.raises(ParameterError, match=message):
        module_with(name)


def test_a_word_may_have_any_name_for_no_shader_reads_it(lab, boxes):
    """`lights` of S3HO is a choice of words, and also the number of lights in its shaders."""
    assert lab.render(boxes, "s3ho", lights="sharp")["direct"].shape == (48, 64, 3)


def test_a_parameter_of_a_built_in_module_is_free_in_another(lab, boxes):
    """A parameter called `light_steps` once shortened the lights' way on the screen: it is SSDO's alone."""
    scene = boxes.replace(lights=(DirectionalLight((1, -2, -1)),))
    own = module_with(
        "light_steps", "uniform float light_steps;\nout float visibility;\nvoid main() { visibility = light_steps; }"
    )
    expected = lab.render(scene, "none")["direct"]
    for value in (0.0, 1.0):
        frame = lab.render(scene, own, light_steps=value, filter="none")
        np.testing.assert_array_equal(frame["direct"], expected)
        assert (frame["visibility"][frame.mask] == value).all()


@pytest.mark.parametrize(
    ("name", "owner"), [("viewZ", "the surfaces"), ("albedo", "the surfaces"), ("ambient", "the lighting")]
)
def test_an_output_that_the_pipeline_fills_is_refused_when_the_class_is_made(name, owner):
    message = rf"Own: the output '{name}' has a name that belongs to {owner}; rename the output"
    with pytest.raises(ParameterError, match=message):
        type("Own", (Module,), {"outputs": {"visibility": "R16F", name: "RGBA16F"}})


def test_an_irradiance_that_cannot_be_one_is_refused_with_what_the_name_means():
    message = (
        r"Own: the output 'irradiance' has the format R16F; the lighting reads 3 channels.*reflects it as `ambient`"
    )
    with pytest.raises(ParameterError, match=message):
        type("Own", (Module,), {"outputs": {"visibility": "R16F", "irradiance": "R16F"}})


def test_an_output_may_not_look_like_an_unfiltered_one():
    with pytest.raises(ParameterError, match=r"Own: the output 'slope_raw' ends in '_raw'"):
        type("Own", (Module,), {"outputs": {"visibility": "R16F", "slope_raw": "R16F"}})


# --- names that come together only when a frame is drawn


def test_a_sample_array_named_like_a_parameter_is_refused(lab, plane):
    class Twice(Module):
        amount: float = NUMBER
        shader = HALF

        def samples(self, seed: int) -> dict[str, bytes]:
            return {"amount": bytes(4)}

    message = r"pass 'Twice': the value 'amount' is given twice, by the parameters of Twice and by the samples"
    with pytest.raises(ParameterError, match=message):
        lab.render(plane, Twice)


def test_a_constant_of_a_pass_named_like_a_parameter_is_refused(lab, plane):
    class Twice(Marched):
        def passes(self) -> list[Pass]:
            return [Pass("mine", HALF, self.outputs, {"steps": 3})]

    message = r"pass 'mine': the value 'steps' is given twice, by the parameters of Twice and by the pass 'mine'"
    with pytest.raises(ParameterError, match=message):
        lab.render(plane, Twice)


def test_two_passes_that_fill_one_buffer_are_refused(lab, plane):
    class Twice(Module):
        def estimate(self) -> Estimate:
            return Estimate([Pass(name, HALF, self.outputs) for name in ("first", "second")], self.outputs)

    with pytest.raises(ParameterError, match=r"passes 'first' and 'second' both fill 'visibility'; rename one of them"):
        lab.render(plane, Twice)


def test_a_table_named_like_a_texture_of_the_lights_is_refused(lab, plane):
    from aolab.scene.prefiltered import Blurred

    class Twice(Module):
        shader = HALF

        def tables(self):
            return {"shadow_atlas": Blurred(1.0)}

    message = r"pass 'direct': the texture 'shadow_atlas' is given twice, by the lights and by the environment"
    with pytest.raises(ParameterError, match=message):
        lab.render(plane, Twice).complete()


# --- `out` variables go by their names

TWO = {"visibility": "R16F", "slope": "RGBA16F"}


@pytest.mark.parametrize("order", [("slope", "visibility"), ("visibility", "slope")])
@pytest.mark.parametrize("layout", [(None, None), (0, 1), (1, 0)], ids=["bare", "in order", "swapped"])
def test_outputs_are_matched_by_name_in_any_order(lab, boxes, order, layout):
    """The order of the declarations, of their locations and of `outputs` means nothing."""
    kinds = {"visibility": "float", "slope": "vec4"}
    declared = "".join(
        (f"layout(location = {place}) " if place is not None else "") + f"out {kinds[name]} {name};\n"
        for name, place in zip(order, layout, strict=True)
    )
    shader = declared + "void main() { visibility = 0.75; slope = vec4(0.1, 0.2, 0.3, 0.4); }\n"
    own = type("Own", (Module,), {"outputs": TWO, "shader": shader})
    frame = lab.render(boxes, own, filter="none")
    assert (frame["visibility"][frame.mask] == 0.75).all()
    np.testing.assert_allclose(frame["slope"][0, 0], (0.1, 0.2, 0.3, 0.4), atol=1e-3)


@pytest.mark.parametrize(
    ("shader", "message"),
    [
        ("out float visibilty;\nvoid main() { visibilty = 1.0; }\n",
         r"the 'out' variable 'visibility' is missing; did you mean 'visibilty'\?"),
        ("out float visibility;\nout vec4 slope;\nvoid main() { visibility = 1.0; slope = vec4(1.0); }\n",
         r"the 'out' variable 'slope' is none of the pass's outputs; known: visibility"),
        ("layout(location = 1) out float visibility;\nvoid main() { visibility = 1.0; }\n",
         r"locations of 'out' variables must be 0 to 0: 'visibility' at 1"),
    ],
    ids=["missing", "unknown", "a gap"],
)  # fmt: skip
def test_an_output_that_no_variable_fills_is_an_error(lab, plane, shader, message):
    with pytest.raises(ShaderError, match=message):
        lab.render(plane, type("Own", (Module,), {"shader": shader}))


def test_an_output_that_is_never_written_is_an_error(lab, plane):
    shader = "out float visibility;\nout vec4 slope;\nvoid main() { visibility = 1.0; }\n"
    with pytest.raises(ShaderError, match=r"the 'out' variable 'slope' (is never written|is missing)"):
        lab.render(plane, type("Own", (Module,), {"outputs": TWO, "shader": shader}))


# --- samplers


def reads(count: int) -> type[Module]:
    """A module that reads `count` textures: the first buffers of a pass of its own."""
    names = [f"many{number}" for number in range(count)]
    declared = "".join(f"uniform sampler2D {name};\n" for name in names)
    total = " + ".join(f"texelFetch({name}, ivec2(0), 0).r" for name in names)
    shader = f"{declared}out float visibility;\nvoid main() {{ visibility = {total}; }}\n"

    class Many(Module):
        def passes(self) -> list[Pass]:
            return [Pass("many", shader, self.outputs, reads=dict.fromkeys(names, "albedo"))]

    return Many


@pytest.mark.filterwarnings("ignore:.*reaches from")  # it is a probe
def test_as_many_textures_as_opengl_guarantees_are_read_and_not_one_more(lab, boxes):
    """llvmpipe grants 32, and so would hide what fails on macOS."""
    assert lab.render(boxes, reads(16), size=(8, 6)).mask.any()
    with pytest.raises(ShaderError, match=r"reads 17 textures; OpenGL 3.3 guarantees 16: many0, many1"):
        lab.render(boxes, reads(17), size=(8, 6))


@pytest.mark.filterwarnings("ignore:.* meshes are not closed:aolab.errors.Notice")
@pytest.mark.filterwarnings("ignore:.*reaches from")  # it is a probe
def test_every_kind_of_occluders_leaves_textures_to_its_module(lab, boxes):
    """At least 5 of the 16 textures are left to a pass that reads occluders with their normals and light."""
    more = [f"more{number}" for number in range(5)]
    for kind in ("depth", "layers", "views"):

        class Asking(Marched):
            directions: Directions = 1

            def sends(self) -> bool:
                return True

            def passes(self) -> list[Pass]:
                declared = "".join(f"uniform sampler2D {name};\n" for name in more)
                shader = f"""
#include "lib/march.glsl"
{declared}
out float visibility;
void main() {{
    Receiver receiver;
    Occluder first;
    visibility = 1.0;
    if (!receiverHere(receiver)) return;
    if (firstBlocked(receiver, 0, first) < OPEN) visibility = occluderNormal(first).x + occluderRadiance(first).x;
    visibility += {" + ".join(f"texelFetch({name}, ivec2(0), 0).r" for name in more)};
}}
"""
                named = dict.fromkeys(["sender", *more], "albedo")
                return [Pass("asking", shader, self.outputs, reads=named)]

        frame = lab.render(boxes, Asking, occluders=kind, radius=1.0, size=(8, 6))
        assert frame.mask.any()
