"""`aolab doctor`: the findings on this machine, and the remedies if nothing can be rendered."""

import json
import runpy
import sys
from pathlib import Path

import pytest

from aolab.extras import EXTRAS, install_command
from aolab.gl import context
from aolab.shell import doctor
from aolab.shell import remedies as remedies_of_both

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
        ({"AOLAB_DEVICE": "99"}, "unset AOLAB_DEVICE (now 99): then aolab chooses the device"),
        (NO_DRIVER, "sudo apt-get install libegl1 libgl1 libgl1-mesa-dri"),
    ],
)
def test_if_nothing_can_be_rendered_the_remedy_is_named_and_the_exit_code_is_1(python, gl, broken, remedy):
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


def test_the_text_has_the_same_findings(python):
    done = python(DOCTOR.format([]), **NO_DRIVER)
    assert done.returncode == 1
    assert "renders: False" in done.stdout
    assert "sudo apt-get install libegl1" in done.stdout


def test_a_wrong_picture_is_no_rendering(gl, monkeypatch):
    monkeypatch.setattr(doctor, "_draw_one_pixel", lambda gl: b"\0\0\0\xff")
    findings = doctor.examine()
    assert findings["renders"] is False
    assert findings["remedies"] == ["the driver drew 000000ff in place of ff8000ff: update it"]


def test_missing_extras_are_listed_with_the_command_that_installs_them(gl, monkeypatch):
    monkeypatch.setattr("aolab.extras.is_installed", lambda name: name == "flip")
    findings = doctor.examine()["extras"]
    assert findings.pop("flip") == "found"
    assert list(findings) == [name for name in EXTRAS if name != "flip"]
    for name, text in findings.items():
        assert text == f"missing: {EXTRAS[name].purpose}; {install_command(EXTRAS[name].package)}"


def test_the_way_without_root_is_the_set_ups(monkeypatch):
    """`tools/setup.py` and the doctor print the same lines."""
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setattr("shutil.which", lambda name: None)
    setup = runpy.run_path(str(Path(__file__).parents[2] / "tools/setup.py"), run_name="setup")
    explained = setup["explain"](["libegl1"])
    remedies = "\n".join(doctor._remedies())
    for line in remedies_of_both.CONDA:
        assert line in explained
        assert line in remedies
