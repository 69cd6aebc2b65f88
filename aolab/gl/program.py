"""Programs: compiled once for each set of constants, kept, and compiled anew when a file of theirs changes."""

import os
import re
import struct
from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from types import MappingProxyType

import moderngl

from ..errors import ShaderError, suggestion
from ..interrupts import postponed
from . import context, raw
from .flat import EXTENSION, flattened
from .report import told
from .source import Constant, Declared, Source, assemble, declared
from .words import declaration

FULLSCREEN = "pipeline/fullscreen.vert"
MAX_SAMPLERS = 16  # OpenGL 3.3 guarantees this many to a fragment shader; some drivers grant more, macOS does not


@dataclass
class Program:
    """A linked program with its uniforms by name.

    `files` are its sources with their time stamps; `locations` are those of its `out` variables, from 0 on.
    """

    gl: moderngl.Program
    name: str
    request: "Request"
    files: dict[Path, int]
    constants: set[str]
    locations: dict[str, int]
    uniforms: dict[str, moderngl.Uniform] = field(init=False)
    samplers: list[str] = field(init=False)
    _values: dict[str, moderngl.Uniform] = field(init=False)
    _last: dict[str, object] = field(init=False, default_factory=dict)  # the values that the uniforms have
    fullscreen: moderngl.VertexArray | None = None
    seconds_a_pixel: float = 0.0  # of its last draw by a software renderer; 0 before

    def __post_init__(self) -> None:
        members = {name: self.gl[name] for name in self.gl}
        self.uniforms = {name: member for name, member in members.items() if isinstance(member, moderngl.Uniform)}
        self.samplers = [name for name, uniform in self.uniforms.items() if _is_sampler(uniform)]
        self._values = {name: uniform for name, uniform in self.uniforms.items() if not _is_sampler(uniform)}
        count = sum(self.uniforms[name].array_length for name in self.samplers)
        if count > MAX_SAMPLERS:
            raise ShaderError(
                f"{self.name} reads {count} textures; OpenGL 3.3 guarantees {MAX_SAMPLERS}: {', '.join(self.samplers)}"
            )

    def set(self, values: Mapping[str, object], words: Mapping[str, object] = MappingProxyType({})) -> None:
        """Set every uniform that is not a sampler from `values`. Raises `ShaderError` for a uniform without a value, or
        of another type than its value. `words` are values that no shader can take.
        """
        for name in self._values:
            if name in words:
                raise ShaderError(
                    f"{self.name}: uniform '{name}' is {words[name]!r} in Python, which no shader can take; give the "
                    f"pass a constant in its place, as in Pass(..., constants={{'is_{words[name]}': True}})"
                )
            if name not in values:
                raise ShaderError(f"{self.name}: uniform '{name}' is given by nothing{suggestion(name, values)}")
            self.write(name, values[name])

    def write(self, name: str, value: object) -> None:
        """Set one uniform, unless it has this very value already. All uniforms are set here, samplers by their unit."""
        if name in self._last and self._last[name] is value:
            return
        uniform = self.uniforms[name]
        self._last.pop(name, None)
        try:
            if isinstance(value, bytes):
                # GLSL drops the unused tail of an array; so do we
                uniform.write(value[: uniform.array_length * uniform.dimension * 4])
            else:
                uniform.value = value
        except (struct.error, TypeError, ValueError, moderngl.Error):
            raise ShaderError(f"{self.name}: {_mismatch(name, uniform, value)}") from None
        if isinstance(value, _IMMUTABLE):
            self._last[name] = value

    def changed(self) -> bool:
        """Whether a file of this program was written since it was compiled."""
        return any(_stamp(path) != stamp for path, stamp in self.files.items())


_IMMUTABLE = bool, int, float, bytes, tuple  # values that stay as they are while they are the same object


# GL_SAMPLER_: 2D, 3D, CUBE, 2D_SHADOW, 2D_ARRAY, 2D_ARRAY_SHADOW, and INT_ and UNSIGNED_INT_ forms of 2D and 2D_ARRAY
_SAMPLERS = {0x8B5E, 0x8B5F, 0x8B60, 0x8B62, 0x8DC1, 0x8DC4, 0x8DCA, 0x8DCF, 0x8DD2, 0x8DD7}


# GL_FLOAT, GL_FLOAT_VEC2, ...
_TYPES = {0x1406: "float", 0x8B50: "vec2", 0x8B51: "vec3", 0x8B52: "vec4", 0x1404: "int", 0x8B53: "ivec2"}
_TYPES |= {0x8B54: "ivec3", 0x8B55: "ivec4", 0x1405: "uint", 0x8B56: "bool", 0x8B5B: "mat3", 0x8B5C: "mat4"}


