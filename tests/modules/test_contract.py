"""Properties of every module; a new module needs no edit here."""

import typing
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import small_scenes
from module_settings import alternatives, contexts, kinds

from aolab import (
    DirectionalLight,
    Environment,
    Frame,
    HeightMap,
    Material,
    Module,
    ParameterError,
    Pass,
    PointLight,
    Scene,
    SpotLight,
    paths,
)
from aolab.gl.texture import FORMATS
from aolab.modules import MODULES, known_buffers
from aolab.modules.filters import FILTERS
from aolab.modules.occluders import OCCLUDERS
from aolab.modules.parameters import describe

CHECKOUT = Path(__file__).parents[2]
pytestmark = [
    pytest.mark.filterwarnings("ignore:.* meshes are not closed:aolab.errors.Notice"),  # nor is a floor
    pytest.mark.filterwarnings("ignore:.* no reflective shadow map:aolab.errors.Notice"),
    pytest.mark.filterwarnings("ignore:.* has no height map:aolab.errors.Notice"),
]
PARAMETERS = [(name, field) for name, module in MODULES.items() for field in module.model_fields]
CHOICES = [choice for table in (OCCLUDERS, FILTERS) for choice in table.values()]
OF_CHOICES = [(choice, field) for choice in CHOICES for field in choice.model_fields]
# `none` gives 1 everywhere: its shader includes no occluders, and there is nothing to filter
WITHOUT_EFFECT = {("none", field) for field in ("occluders", "filter", "normals")} | {
    ("hao", "outside"),  # the probe has no baked visibility: see tests/baking
    ("rsm", "occluders"),
    ("rsm", "shaded"),
    # virtual lights alone: no estimate of its own, and no occluders without `fill`
    ("environment_vpl", "normals"),
    ("environment_vpl", "filter"),
}


def differ(one: Frame, other: Frame) -> bool:
    """By more than drivers round: a shader that another setting compiled anew rounds otherwise on some."""
    return one.buffers != other.buffers or any(
        one[name].shape != other[name].shape or not close(one[name], other[name]) for name in one.buffers
    )


def close(one: np.ndarray, other: np.ndarray) -> bool:
    """Two steps of a half float, or one level of an image."""
    levels = one.dtype == np.uint8
    return np.allclose(
        one.astype(float), other, rtol=0 if levels else 2**-9, atol=1 if levels else 1e-6, equal_nan=True
    )


@pytest.mark.parametrize("name", MODULES)
def test_it_renders_and_its_visibility_is_a_share(lab, boxes, name):
    frame = lab.render(boxes, name)
    assert set(MODULES[name].outputs) <= set(frame.buffers)
    visibility = frame["visibility"]
    assert visibility.shape == (48, 64)
    assert visibility.dtype == np.float32
    np.testing.assert_array_equal(np.isnan(visibility), ~frame.mask)
    assert np.nanmin(visibility) >= 0
    assert np.nanmax(visibility) <= 1
    assert frame["ambient"].min() >= 0
    assert frame.image.std() > 5


@pytest.mark.parametrize("name", MODULES)
def test_an_unoccluded_plane_is_exactly_open(lab, plane, name):
    for occluders in typing.get_args(MODULES[name].model_fields["occluders"].annotation):
        for filter in ("none", "box4", "bilateral"):
            frame = lab.render(plane, name, occluders=occluders, filter=filter)
            wrong = (frame["visibility"][frame.mask] < small_scenes.OPEN).mean()
            # off the screen, a further view that sees the plane edge-on decides, and its pixels are wide there
            assert wrong <= (0.05 if occluders == "views" else 0), (occluders, filter)


@pytest.mark.parametrize("name", MODULES)
def test_it_renders_at_the_ends_of_its_ranges(lab, boxes, name):
    module = MODULES[name]
    for field in module.model_fields:
        for value in alternatives(module, field):
            if value in (256, 64):  # directions and steps: many taps
                frame = lab.render(boxes, name, size=(8, 6), **{field: value})
            else:
                frame = lab.render(boxes, name, size=(32, 24), **{field: value})
            assert np.isfinite(frame["visibility"][frame.mask]).all(), (field, value)
            assert 0 <= np.nanmin(frame["visibility"]) <= np.nanmax(frame["visibility"]) <= 1, (field, value)


