"""Programs: compiled once for each set of constants, kept, and compiled anew when a file of theirs changes."""

import os
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import moderngl

from ..errors import ShaderError, suggestion
from . import context, raw
from .source import Constant, Declared, Source, assemble, declared

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
    fullscreen: moderngl.VertexArray | None = None

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

    def set(self, values: Mapping[str, object]) -> None:
        """Set every uniform that is not a sampler from `values`. Raises `ShaderError` for a uniform without a value."""
        for name, uniform in self._values.items():
            if name not in values:
                raise ShaderError(f"{self.name}: uniform '{name}' is given by nothing{suggestion(name, values)}")
            value = values[name]
            if isinstance(value, bytes):
                # GLSL drops the unused tail of an array; so do we
                uniform.write(value[: uniform.array_length * uniform.dimension * 4])
            else:
                uniform.value = value

    def changed(self) -> bool:
        """Whether a file of this program was written since it was compiled."""
        return any(_stamp(path) != stamp for path, stamp in self.files.items())


# GL_SAMPLER_: 2D, 3D, CUBE, 2D_SHADOW, 2D_ARRAY, 2D_ARRAY_SHADOW, and INT_ and UNSIGNED_INT_ forms of 2D and 2D_ARRAY
_SAMPLERS = {0x8B5E, 0x8B5F, 0x8B60, 0x8B62, 0x8DC1, 0x8DC4, 0x8DCA, 0x8DCF, 0x8DD2, 0x8DD7}


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
    `optional` are `out` variables that the shader may have besides.
    """

    vertex: str
    fragment: str | Path
    constants: Mapping[str, Constant]
    aliases: Mapping[str, str]
    outputs: tuple[str, ...] | None
    optional: frozenset[str]
    geometry: str = ""

    @property
    def sources(self) -> tuple[object, ...]:
        return self.vertex, self.geometry, self.fragment, tuple(sorted(self.aliases.items())), self.outputs


class Programs:
    """The programs of a Lab, by their sources and by the constants that these declare."""

    def __init__(self) -> None:
        self._declared: dict[tuple[object, ...], frozenset[str]] = {}
        self._programs: dict[tuple[object, ...], Program] = {}
        self.generation = 0  # grows with every reload
        self._told: dict[Path, int] = {}  # the files of a reload that failed, as they were
        self._in_text: dict[str | Path, Declared] = {}

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
    ) -> Program:
        """The program for these sources, compiled when first asked for. Raises `ShaderError`.

        `outputs` names the `out` variables that are drawn; each must be written, and no other may be there unless it is
        `optional`. More samplers than OpenGL 3.3 guarantees are an error on every driver.
        """
        wanted = None if outputs is None else tuple(outputs)
        request = Request(vertex, fragment, constants or {}, aliases or {}, wanted, frozenset(optional), geometry)
        if request.sources not in self._declared:
            return self._keep(_compile(request))
        key = self._key(request)
        return self._programs[key] if key in self._programs else self._keep(_compile(request))

    def declared(self, shader: str | Path) -> Declared:
        """The includes and samplers of a shader, before anything is compiled."""
        if shader not in self._in_text:
            self._in_text[shader] = declared(shader)
        return self._in_text[shader]

    def changed(self) -> bool:
        """Whether a file of a program was written since the program was compiled."""
        return any(program.changed() for program in self._programs.values())

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
        if stale:
            self._in_text.clear()
        for key in stale:
            del self._programs[key]
        for program in fresh:
            self._keep(program)
        self.generation += bool(fresh)
        self._in_text.clear()
        return sorted({program.name for program in fresh})

    def _key(self, request: Request) -> tuple[object, ...]:
        declared = self._declared[request.sources]
        used = sorted((name, value) for name, value in request.constants.items() if name in declared)
        return *request.sources, *used

    def _keep(self, program: Program) -> Program:
        self._declared[program.request.sources] = frozenset(program.constants)
        self._programs[self._key(program.request)] = program
        return program


def _compile(request: Request) -> Program:
    vertex = assemble(request.vertex, request.constants, request.aliases)
    fragment = assemble(request.fragment, request.constants, request.aliases)
    geometry = assemble(request.geometry, request.constants, request.aliases) if request.geometry else None
    files = vertex.files | fragment.files | (geometry.files if geometry else set())
    stamps = {path: _stamp(path) for path in files}
    locations = {name: location for location, name in enumerate(request.outputs or ()) if "[" not in name}
    try:
        linked = context.get().program(
            vertex_shader=vertex.text,
            geometry_shader=geometry.text if geometry else None,
            fragment_shader=fragment.text,
            fragment_outputs=locations,
        )
    except moderngl.Error as error:
        stages = {"vertex_shader": vertex, "geometry_shader": geometry or vertex}
        raise ShaderError(_explain(str(error), stages, fragment)) from None
    constants = vertex.constants | fragment.constants | (geometry.constants if geometry else set())
    return Program(linked, fragment.name, request, stamps, constants, _locations(linked, request, fragment))


def _locations(linked: moderngl.Program, request: Request, fragment: Source) -> dict[str, int]:
    """{out variable: location} of the request's outputs, as the driver has linked them: a `layout` decides first."""
    if request.outputs is None:
        return {}
    declared = fragment.outs
    found = {name: raw.frag_data_location(linked, name) for name in request.outputs}
    for name, location in found.items():
        if location < 0:
            known = name.partition("[")[0] in declared
            reason = "is never written" if known else f"is missing{suggestion(name, declared)}"
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


def _explain(message: str, stages: Mapping[str, Source], fragment: Source) -> str:
    """moderngl's report, told in our files and lines."""
    head = message.splitlines()[:4]
    stage = next((source for name, source in stages.items() if name in head), fragment)
    report = [line for line in message.splitlines() if line.strip() and set(line.strip()) != {"="}]
    titles = (
        "GLSL Compiler failed",
        "GLSL Linker failed",
        "vertex_shader",
        "geometry_shader",
        "fragment_shader",
        "Program",
    )
    detail = "\n".join(line for line in report if line.strip() not in titles)
    return f"{stage.name} does not compile:\n{stage.locate(detail)}"
