"""A window that shows a `Viewer`, by GLFW. Its own OpenGL context draws the finished picture, no more."""

import sys
from typing import Any

import moderngl
import numpy as np

from ..errors import ContextError
from ..extras import need
from ..interrupts import postponed
from .viewer import Viewer

VERTEX = """#version 330
out vec2 uv;
void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0;
    uv = vec2(corner.x, 1.0 - corner.y);
    gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}
"""
FRAGMENT = """#version 330
uniform sampler2D picture;
in vec2 uv;
out vec4 color;
void main() { color = vec4(texture(picture, uv).rgb, 1.0); }
"""
WAIT = 0.1  # seconds that the loop sleeps at most without input


class _Loader:
    """The loader of OpenGL's functions for moderngl: those of the context that GLFW has made current."""

    def __init__(self, glfw: Any) -> None:
        self._glfw = glfw

    def load_opengl_function(self, name: str) -> int:
        return self._glfw.get_proc_address(name) or 0

    def __enter__(self) -> None: ...

    def __exit__(self, *_: object) -> None: ...

    def release(self) -> None: ...


class Window:
    """The window of a viewer. Raises `ContextError` where there is no display, and `ParameterError` without GLFW."""

    def __init__(self, viewer: Viewer, title: str = "aolab") -> None:
        self.viewer = viewer
        self._glfw: Any = need("view")
        problems: list[str] = []
        self._glfw.set_error_callback(lambda _, text: problems.append(text.decode(errors="replace")))
        if not self._glfw.init():
            raise _no_window(problems)
        for hint, value in self._hints():
            self._glfw.window_hint(hint, value)
        self._window = self._glfw.create_window(*viewer.size, title, None, None)
        if not self._window:
            self._glfw.terminate()
            raise _no_window(problems)
        self._glfw.make_context_current(self._window)
        loader: Any = _Loader(self._glfw)
        self._context = moderngl.create_context(require=330, context=loader)
        with postponed():
            self._program = self._context.program(vertex_shader=VERTEX, fragment_shader=FRAGMENT)
        self._triangle = self._context.vertex_array(self._program, [])
        self._texture = self._context.texture(viewer.size, 3, alignment=1)
        self._place: tuple[float, float] | None = None  # of the pointer, while a button is down
        self._listen()

    def _hints(self) -> list[tuple[int, int]]:
        glfw = self._glfw
        hints = [
            (glfw.CONTEXT_VERSION_MAJOR, 3),
            (glfw.CONTEXT_VERSION_MINOR, 3),
            (glfw.OPENGL_PROFILE, glfw.OPENGL_CORE_PROFILE),
            (glfw.OPENGL_FORWARD_COMPAT, True),
            (glfw.RESIZABLE, False),
        ]
        # the package's own context is one of EGL, and a thread has one context of each kind
        if sys.platform.startswith("linux"):
            hints.append((glfw.CONTEXT_CREATION_API, glfw.EGL_CONTEXT_API))
        return hints

    def _listen(self) -> None:
        glfw = self._glfw
        glfw.set_key_callback(self._window, self._key)
        glfw.set_mouse_button_callback(self._window, self._button)
        glfw.set_cursor_pos_callback(self._window, self._move)
        glfw.set_scroll_callback(self._window, self._scroll)

    def _key(self, _window: Any, code: int, scan: int, action: int, mods: int) -> None:
        glfw = self._glfw
        if action == glfw.RELEASE:
            return
        named = {glfw.KEY_UP: "up", glfw.KEY_DOWN: "down", glfw.KEY_LEFT: "left", glfw.KEY_RIGHT: "right",
                 glfw.KEY_ESCAPE: "escape"}  # fmt: skip
        self.viewer.press(named.get(code) or glfw.get_key_name(code, scan) or "", bool(mods & glfw.MOD_SHIFT))

    def _button(self, window: Any, _which: int, action: int, _mods: int) -> None:
        self._place = self._glfw.get_cursor_pos(window) if action == self._glfw.PRESS else None
        if self._place is None:
            self.viewer.rest()

    def _move(self, _window: Any, x: float, y: float) -> None:
        if self._place is not None:
            self.viewer.drag(x - self._place[0], y - self._place[1])
            self._place = x, y

    def _scroll(self, _window: Any, _right: float, steps: float) -> None:
        self.viewer.scroll(steps)

    def draw(self) -> None:
        """Render the viewer's picture, and show it."""
        picture = self.viewer.picture()
        self._glfw.make_context_current(self._window)
        self._texture.write(np.ascontiguousarray(picture).tobytes())
        self._context.screen.use()
        self._context.viewport = 0, 0, *self._glfw.get_framebuffer_size(self._window)
        self._texture.use(0)
        self._triangle.render(moderngl.TRIANGLES, 3)
        self._glfw.swap_buffers(self._window)
        self._glfw.make_context_current(None)

    def run(self) -> None:
        """Show the viewer until the window is closed."""
        try:
            while not (self._glfw.window_should_close(self._window) or self.viewer.closed):
                if self.viewer.stale:
                    self.draw()
                self._glfw.wait_events_timeout(WAIT)
        finally:
            self.close()

    def close(self) -> None:
        self._glfw.terminate()


def _no_window(problems: list[str]) -> ContextError:
    reason = problems[-1] if problems else "no reason is given"
    return ContextError(
        f"no window can be opened here ({reason}): `aolab render` writes a picture, aolab.explore works in a notebook"
    )
