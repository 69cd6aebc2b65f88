"""Runs full-screen passes: textures in by name, textures out by name, timed."""

from collections.abc import Mapping
from types import MappingProxyType

import moderngl

from ..errors import ShaderError, suggestion
from ..gl import context
from ..gl.program import Program, Programs
from ..gl.source import Constant
from ..gl.texture import Pool, Size
from ..gl.timer import Timer
from ..modules.passes import Pass

Buffers = dict[str, moderngl.Texture]


class Painter:
    """What all passes of one frame share: programs, the pool, the frame's textures and its timer."""

    def __init__(self, programs: Programs, pool: Pool, samplers: Mapping[str, moderngl.Sampler]) -> None:
        self.programs, self.pool, self._samplers = programs, pool, samplers
        self.timer = Timer()
        self.lent: list[tuple[Size, str, moderngl.Texture]] = []

    def take(self, size: Size, format: str) -> moderngl.Texture:
        """A texture that belongs to this frame until nobody holds the frame."""
        texture = self.pool.take(size, format)
        self.lent.append((size, format, texture))
        return texture

    def give_back(self, buffers: Buffers) -> None:
        """Scratch textures that the frame need not keep; the next pass may draw over them."""
        scratch = {texture.glo for texture in buffers.values()}
        self.pool.give_back([entry for entry in self.lent if entry[2].glo in scratch])
        self.lent = [entry for entry in self.lent if entry[2].glo not in scratch]

    def run(
        self,
        step: Pass,
        inputs: Buffers,
        uniforms: Mapping[str, object],
        size: Size,
        constants: Mapping[str, Constant] | None = None,
        aliases: Mapping[str, str] | None = None,
        targets: Buffers | None = None,
    ) -> Buffers:
        """Draw one pass; returns its outputs (`targets`, where given, are drawn into as they are set up)."""
        wanted = {**(constants or {}), **step.constants}
        program = self.programs.get(step.shader, wanted, aliases)
        outputs = targets or {name: self.take(size, format) for name, format in step.outputs.items()}
        program.set(uniforms)
        self.bind(program, inputs, step.reads)
        framebuffer = self.pool.framebuffer(list(outputs.values()))
        framebuffer.use()
        with self.timer.measure(step.name):
            self._fullscreen(program).render(moderngl.TRIANGLES, 3)
        return outputs

    def bind(self, program: Program, inputs: Buffers, reads: Mapping[str, str] = MappingProxyType({})) -> None:
        """Put the textures that the program samples on units, by name; `reads` has other names (sampler: buffer)."""
        for unit, name in enumerate(program.samplers):
            buffer = reads.get(name, name)
            if buffer not in inputs:
                raise ShaderError(f"{program.name}: no buffer '{buffer}' to sample{suggestion(buffer, inputs)}")
            inputs[buffer].use(unit)
            program.uniforms[name].value = unit
            if sampler := self._samplers.get(name):
                sampler.use(unit)
            else:
                context.get().clear_samplers(unit, unit + 1)

    def bind_unit(self, program: Program, name: str, unit: int) -> None:
        """Let the program sample `name` from a unit that somebody else fills, without a sampler object in the way."""
        if name in program.uniforms:
            program.uniforms[name].value = unit
        context.get().clear_samplers(unit, unit + 1)

    def _fullscreen(self, program: Program) -> moderngl.VertexArray:
        if program.fullscreen is None:
            program.fullscreen = context.get().vertex_array(program.gl, [])
        return program.fullscreen
