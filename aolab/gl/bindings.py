"""The values that shaders read, each name with its owner: a name that two owners give is an error."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import moderngl

from ..errors import ParameterError
from .source import Constant


# each frame makes many of these; frozen, each would take three times as long
@dataclass(slots=True)
class Bindings:
    """Values that one `owner` offers to shaders, by name. A shader takes those that it declares.

    `textures` are read by samplers, `uniforms` are set before drawing, `constants` are compiled in. `includes` maps the
    name of an include to a file under glsl/ or to GLSL text. An owner may offer one value as uniform and as constant.
    `words` are values that no shader can take, for messages.
    """

    owner: str
    textures: Mapping[str, moderngl.Texture] = field(default_factory=dict)
    uniforms: Mapping[str, object] = field(default_factory=dict)
    constants: Mapping[str, Constant] = field(default_factory=dict)
    includes: Mapping[str, str] = field(default_factory=dict)
    words: Mapping[str, object] = field(default_factory=dict)


@dataclass(slots=True)
class Joined:
    """The bindings of all owners together; fields as in `Bindings`."""

    textures: dict[str, moderngl.Texture]
    uniforms: dict[str, object]
    constants: dict[str, Constant]
    includes: dict[str, str]
    words: dict[str, object]


def joined(bindings: Iterable[Bindings], place: str) -> Joined:
    """The bindings of all owners as one. Raises `ParameterError` where two owners give one name; `place` is named."""
    bindings = list(bindings)
    result = Joined({}, {}, {}, {}, {})
    given = 0  # names; of one that is given twice, a single entry is left
    for one in bindings:
        result.uniforms.update(one.uniforms)
        result.constants.update(one.constants)
        result.textures.update(one.textures)
        result.includes.update(one.includes)
        result.words.update(one.words)
        given += len(one.textures) + len(one.includes)
        given += len(one.uniforms.keys() | one.constants.keys() if one.constants else one.uniforms)
    values = result.uniforms.keys() | result.constants.keys()
    if given > len(values) + len(result.textures) + len(result.includes):
        raise ParameterError(f"{place}: {_given_twice(bindings)}; rename one of the two")
    return result


def _given_twice(bindings: list[Bindings]) -> str:
    """The first name that two owners give, and both owners."""
    for kind, names_of in {
        "value": lambda one: {**one.uniforms, **one.constants},
        "texture": lambda one: one.textures,
        "include": lambda one: one.includes,
    }.items():
        owners: dict[str, str] = {}
        for one in bindings:
            for name in names_of(one):
                if name in owners:
                    return f"the {kind} '{name}' is given twice, by {owners[name]} and by {one.owner}"
                owners[name] = one.owner
    raise AssertionError("no name is given twice")