@pytest.fixture(scope="module")
def probe(wall) -> Scene:
    """Near and far things, thin ones, hidden ones, a relief, lights, and a sky that is not the same everywhere."""
    bumps = HeightMap(0.1 * np.random.default_rng(1).random((64, 64)))
    floor = replace(wall.instances[0].mesh, material=Material(height=bumps))
    return small_scenes.of(
        floor,
        *(instance.mesh for instance in wall.instances[1:]),
        small_scenes.box((1.0, 0.0, -0.4), (1.3, 0.8, 0.1)),
        small_scenes.box((0.4, 0.0, -0.3), (0.6, 0.5, 0.2)),
        small_scenes.box((1.6, 1.0, 0.2), (1.9, 1.1, 0.9)),
        camera=wall.camera,
        lights=(
            DirectionalLight((-1.0, -2.0, 0.5)),
            PointLight((2.0, 2.0, 1.0)),
            SpotLight(
                (2.5, 2.0, 0.5), (-1.0, -0.6, -0.2), (5e5, 5e5, 5e5)
            ),  # sends as much as the sun on 200 × 200 units
        ),
        sky=Environment.sky(sun_direction=(1.0, 1.0, 0.0)),
    )


@pytest.mark.parametrize(("name", "field"), PARAMETERS)
def test_every_parameter_has_an_effect(lab, probe, name, field):
    module = MODULES[name]
    radius = {"radius": 1.0} if "radius" in module.model_fields and field != "radius" else {}

    def has_effect(context: dict[str, Any]) -> bool:
        default = lab.render(probe, module, **radius, **context)
        return any(
            differ(lab.render(probe, module, **radius, **context, **{field: value}), default)
            for value in alternatives(module, field)
        )

    assert any(has_effect(context) for context in contexts(module, field)) is ((name, field) not in WITHOUT_EFFECT)


@pytest.mark.parametrize(("choice", "field"), OF_CHOICES, ids=str)
def test_every_parameter_of_a_choice_has_an_effect(lab, probe, choice, field):
    # the probe is 280 units wide, and voxels are as fine as the grid
    chosen = {choice.axis: choice.name, "radius": 30.0 if choice.name == "voxels" else 1.0}
    if field == "voxel_axes":
        chosen["voxel_exact"] = False  # an exact grid is the same along every axis
    default = lab.render(probe, "ssao", **chosen)
    others = [((0.0, 0.0, -2.0), (2.0, 2.0, 2.0))] if field == "voxel_region" else alternatives(choice, field)
    assert any(differ(lab.render(probe, "ssao", **chosen, **{field: value}), default) for value in others)


@pytest.mark.parametrize(("choice", "field"), OF_CHOICES, ids=str)
def test_a_parameter_of_a_choice_goes_with_that_choice_only(choice, field):
    value = alternatives(choice, field)[0]
    for name, module in MODULES.items():
        chosen = module(**{choice.axis: choice.name, field: value})
        assert getattr(chosen, field) == value
        assert chosen.model_dump()[field] == value
        assert chosen.replace(scale=0.5).model_dump() == {**chosen.model_dump(), "scale": 0.5}
        if module.model_fields[choice.axis].default == choice.name:
            assert getattr(module(**{field: value}), field) == value
            continue
        with pytest.raises(
            ParameterError, match=rf"{name}: {field} = .* is a parameter of {choice.axis}='{choice.name}'"
        ):
            module(**{field: value})
        assert field not in chosen.replace(**{choice.axis: module().model_dump()[choice.axis]}).model_dump()


