"""`aolab doctor`: can this machine render, and how to mend it if not?"""

import json
import shutil
import sys
from typing import Any

import typer

from . import options
from .remedies import CONDA, MESA

_LIBRARIES = ("numpy", "moderngl", "glcontext", "trimesh", "Pillow", "OpenEXR", "pydantic", "typer")


def doctor(as_json: options.Json = False) -> None:
    """Check that this machine can render, and list what is missing.

    Prints the renderer, versions, devices and optional libraries, and the command that installs what is missing. The
    exit code is 1 if nothing can be rendered.
    """
    findings = examine()
    print(json.dumps(findings, indent=2) if as_json else report(findings))
    if not findings["renders"]:
        raise typer.Exit(1)


def examine() -> dict[str, Any]:
    """All findings. `renders`: whether this machine can render; `remedies`: steps that mend it."""
    import importlib.metadata
    import platform

    from ..errors import ContextError
    from ..extras import EXTRAS, install_command, is_installed
    from ..gl import context, egl
    from ..version import __version__

    findings: dict[str, Any] = {
        "aolab": __version__,
        "python": platform.python_version(),
        "platform": platform.platform(),
        "libraries": {name: importlib.metadata.version(name) for name in _LIBRARIES},
        "devices": egl.devices(),
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
    findings["extras"] = {
        name: "found" if is_installed(name) else f"missing: {extra.purpose}; {install_command(extra.package)}"
        for name, extra in EXTRAS.items()
    }
    return findings


def _draw_one_pixel(gl: Any) -> bytes:
    target = gl.simple_framebuffer((1, 1))
    target.clear(1.0, 128 / 255, 0.0, 1.0)
    return target.read(components=4)


def _remedies() -> list[str]:
    import os

    if not sys.platform.startswith("linux"):
        return ["update the graphics driver: OpenGL 3.3 is needed"]
    here = [f"sudo {command}" for manager, command in MESA.items() if shutil.which(manager)]
    remedies = here or [f"sudo {command}" for command in MESA.values()]
    remedies.append(f"without root, and then install aolab there: {'; '.join(CONDA)}")
    if os.environ.get("AOLAB_DEVICE"):
        remedies.insert(0, f"unset AOLAB_DEVICE (now {os.environ['AOLAB_DEVICE']}): then aolab chooses the device")
    if override := os.environ.get("MESA_GL_VERSION_OVERRIDE"):
        remedies.insert(0, f"MESA_GL_VERSION_OVERRIDE is {override}; it must be 3.3 or more, or unset")
    return remedies


def report(findings: dict[str, Any]) -> str:
    """The findings as lines of text."""
    lines = []
    for key, value in findings.items():
        if isinstance(value, dict):
            lines += [f"{key}:", *(f"  {name}: {text}" for name, text in value.items())]
        elif isinstance(value, list):
            lines += [f"{key}:" if value else f"{key}: none", *(f"  {i}: {text}" for i, text in enumerate(value))]
        else:
            lines.append(f"{key}: {value}")
    return "\n".join(lines)