def _mismatch(name: str, uniform: moderngl.Uniform, value: object) -> str:
    """The message about a uniform whose type in the shader is not that of its value in Python."""
    glsl = _TYPES.get(uniform.gl_type, f"of {uniform.dimension} numbers")  # pyright: ignore[reportAttributeAccessIssue]
    if isinstance(value, bytes):
        wanted, given = uniform.array_length * uniform.dimension, len(value) // 4
        return f"uniform '{name}' is {glsl}[{uniform.array_length}], {wanted} numbers, but {given} are given"
    return (
        f"uniform '{name}' is {glsl} in the shader, and {type(value).__name__} in Python ({value!r}); for this value "
        f"declare {declaration(name, value)}"
    )


def _is_sampler(uniform: moderngl.Uniform) -> bool:
    return uniform.gl_type in _SAMPLERS  # pyright: ignore[reportAttributeAccessIssue]  # its stub lacks it


def _stamp(path: Path) -> int:
    try:
        return os.stat(path).st_mtime_ns
    except FileNotFoundError:
        return 0  # an editor between delete and rename; the next look will find it


@dataclass(frozen=True)
class Request:
    """The sources of a program. `constants` are on offer: a shader takes those that it declares.

    `outputs` are the `out` variables that are drawn, in the order of their locations; None checks none of them.
    `optional` are `out` variables that the shader may have besides. Messages about GLSL text have `<name>` as its
    file; `offered` maps the names that a shader may declare to their declarations.
    """

    vertex: str
    fragment: str | Path
    constants: Mapping[str, Constant]
    aliases: Mapping[str, str]
    outputs: tuple[str, ...] | None
    optional: frozenset[str]
    geometry: str = ""
    name: str = "inline"
    offered: Mapping[str, str] = field(default_factory=dict)


class Programs:
    """The programs of a Lab, by their sources and by the constants that these declare."""

    def __init__(self) -> None:
        self._declared: dict[tuple[object, ...], list[str]] = {}  # constants
        self._programs: dict[tuple[object, ...], Program] = {}
        self.generation = 0  # grows with every reload
        self.readings = 0  # grows whenever the texts of shaders are read anew
        self._told: dict[Path, int] = {}  # the files of a reload that failed, as they were
        self._in_text: dict[object, Declared] = {}

    def __len__(self) -> int:
        return len(self._programs)

    def get(
        self,
        fragment: str | Path,
        constants: Mapping[str, Constant] | None = None,
        aliases: Mapping[str, str] | None = None,
        vertex: str = FULLSCREEN,
        outputs: Sequence[str] | None = None,
        optional: Collection[str] = (),
        geometry: str = "",
        name: str = "inline",
        offered: Callable[[], Mapping[str, str]] = dict,
    ) -> Program:
        """The program for these sources, compiled when first asked for. Raises `ShaderError`.

        `outputs` names the `out` variables that are drawn; each must be written, and no other may be there unless it is
        `optional`. More samplers than OpenGL 3.3 guarantees are an error on every driver. `name` stands for GLSL text
        in messages; `offered` returns the declarations of all names that the shader may declare.
        """
        wanted = None if outputs is None else tuple(outputs)
        constants, aliases = constants or {}, aliases or {}
        sources = _sources(vertex, geometry, fragment, aliases, wanted)
        if sources in self._declared and (key := self._key(sources, constants)) in self._programs:
            return self._programs[key]
        try:
            others = frozenset(optional), geometry, name, offered()
            return self._keep(_compile(Request(vertex, fragment, constants, aliases, wanted, *others)))
        except ShaderError:
            self._forget_texts()  # the mended file may have other includes
            raise

    def declared(self, shader: str | Path, aliases: Mapping[str, str] = MappingProxyType({})) -> Declared:
        """The includes and samplers of a shader, before anything is compiled."""
        key = shader, tuple(aliases.items())
        if key not in self._in_text:
            self._in_text[key] = declared(shader, aliases)
        return self._in_text[key]

    def changed(self) -> bool:
        """Whether a file of a program was written since the program was compiled."""
        return any(program.changed() for program in self._programs.values())

    def forget_changed(self) -> None:
        """Drop the programs whose files were written since; each is compiled again when it is asked for."""
        stale = [key for key, program in self._programs.items() if program.changed()]
        for key in stale:
            del self._programs[key]
        if stale:
            self._forget_texts()
            self.generation += 1

    def reload(self, only_changed: bool = False, tell_again: bool = True) -> list[str]:
        """Compile again what changed (or everything); returns names. On `ShaderError` the last good programs stay.

        Without `tell_again`, files that failed are left alone until one of them is written again.
        """
        stale = {key: program for key, program in self._programs.items() if not only_changed or program.changed()}
        stamps = {path: _stamp(path) for program in stale.values() for path in program.files}
        if not tell_again and stamps == self._told:
            return []
        self._told = stamps
        fresh = [_compile(program.request) for program in stale.values()]  # all of them, before any is replaced
        self._told = {}
        for key in stale:
            del self._programs[key]
        for program in fresh:
            self._keep(program)
        self.generation += bool(fresh)
        self._forget_texts()
        return sorted({program.name for program in fresh})

    def _forget_texts(self) -> None:
        self._in_text.clear()
        self.readings += 1

    def _key(self, sources: tuple[object, ...], constants: Mapping[str, Constant]) -> tuple[object, ...]:
        return sources, *map(constants.get, self._declared[sources])

    def _keep(self, program: Program) -> Program:
        request = program.request
        sources = _sources(request.vertex, request.geometry, request.fragment, request.aliases, request.outputs)
        self._declared[sources] = sorted(program.constants)
        self._programs[self._key(sources, request.constants)] = program
        return program