@pytest.mark.parametrize("choice", CHOICES, ids=str)
def test_a_choice_is_described(choice):
    assert choice.name.isidentifier()
    assert choice.__doc__ != type(choice).__mro__[1].__doc__
    assert choice in {**OCCLUDERS, **FILTERS}.values()
    for field in choice.model_fields:
        about = describe(MODULES["ssao"], field)
        assert about["with"] == f"{choice.axis}='{choice.name}'"
        assert about["description"].endswith(".")
        assert about["range"] or " or " in about["type"] or about["type"] == "bool"
        assert MODULES["ssao"].model_json_schema()["properties"][field]["with"] == {choice.axis: choice.name}


def test_a_box_is_described_as_its_corners():
    corner = "(float, float, float)"
    assert describe(MODULES["ssao"], "voxel_region")["type"] == f"str or ({corner}, {corner})"


@pytest.mark.parametrize(("name", "field"), PARAMETERS)
def test_every_parameter_is_stated_whole(name, field):
    module = MODULES[name]
    about = describe(module, field)
    assert about["description"].endswith("."), "a sentence"
    assert about["type"]
    assert about["default"]
    schema = module.model_json_schema()["properties"][field]
    assert schema["description"] == about["description"]
    if {int, float} & set(kinds(module.model_fields[field].annotation)):
        assert about["range"], "a number has a range"
    getattr(module(), field)  # the default is validated: within its range


@pytest.mark.parametrize("name", MODULES)
def test_it_has_a_name_a_title_a_citation_and_a_docstring(name):
    module = MODULES[name]
    assert module.name == name
    assert module.name.isidentifier()
    assert module.name.islower()
    assert module.title
    assert any(character.isdigit() for character in module.paper), "a citation has a year"
    assert module.__doc__
    assert len(module.__doc__) > 60
    assert module.__doc__ != Module.__doc__
    assert set(module.outputs.values()) <= set(FORMATS)


def all_passes(module: type[Module]) -> list[Pass]:
    """Every pass that some setting of the module runs."""
    return [step for context in contexts(module, "") for step in module(**context).all_passes()]


@pytest.mark.parametrize("name", MODULES)
def test_its_shaders_state_their_purpose_and_outputs(name):
    for step in all_passes(MODULES[name]):
        text = (paths.glsl() / step.shader).read_text()
        head = text[: text.index("\n\n")]
        assert head.startswith("// ")
        assert "Output" in text[: text.index("void main")]
        assert all(line.startswith("//") for line in head.splitlines())


@pytest.mark.parametrize("name", MODULES)
def test_it_has_its_page(name):
    page = CHECKOUT / "docs" / "modules" / f"{name}.md"
    assert page.is_file()
    assert len(page.read_text()) > 300


@pytest.mark.parametrize("name", MODULES)
def test_unknown_parameters_are_refused(name):
    with pytest.raises(ParameterError, match=rf"{name} has no parameter 'filtre'; did you mean 'filter'\?"):
        MODULES[name](filtre="none")  # pyright: ignore[reportCallIssue]


@pytest.mark.parametrize("name", MODULES)
def test_a_module_cannot_be_changed_in_place(name):
    module = MODULES[name]()
    with pytest.raises((TypeError, ValueError), match="cannot be changed"):
        module.filter = "none"  # pyright: ignore[reportAttributeAccessIssue]
    default = module.filter
    changed = module.replace(filter="bilateral")
    assert changed.filter == "bilateral"
    assert module.filter == default != "bilateral"


@pytest.mark.parametrize("name", MODULES)
def test_every_buffer_is_in_the_table(lab, boxes, name):
    """All buffers of all settings: their channels and formats are those of the table."""
    table = known_buffers()
    for context in contexts(MODULES[name], ""):
        frame = lab.render(boxes, name, size=(8, 6), **context)
        for buffer in frame.buffers:
            about = table[buffer.removesuffix("_raw")]
            assert about.about.endswith(".")
            values = frame[buffer]
            assert (values.shape[2] if values.ndim == 3 else 1) == about.channels, buffer
            if about.format and buffer in frame.textures:
                assert frame.channels(buffer).ndim == (2 if FORMATS[about.format][0] == 1 else 3), buffer


def test_a_row_of_the_table_has_room_for_its_channels():
    for row in known_buffers().values():
        assert not row.format or FORMATS[row.format][0] >= row.channels, row.name
