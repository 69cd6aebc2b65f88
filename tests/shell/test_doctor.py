"""`aolab doctor`: what can render here, and the remedy where nothing can."""

import json

import pytest

from aolab.gl import context
from aolab.shell import doctor

DOCTOR = "import sys; sys.argv = ['aolab', 'doctor', *{!r}]; from aolab.shell.cli import main; main()"
NO_DRIVER = {"__EGL_VENDOR_LIBRARY_DIRS": "/nowhere", "__EGL_VENDOR_LIBRARY_FILENAMES": "/nowhere/none.json"}


def test_a_machine_that_renders(gl):
    findings = doctor.examine()
    assert findings["renders"] is True
    assert findings["remedies"] == []
    assert findings["renderer"] == context.renderer()
    assert findings["max_size"] >= 1024
    assert findings["timing"] in ("wall clock", "GPU queries")
    assert findings["libraries"]["moderngl"]
    text = doctor.report(findings)
    assert f"renderer: {context.renderer()}" in text
    assert "remedies: none" in text


def test_the_shell_prints_json_and_ends_with_0(python):
    done = python(DOCTOR.format(["--json"]))
    assert done.returncode == 0, done.stderr
    findings = json.loads(done.stdout)
    assert findings["renders"] is True
    assert {"aolab", "python", "platform", "libraries", "devices", "renderer", "opengl", "extras"} <= set(findings)


@pytest.mark.parametrize(
    ("broken", "remedy"),
    [
        ({"MESA_GL_VERSION_OVERRIDE": "2.1"}, "MESA_GL_VERSION_OVERRIDE is 2.1; it must be 3.3 or more, or unset"),
        ({"AOLAB_DEVICE": "99"}, "unset AOLAB_DEVICE (now 99) to let aolab choose"),
        (NO_DRIVER, "sudo apt install libegl1 libgl1 libgl1-mesa-dri"),
    ],
)
def test_where_nothing_can_render_it_names_the_remedy_and_ends_with_1(python, gl, broken, remedy):
    if "MESA_GL_VERSION_OVERRIDE" in broken and "Mesa" not in gl.info["GL_VERSION"]:
        pytest.skip("only Mesa can pretend to be older")
    done = python(DOCTOR.format(["--json"]), **broken)
    assert done.returncode == 1, done.stderr
    findings = json.loads(done.stdout)
    assert findings["renders"] is False
    assert findings["error"]
    assert any(remedy in one for one in findings["remedies"])
    assert any("conda-forge" in one for one in findings["remedies"])  # the way without root
    assert "Traceback" not in done.stderr


def test_for_people_it_says_the_same(python):
    done = python(DOCTOR.format([]), **NO_DRIVER)
    assert done.returncode == 1
    assert "renders: False" in done.stdout
    assert "sudo apt install libegl1" in done.stdout


def test_a_picture_that_is_wrong_is_no_rendering(gl, monkeypatch):
    monkeypatch.setattr(doctor, "_draw_one_pixel", lambda gl: b"\0\0\0\xff")
    findings = doctor.examine()
    assert findings["renders"] is False
    assert findings["remedies"] == ["the driver drew 000000ff in place of ff8000ff: update it"]


def test_extras_that_are_missing_come_with_the_way_to_get_them(gl, monkeypatch):
    monkeypatch.setattr(doctor.importlib.util, "find_spec", lambda name: None)
    extras = doctor.examine()["extras"]
    assert all(text.startswith("missing: ") and "pip install" in text for text in extras.values())
