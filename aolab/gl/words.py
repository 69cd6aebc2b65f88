"""The words that a shader may use: those of the includes, and those that the pipeline offers."""

import re
from collections.abc import Mapping
from difflib import get_close_matches
from functools import cache
from pathlib import Path

from .. import paths

# at the start of a line: functions, structs and constants
_DEFINED = re.compile(
    r"^(?:(?:const\s+)?\w+\s+(?P<function>\w+)\s*\(|struct\s+(?P<struct>\w+)|const\s+\w+\s+(?P<constant>\w+)\s*=)",
    re.MULTILINE,
)
_WORD = re.compile(r"[A-Za-z_]\w*")
# names that other packages and papers have for ours
SYNONYMS = {
    "depth": "viewZ", "linearDepth": "viewZ", "depthMap": "viewZ", "gDepth": "viewZ", "z": "viewZ",
    "normal": "viewNormal", "normals": "viewNormal", "gNormal": "viewNormal", "normalMap": "viewNormal",
    "position": "viewPosAt", "gPosition": "viewPosAt", "pos": "viewPosAt", "fragPos": "viewPosAt",
    "color": "albedo", "diffuse": "albedo", "baseColor": "albedo", "gAlbedo": "albedo",
    "resolution": "texel_size", "texelSize": "texel_size", "screenSize": "texel_size",
    "projection": "pixel_from_ray", "noise": "interleavedOffset", "samples": "kernel",
    "occluded": "isWayBlocked",
}  # fmt: skip
# parameters with a type of their own
COMMON = {
    "radius": "Radius", "directions": "Directions", "steps": "Steps", "bias": "Bias", "falloff": "Falloff",
    "thickness": "Thickness",
}  # fmt: skip


def declaration(name: str, value: object) -> str:
    """The GLSL declaration of a value that is set before drawing."""
    if isinstance(value, bytes):
        return f"uniform vec4 {name}[...];"
    if isinstance(value, bool | int):
        return f"const {'bool' if isinstance(value, bool) else 'int'} {name};"
    types = {1: "float", 2: "vec2", 3: "vec3", 4: "vec4", 9: "mat3", 16: "mat4"}
    try:
        count = len(value)  # pyright: ignore[reportArgumentType]
    except TypeError:
        count = 1
    return f"uniform {types.get(count, 'float')} {name};"


@cache
def _library(root: Path) -> dict[str, str]:
    """{word: include} of the functions, structs and constants that lib/ and the occluders define."""
    words: dict[str, str] = {}
    files = [
        *sorted((root / "lib").glob("*.glsl")),
        root / "occluders" / "surfaces.glsl",
        root / "occluders/depth.glsl",
    ]
    for path in files:
        include = f"lib/{path.name}" if path.parent.name == "lib" else "occluders.glsl"
        for match in _DEFINED.finditer(path.read_text(encoding="utf-8")) if path.is_file() else ():
            name = match["function"] or match["struct"] or match["constant"]
            words.setdefault(name, include)
    return words


def remedy(name: str, text: str, offered: Mapping[str, str], near: bool = True) -> str:
    """The line that makes an undeclared `name` known to the shader `text`, or the name that was meant; else "".

    `offered` maps names to the declarations that a shader may contain. Without `near`, only the name itself counts.
    """
    library = _library(paths.glsl().resolve())

    def line_of(word: str) -> str:
        if re.search(rf"\b{word}\b\s*(?:[;,=\[(]|$)", text) and word != name:
            return ""  # the shader has it already
        return offered[word] if word in offered else f'#include "{library[word]}"'

    if name in offered:
        return f"declare it: {offered[name]}"
    if name in library:
        return f"it is defined in {library[name]}: {line_of(name)}"
    if not near:
        return ""
    if name in COMMON:
        return f"the module has no parameter '{name}'; in its class: {name}: {COMMON[name]}  (of aolab.modules.base)"
    synonym = SYNONYMS.get(name, "")
    meant = [synonym] if synonym in offered or synonym in library else []
    own = {word for word in _WORD.findall(text) if len(word) > 2} - {name}
    meant = meant or get_close_matches(name, {*offered, *library}, 1, 0.75) or get_close_matches(name, own, 1, 0.75)
    if not meant:
        return ""
    line = line_of(meant[0]) if meant[0] in offered or meant[0] in library else ""
    return f"did you mean '{meant[0]}'?{f' Its line: {line}' if line else ''}"
