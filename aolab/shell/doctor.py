"""What can render on this machine, and the remedy for what cannot."""

import importlib.metadata
import importlib.util
import os
import platform
import sys
from typing import Any

from ..errors import ContextError
from ..version import __version__

# extra: (module to import, what it is for, how to get it)
_EXTRAS = {
    "truth": (
        "embreex",
        "the ray-traced truth and error measures",
        "pip install embreex matplotlib flip-evaluator",
    ),
    "mitsuba": ("mitsuba", "a path tracer as second opinion", "pip install mitsuba"),
    "tune": ("optuna", "fitting parameters", "pip install optuna"),
    "draco": ("DracoPy", "glTF files that Draco compressed", "pip install DracoPy"),
    "notebook": ("anywidget", "picking pixels in a notebook", "pip install anywidget"),
    "pyrender": ("pyrender", "pyrender scenes as input", "pip install scikit-robot-pyrender"),
    "jupyter": ("IPython", "frames that show themselves in notebooks", "pip install jupyterlab"),
}
_LIBRARIES = ("numpy", "moderngl", "glcontext", "trimesh", "Pillow", "OpenEXR", "pydantic", "typer")


def examine() -> dict[str, Any]:
    """All findings; `renders`: whether anything can render here; `remedies`: what to do where something is missing."""
    from ..gl import context

    findings: dict[str, Any] = {
        "aolab": __version__,
        "python": platform.python_version(),
        "platform": platform.platform(),
        "libraries": {name: importlib.metadata.version(name) for name in _LIBRARIES},
        "devices": context.devices(),
        "renders": False,
        "remedies": [],
    }
    try:
        gl = context.get()
        picture = _draw_one_pixel(gl)
        findings["renders"] = picture == b"\xff\x80\x00\xff"
        if not findings["renders"]:
            findings["remedies"].append(f"the driver drew {picture.hex()} in place of ff8000ff: update it")
        findings |= {
            "renderer": gl.info["GL_RENDERER"],
            "vendor": gl.info["GL_VENDOR"],
            "opengl": gl.info["GL_VERSION"],
            "max_size": gl.info["GL_MAX_TEXTURE_SIZE"],
            "timing": "wall clock" if context.is_software() else "GPU queries",
        }
    except ContextError as error:
        findings["error"] = str(error)
        findings["remedies"] += _remedies()
    findings["extras"] = {}
    for name, (module, purpose, remedy) in _EXTRAS.items():
        found = importlib.util.find_spec(module) is not None
        findings["extras"][name] = "found" if found else f"missing: {purpose}; {remedy}"
    return findings


def _draw_one_pixel(gl: Any) -> bytes:
    target = gl.simple_framebuffer((1, 1))
    target.clear(1.0, 128 / 255, 0.0, 1.0)
    return target.read(components=4)


def _remedies() -> list[str]:
    if not sys.platform.startswith("linux"):
        return ["update the graphics driver: OpenGL 3.3 is needed"]
    remedies = [
        "Debian and Ubuntu: sudo apt install libegl1 libgl1 libgl1-mesa-dri",
        "Fedora: sudo dnf install mesa-libEGL mesa-libGL mesa-dri-drivers",
        "without root: conda install -c conda-forge mesa-llvmpipe",
    ]
    if os.environ.get("AOLAB_DEVICE"):
        remedies.insert(0, f"unset AOLAB_DEVICE (now {os.environ['AOLAB_DEVICE']}) to let aolab choose")
    if override := os.environ.get("MESA_GL_VERSION_OVERRIDE"):
        remedies.insert(0, f"MESA_GL_VERSION_OVERRIDE is {override}; it must be 3.3 or more, or unset")
    return remedies


def report(findings: dict[str, Any]) -> str:
    """The findings as lines to read."""
    lines = []
    for key, value in findings.items():
        if isinstance(value, dict):
            lines += [f"{key}:", *(f"  {name}: {text}" for name, text in value.items())]
        elif isinstance(value, list):
            lines += [
                f"{key}: {'none' if not value else ''}".rstrip(),
                *(f"  {i}: {text}" for i, text in enumerate(value)),
            ]
        else:
            lines.append(f"{key}: {value}")
    return "\n".join(lines)
