"""The values that shaders read, each name with its owner: a name that two owners give is an error."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import moderngl

from ..errors import ParameterError
from .source import Constant


@dataclass(frozen=True)
class Bindings:
    """Values that one `owner` offers to shaders, by name. A shader takes those that it declares.

    `textures` are read by samplers, `uniforms` are set before drawing, `constants` are compiled in. `includes` maps the
    name of an include to a file under glsl/ or to GLSL text. An owner may offer one value as uniform and as constant.
    """

    owner: str
    textures: Mapping[str, moderngl.Texture] = field(default_factory=dict)
    uniforms: Mapping[str, object] = field(default_factory=dict)
    constants: Mapping[str, Constant] = field(default_factory=dict)
    includes: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Joined:
    """The bindings of all owners together; fields as in `Bindings`."""

    textures: dict[str, moderngl.Texture]
    uniforms: dict[str, object]
    constants: dict[str, Constant]
    includes: dict[str, str]


def joined(bindings: Iterable[Bindings], place: str) -> Joined:
    """The bindings of all owners as one. Raises `ParameterError` where two owners give one name; `place` is named."""
    owners: dict[tuple[str, str], str] = {}
    result = Joined({}, {}, {}, {})
    for one in bindings:
        _add(owners, one.owner, "texture", one.textures, result.textures, place)
        _add(owners, one.owner, "value", one.uniforms, result.uniforms, place)
        _add(owners, one.owner, "value", one.constants, result.constants, place)
        _add(owners, one.owner, "include", one.includes, result.includes, place)
    return result


def _add(
    owners: dict[tuple[str, str], str],
    owner: str,
    kind: str,
    given: Mapping[str, Any],
    into: dict[str, Any],
    place: str,
) -> None:
    for name, value in given.items():
        first = owners.setdefault((kind, name), owner)
        if first != owner:
            raise ParameterError(
                f"{place}: the {kind} '{name}' is given twice, by {first} and by {owner}; rename one of them"
            )
        into[name] = value