def _sources(
    vertex: str, geometry: str, fragment: str | Path, aliases: Mapping[str, str], outputs: tuple[str, ...] | None
) -> tuple[object, ...]:
    """The part of a program's key that does not depend on constants."""
    return vertex, geometry, fragment, frozenset(aliases.items()), outputs


def _compile(request: Request) -> Program:
    vertex = assemble(request.vertex, request.constants, request.aliases)
    fragment = assemble(request.fragment, request.constants, request.aliases, request.name)
    geometry = assemble(request.geometry, request.constants, request.aliases) if request.geometry else None
    files = vertex.files | fragment.files | (geometry.files if geometry else set())
    stamps = {path: _stamp(path) for path in files}
    locations = {name: location for location, name in enumerate(request.outputs or ()) if "[" not in name}
    linked = None
    if request.vertex == FULLSCREEN and (room := _flat_vectors()):
        with suppress(moderngl.Error):  # then the report is about the shader as it is written
            read = partial(_uniforms, vertex, fragment, locations)
            linked = _linked(*flattened(vertex, fragment, room, read), None, locations)
    try:
        linked = linked or _linked(vertex, fragment, geometry, locations)
    except moderngl.Error as error:
        stages = {"vertex_shader": vertex, "geometry_shader": geometry or vertex}
        raise ShaderError(_explained(str(error), stages, fragment, request.offered)) from None
    constants = vertex.constants | fragment.constants | (geometry.constants if geometry else set())
    return Program(linked, fragment.name, request, stamps, constants, _locations(linked, request, fragment))


def _linked(vertex: Source, fragment: Source, geometry: Source | None, locations: dict[str, int]) -> moderngl.Program:
    with postponed():  # moderngl calls Python from C, and does not look for exceptions
        return context.get().program(
            vertex_shader=vertex.text,
            geometry_shader=geometry.text if geometry else None,
            fragment_shader=fragment.text,
            fragment_outputs=locations,
        )


def _uniforms(vertex: Source, fragment: Source, locations: dict[str, int]) -> set[str]:
    """The names of the uniforms that the shaders read; an array by its bare name."""
    linked = _linked(vertex, fragment, None, locations)
    return {name.partition("[")[0] for name in linked if isinstance(linked[name], moderngl.Uniform)}


def _flat_vectors() -> int:
    """How many vectors of uniforms become flat varyings: none on hardware."""
    gl = context.get()
    if not context.is_software() or EXTENSION not in gl.extensions:
        return 0
    return gl.info["GL_MAX_FRAGMENT_INPUT_COMPONENTS"] // 4 - 2  # besides the position, and the place of the fragment


def _locations(linked: moderngl.Program, request: Request, fragment: Source) -> dict[str, int]:
    """{out variable: location} of the request's outputs, as the driver has linked them: a `layout` decides first."""
    if request.outputs is None:
        return {}
    declared = fragment.outs
    found = {name: raw.frag_data_location(linked, name) for name in request.outputs}
    for name, location in found.items():
        if location < 0:
            known = name.partition("[")[0] in declared
            missing = f"is missing{suggestion(name, declared)}; a shader declares each output: out float visibility;"
            reason = _unwritten(name, fragment) if known else missing
            raise ShaderError(f"{fragment.name}: the 'out' variable '{name}' {reason}")
    drawn = {name.partition("[")[0] for name in found}
    for name in declared:
        if name not in drawn | request.optional and raw.frag_data_location(linked, name) >= 0:
            raise ShaderError(
                f"{fragment.name}: the 'out' variable '{name}' is none of the pass's outputs{suggestion(name, found)}"
            )
    if sorted(found.values()) != list(range(len(found))):
        at = ", ".join(f"'{name}' at {location}" for name, location in found.items())
        raise ShaderError(f"{fragment.name}: locations of 'out' variables must be 0 to {len(found) - 1}: {at}")
    return found


def _unwritten(name: str, fragment: Source) -> str:
    """The reason why the driver removed an `out` variable that the shader declares."""
    if re.search(rf"\b{name.partition('[')[0]}\b[^;=]*=(?!=)", fragment.text):
        return (
            "is never written: the driver removed its assignment. Likely causes: an endless loop before it (does the "
            "loop's variable change?), a return before it"
        )
    return f"is never written: assign it in main(), as in {name} = 1.0;"


def _explained(message: str, stages: Mapping[str, Source], fragment: Source, offered: Mapping[str, str]) -> str:
    """moderngl's report, in our files and lines."""
    head = message.splitlines()[:4]
    stage = next((source for name, source in stages.items() if name in head), fragment)
    return f"{stage.name} does not compile:\n{told(message, stage, offered)}"
