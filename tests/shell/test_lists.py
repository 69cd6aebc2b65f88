"""`aolab modules` and `aolab scenes`."""

import json

from aolab.modules import MODULES, Module

# --- lists


def test_modules_as_json_is_their_schema(aolab):
    done = aolab("modules", "--json")
    schemas = json.loads(done.out)
    assert list(schemas) == list(MODULES)
    for name, schema in schemas.items():
        assert schema == MODULES[name].model_json_schema()
        assert schema["type"] == "object"
        assert schema["additionalProperties"] is False
        for parameter in schema["properties"].values():
            assert parameter["description"]
            assert "default" in parameter
    directions = schemas["ssao"]["properties"]["directions"]
    assert (directions["type"], directions["minimum"], directions["maximum"]) == ("integer", 1, 256)
    assert schemas["ssao"]["properties"]["radius"]["unit"] == "scene units"
    assert list(json.loads(aolab("modules", "ssao", "--json").out)) == ["ssao"]


def test_parameters_of_a_module_start_with_its_own(aolab):
    out = aolab("modules", "ssdo").out
    places = {name: out.index(f"\n  {name} = ") for name in MODULES["ssdo"].model_fields}
    own = {name: place for name, place in places.items() if name not in Module.model_fields}
    assert max(own.values()) < min(place for name, place in places.items() if name not in own)
    default = MODULES["ssdo"].model_fields["directions"].default
    assert f"  directions = {default}  (int, ≥ 1, ≤ 256)\n      Directions a pixel (N)" in out
    assert MODULES["ssdo"].paper in out


def test_modules_alone_is_a_line_for_each(aolab):
    lines = aolab("modules").out.splitlines()
    for (name, module), line in zip(MODULES.items(), lines[1:], strict=False):
        assert line.split(maxsplit=1) == [name, module.title]
    assert len(lines) == len(MODULES) + 3


def test_scenes(aolab):
    scenes = json.loads(aolab("scenes", "--json").out)
    assert {"cornell", "boxes", "skyscrapers", "colonnade", "atrium", "toasters"} <= set(scenes)
    assert all(scene["summary"] for scene in scenes.values())
    assert scenes["boxes"]["parameters"] == {"swap": False, "light": 1.0, "ambient": 1.0}
    out = aolab("scenes").out
    assert all(name in out for name in scenes)
