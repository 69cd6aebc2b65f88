"""Uniforms of a fragment shader as flat varyings, for software renderers.

Mesa's software renderer reads each number of a uniform by a branch, for every eight pixels anew. A flat varying is the
same for all pixels of a triangle, and is read once. The vertex shader hands the uniforms on; no number changes.
"""

import re
from collections.abc import Callable, Collection
from dataclasses import dataclass, replace

from .source import Source

# joins varyings by location, so that a uniform keeps its name in both shaders
EXTENSION = "GL_ARB_separate_shader_objects"

_UNIFORM = re.compile(r"^\s*uniform\s+((float|int|i?vec[234]|mat[34])\s+(\w+)(?:\[(\w+)\])?)\s*;")
_CONSTANT = re.compile(r"^\s*const\s+int\s+(\w+)\s*=\s*(\d+)\s*;")


@dataclass(frozen=True)
class _Uniform:
    """The uniform's declaration as it is written, its parts, and the vectors that it takes as a varying."""

    text: str
    type: str
    length: str  # of an array, a number; or ""
    vectors: int


def flattened(
    vertex: Source, fragment: Source, room: int, read: Callable[[], Collection[str]]
) -> tuple[Source, Source]:
    """Both shaders, with up to `room` vectors of uniforms as varyings. `vertex` has no varyings of its own.

    If there are more, only the uniforms that the shader reads take room; `read` returns the names of these. A
    declaration stays as it is if it has a value, lists several names, or has another type than these: float, int,
    vec2 to vec4, ivec2 to ivec4, mat3, mat4, and their arrays.
    """
    uniforms = _declared(fragment)
    if sum(uniform.vectors for uniform in uniforms.values()) > room:
        names = read()
        uniforms = {name: uniform for name, uniform in uniforms.items() if name in names}
    locations, used = dict[str, int](), 0
    for name, uniform in uniforms.items():
        if used + uniform.vectors <= room:
            locations[name] = used
            used += uniform.vectors
    lines = []
    for line in fragment.text.splitlines():
        match = _UNIFORM.match(line)
        if match and match[3] in locations and match[1] == uniforms[match[3]].text:
            line = line.replace(match[0], f"layout(location = {locations[match[3]]}) flat in {match[1]};", 1)
        lines.append(line)
    moved = [(name, location, uniforms[name]) for name, location in locations.items()]
    return _with_outs(vertex, moved), _with_extension(replace(fragment, text="\n".join(lines) + "\n"))


def _declared(fragment: Source) -> dict[str, _Uniform]:
    """{name: uniform} of those that may become varyings, as they are declared first."""
    constants, found = dict[str, str](), dict[str, _Uniform]()
    for line in fragment.text.splitlines():
        if match := _CONSTANT.match(line):
            constants[match[1]] = match[2]
        if match := _UNIFORM.match(line):
            text, kind, name, length = match.groups(default="")
            length = constants.get(length, length)
            if not length or length.isdecimal():
                columns = int(kind[-1]) if kind.startswith("mat") else 1
                found.setdefault(name, _Uniform(text, kind, length, columns * int(length or 1)))
    return found


def _with_outs(vertex: Source, moved: list[tuple[str, int, _Uniform]]) -> Source:
    """The vertex shader, which copies each uniform into the varying at its location."""
    outs, copies = "", ""
    for name, location, uniform in moved:
        kind, of = uniform.type, f"[{uniform.length}]" if uniform.length else ""
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
