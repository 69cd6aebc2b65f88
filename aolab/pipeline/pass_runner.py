"""Runs full-screen passes: textures in by name, textures out by name, timed."""

import weakref
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from functools import partial
from types import MappingProxyType

import moderngl

from ..errors import ShaderError, suggestion
from ..gl import context
from ..gl.bands import bands
from ..gl.bindings import Bindings, Joined, joined
from ..gl.program import FULLSCREEN, Program, Programs
from ..gl.texture import Depth, Kept, Pool, Size
from ..gl.timer import Timer
from ..gl.words import declaration
from ..modules.buffers import ON_DEMAND
from ..modules.passes import Pass
from ..scene.view import Region
from .tiles import Tiles

Buffers = dict[str, moderngl.Texture]

FARTHEST = 0.99  # the depth of a surface at the far plane, below that of the background, which is 1


@dataclass(frozen=True, eq=False)
class Where:
    """The pixels over which a pass is drawn: the `surfaces` of the G-buffer with this `depth`, or else the background.

    A full-screen triangle has the depth 1, as the background. A software renderer skips a pixel by its depth test, but
    computes both sides of each `if` of a shader.
    """

    depth: Depth
    surfaces: bool = True
    vertex = FULLSCREEN
    bindings = ()

    @property
    def background(self) -> "Where":
        """The other pixels."""
        return Where(self.depth, surfaces=False)

    @contextmanager
    def test(self, framebuffer: moderngl.Framebuffer) -> Iterator[None]:
        """Draw these pixels alone. The depth stays as it is."""
        gl = context.get()
        framebuffer.depth_mask = False
        gl.enable_only(moderngl.DEPTH_TEST)
        gl.depth_func = ">" if self.surfaces else "<="
        try:
            yield
        finally:
            gl.depth_func = "<"
            framebuffer.depth_mask = True
            gl.enable_only(moderngl.NOTHING)

    def draw(self, framebuffer: moderngl.Framebuffer, vertices: moderngl.VertexArray, band: Region) -> None:
        """Draw the pixels that are in `band`."""
        _fullscreen(framebuffer, vertices, band)


def _fullscreen(framebuffer: moderngl.Framebuffer, vertices: moderngl.VertexArray, band: Region) -> None:
    framebuffer.viewport = band
    vertices.render(moderngl.TRIANGLES, 3)


