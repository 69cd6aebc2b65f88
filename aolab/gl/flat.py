"""Uniforms of a fragment shader as flat varyings, for software renderers.

Mesa's software renderer reads each number of a uniform by a branch, for every eight pixels anew. A flat varying is the
same for all pixels of a triangle, and is read once. The vertex shader hands the uniforms on; no number changes.
"""

import re
from dataclasses import replace

from .source import Source

# joins varyings by location, so that a uniform keeps its name in both shaders
EXTENSION = "GL_ARB_separate_shader_objects"

_UNIFORM = re.compile(r"^\s*uniform\s+((?:float|int|i?vec[234]|mat[34])\s+\w+(?:\[\w+\])?)\s*;")
_DECLARED = re.compile(r"(?P<type>\w+)\s+(?P<name>\w+)(?:\[(?P<length>\w+)\])?")
_CONSTANT = re.compile(r"^\s*const\s+int\s+(\w+)\s*=\s*(\d+)\s*;")


def flattened(vertex: Source, fragment: Source, room: int) -> tuple[Source, Source]:
    """Both shaders, with up to `room` vectors of uniforms as varyings. `vertex` has no varyings of its own.

    A declaration stays as it is if it has a value, lists several names, or has another type than these: float, int,
    vec2 to vec4, ivec2 to ivec4, mat3, mat4, and their arrays.
    """
    constants: dict[str, int] = {}
    moved: dict[str, str] = {}
    handed, lines, location = [], [], 0
    for line in fragment.text.splitlines():
        if match := _CONSTANT.match(line):
            constants[match[1]] = int(match[2])
        match = _UNIFORM.match(line)
        parts = _DECLARED.fullmatch(match[1]) if match else None
        vectors = _vectors(parts, constants) if parts else 0
        if match and parts and parts["name"] in moved:
            line = line.replace(match[0], "", 1) if moved[parts["name"]] == match[1] else line
        elif match and parts and 0 < vectors <= room - location:
            moved[parts["name"]] = match[1]
            line = line.replace(match[0], f"layout(location = {location}) flat in {match[1]};", 1)
            handed.append((location, parts, constants.get(parts["length"] or "", parts["length"])))
            location += vectors
        lines.append(line)
    return _with_outs(vertex, handed), _with_extension(replace(fragment, text="\n".join(lines) + "\n"))


def _vectors(declared: re.Match[str], constants: dict[str, int]) -> int:
    """The locations that a varying takes; 0 for an array of unknown length."""
    length = declared["length"] or "1"
    count = int(length) if length.isdecimal() else constants.get(length, 0)
    return count * (int(declared["type"][-1]) if declared["type"].startswith("mat") else 1)


def _with_outs(vertex: Source, handed: list[tuple[int, re.Match[str], int | str | None]]) -> Source:
    """The vertex shader, which copies each uniform into the varying at its location."""
    outs, copies = "", ""
    for location, declared, length in handed:
        of = f"[{length}]" if length else ""
        kind, name = declared["type"], declared["name"]
        outs += f"uniform {kind} {name}{of}; layout(location = {location}) flat out {kind} flat_{name}{of}; "
        copies += f" flat_{name} = {name};"
    text = vertex.text.replace("void main() {", f"{outs}void main() {{{copies}", 1)
    return _with_extension(replace(vertex, text=text))


def _with_extension(source: Source) -> Source:
    """The shader with the extension after its first line, which is the version."""
    version, rest = source.text.split("\n", 1)
    return replace(
        source, text=f"{version}\n#extension {EXTENSION} : require\n{rest}", lines=[source.lines[0], *source.lines]
    )