class PassRunner:
    """Runs the passes of one frame: programs, the pool of textures, the frame's own textures, and its timer."""

    def __init__(self, programs: Programs, pool: Pool) -> None:
        self.programs, self.pool = programs, pool
        self.timer = Timer()
        self.lent: list[tuple[Size, str, moderngl.Texture]] = []
        self._held: list[Kept] = []  # of the pool's kept textures, those that this frame reads

    def take(self, size: Size, format: str, border: float | None = None) -> moderngl.Texture:
        """A texture that belongs to this frame until nobody holds the frame; `border` as `Pool.take` has it."""
        texture = self.pool.take(size, format, border)
        self.lent.append((size, format, texture))
        return texture

    def targets(self, step: Pass, size: Size, given: Mapping[str, moderngl.Texture] = MappingProxyType({})) -> Buffers:
        """A texture for each output of the pass, that of `given` where it has one."""
        return {
            name: given.get(name) or self.take(size, format, step.outside.get(name))
            for name, format in step.outputs.items()
        }

    def give_back(self, buffers: Buffers) -> None:
        """Scratch textures that the frame need not keep; the next pass may draw over them."""
        scratch = {texture.glo for texture in buffers.values()}
        self.pool.give_back([entry for entry in self.lent if entry[2].glo in scratch])
        self.lent = [entry for entry in self.lent if entry[2].glo not in scratch]

    def kept(self, name: str, key: object, make: Callable[[], Buffers]) -> Buffers:
        """The textures that `make` returns, kept between frames under `name` while `key` and the shaders stay the same.

        Other textures that `make` draws go back to the pool. The frame holds the kept ones as long as it lives.
        """
        key = key, self.programs.generation
        kept = self.pool.kept.get(name)
        if kept is None or kept.key != key:
            before, self.lent = self.lent, []
            try:
                textures = make()
                glos = {texture.glo for texture in textures.values()}
                self.pool.give_back([entry for entry in self.lent if entry[2].glo not in glos])
                kept = self.pool.kept[name] = Kept(key, textures)
                lent = [entry for entry in self.lent if entry[2].glo in glos]
                weakref.finalize(kept, self.pool.give_back, lent)
                self.lent = before
            except BaseException:
                self.lent = before + self.lent  # the caller gives them back
                raise
        self._held.append(kept)
        return dict(kept.textures)

    def run(
        self,
        step: Pass,
        bindings: Iterable[Bindings],
        size: Size,
        *,
        targets: Buffers | None = None,
        region: Region | None = None,
        where: Where | Tiles | None = None,
        elsewhere: Buffers | None = None,
    ) -> Buffers:
        """Draw one pass over the whole of `size`, or over a `region` of it; returns its outputs.

        With `where`, the pass is drawn there. Elsewhere, its outputs are those of `elsewhere`, where given, or have the
        values of its `background`; those that it does not name, and `targets`, stay as they are.

        `targets`, where given, are drawn into in place of new textures. Raises `ParameterError` for a name that two of
        the bindings give, and `ShaderError`.
        """
        given = joined((*bindings, *_own(step), *(where.bindings if where else ())), f"pass '{step.name}'")
        program = self.program(step, given, where.vertex if where else FULLSCREEN)
        outputs = targets or self.targets(step, size)
        program.set(given.uniforms, given.words)
        self.bind(program, given.textures, step.reads)
        framebuffer = self.framebuffer(program, step, outputs, where.depth if where else None)
        whole = region or (0, 0, *size)
        with self.timer.measure(step.name), where.test(framebuffer) if where else nullcontext():
            if where and elsewhere:
                context.get().copy_framebuffer(framebuffer, self.framebuffer(program, step, elsewhere))
            elif where and not targets:
                for name, value in step.background.items():
                    self.pool.fill(outputs[name], step.outputs[name], value)
            framebuffer.use()
            for band in bands(program, whole) if self.timer.software else (whole,):
                (where.draw if where else _fullscreen)(framebuffer, self._vertices(program), band)
        return outputs

    def program(self, step: Pass, given: Joined, vertex: str = FULLSCREEN, geometry: str = "") -> Program:
        """The pass's program, with these constants and includes."""
        return self.programs.get(
            step.shader,
            given.constants,
            given.includes,
            vertex,
            list(step.outs.values()),
            step.writes,
            geometry,
            step.name,
            partial(declarations, given),
        )

    def framebuffer(
        self, program: Program, step: Pass, targets: Buffers, depth: Depth | None = None
    ) -> moderngl.Framebuffer:
        """A framebuffer over the targets, each at the location of the `out` variable that fills it."""
        locations = program.locations
        ordered = sorted(step.outs.items(), key=lambda item: locations[item[1]])
        return self.pool.framebuffer([targets[name] for name, _ in ordered], depth)

    def bind(
        self,
        program: Program,
        textures: Buffers,
        reads: Mapping[str, str] = MappingProxyType({}),
        units: Mapping[str, int] = MappingProxyType({}),
    ) -> None:
        """Put the textures that the program samples on units, by name; `reads` has other names (sampler: buffer).

        `units` are samplers whose textures the caller binds, by unit.
        """
        most = len(program.samplers) + len(units)
        context.get().clear_samplers(0, most)
        free = (unit for unit in range(most) if unit not in units.values())
        for name in program.samplers:
            if name in units:
                program.write(name, units[name])
                continue
            buffer = reads.get(name, name)
            if buffer not in textures:
                raise ShaderError(
                    f"{program.name}: no buffer '{buffer}' to sample{suggestion(buffer, {*textures, *ON_DEMAND})}"
                )
            unit, texture = next(free), textures[buffer]
            program.write(name, unit)
            texture.use(unit)
            if texture.extra is not None:
                self.pool.border(texture.extra).use(unit)

    def _vertices(self, program: Program) -> moderngl.VertexArray:
        """Vertices without input, numbered."""
        if program.fullscreen is None:
            program.fullscreen = context.get().vertex_array(program.gl, [])
        return program.fullscreen


def declarations(given: Joined) -> dict[str, str]:
    """{name: GLSL declaration} of all that a shader may declare: values, the textures at hand, those on demand."""
    values = {name: declaration(name, value) for name, value in {**given.uniforms, **given.constants}.items()}
    on_demand = {name: f"uniform sampler2D {name};" for name in ON_DEMAND}
    kinds = {"u": "usampler2D", "i": "isampler2D"}
    textures = {name: f"uniform {kinds.get(of.dtype[0], 'sampler2D')} {name};" for name, of in given.textures.items()}
    return {**values, **on_demand, **textures}


def _own(step: Pass) -> list[Bindings]:
    if not step.constants and not step.includes:
        return []
    return [Bindings(f"the pass '{step.name}'", constants=step.constants, includes=step.includes)]
