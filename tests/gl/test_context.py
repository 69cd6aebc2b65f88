"""The one context of a process: who may use it, which device draws, and what is said where none can."""

import threading

import numpy as np
import pytest

from aolab import ContextError
from aolab.gl import context, egl

RENDER = """
import numpy as np, trimesh
import aolab
from aolab.gl import context
lab, scene = aolab.Lab((16, 12)), aolab.load(trimesh.creation.box())
frame = lab.render(scene)
"""


def in_a_thread(work) -> BaseException | None:
    caught: list[BaseException] = []

    def run() -> None:
        try:
            work()
        except BaseException as error:
            caught.append(error)

    thread = threading.Thread(target=run)
    thread.start()
    thread.join()
    return caught[0] if caught else None


def test_there_is_one_context(gl):
    assert context.get() is gl
    assert gl.version_code >= 330
    assert context.renderer() == gl.info["GL_RENDERER"]


def test_another_thread_is_told_what_to_do(lab, plane):
    frame = lab.render(plane)
    for work in (context.get, lambda: lab.render(plane), lambda: frame["albedo"]):
        error = in_a_thread(work)
        assert isinstance(error, ContextError)
        assert "thread that rendered first" in str(error)
        assert "multiprocessing.get_context('spawn')" in str(error)


def test_an_array_that_was_read_may_be_used_in_any_thread(lab, plane):
    frame = lab.render(plane)
    image = frame.image
    assert in_a_thread(lambda: np.testing.assert_array_equal(frame.image, image)) is None


def test_frames_may_be_dropped_in_any_thread(lab, boxes):
    """A garbage collector runs where it likes; textures must find their way back without GL."""
    expected = lab.render(boxes).image
    held = [lab.render(boxes, seed=seed) for seed in range(3)]
    assert in_a_thread(held.clear) is None
    np.testing.assert_array_equal(lab.render(boxes).image, expected)


def test_a_forked_child_is_told_what_to_do(python):
    done = python(
        RENDER
        + """
import os, sys, warnings
warnings.simplefilter("ignore", DeprecationWarning)  # Python 3.12: forking beside the driver's threads
child = os.fork()
if not child:
    try:
        lab.render(scene)
        code = 1
    except aolab.ContextError as error:
        code = 42 if "forked" in str(error) and "get_context('spawn')" in str(error) else 2
    os._exit(code)
print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
print(np.array_equal(lab.render(scene).image, frame.image))  # the parent goes on
"""
    )
    assert (done.returncode, done.stdout) == (0, "42\nTrue\n"), done.stderr


def test_spawned_workers_render(tmp_path, python):
    (tmp_path / "work.py").write_text(
        RENDER.replace("frame = ", "def draw(seed):\n    return ").replace(
            "scene)\n", "scene, seed=seed).image.mean()\n"
        )
    )
    done = python(
        """
        import multiprocessing, sys
        sys.path.insert(0, ".")
        if __name__ == "__main__":
            import work
            here = [work.draw(seed) for seed in (0, 1)]
            with multiprocessing.get_context("spawn").Pool(1) as pool:
                print(pool.map(work.draw, (0, 1)) == here)
        """
    )
    assert (done.returncode, done.stdout) == (0, "True\n"), done.stderr


def test_a_released_context_is_made_again(python):
    done = python(
        RENDER
        + """
before = frame.image
del frame
context.release()
context.release()  # twice does no harm
again = aolab.Lab((16, 12)).render(scene)
print(np.array_equal(again.image, before))
"""
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "True\n", "")


def test_the_process_ends_quietly_with_frames_and_a_lab_alive(python):
    done = python(RENDER + "keep = [lab.render(scene, seed=seed) for seed in range(3)]")
    assert (done.returncode, done.stderr) == (0, "")


# --- devices


def test_devices_are_listed_and_the_software_one_is_known(gl):
    devices = egl.devices()
    assert devices
    assert all(name == "software" or name.startswith("hardware") for name in devices)
    if context.is_software():
        assert "software" in devices


def test_hardware_is_preferred(monkeypatch):
    monkeypatch.delenv("AOLAB_DEVICE", raising=False)
    monkeypatch.setattr(egl, "devices", lambda: ["software", "hardware /dev/dri/card0", "hardware"])
    assert context._preferred_devices() == [1, 2, 0]
    monkeypatch.setattr(egl, "devices", list)
    assert context._preferred_devices() == [0]


def test_a_chosen_device_is_used_and_no_other(monkeypatch):
    monkeypatch.setattr(egl, "devices", lambda: ["hardware", "software"])
    monkeypatch.setenv("AOLAB_DEVICE", "1")
    assert context._preferred_devices() == [1]


@pytest.mark.parametrize("wanted", ["99", "-1", "first"])
def test_a_device_that_is_not_there_is_refused_with_those_that_are(python, wanted):
    done = python("import aolab; aolab.Lab()", AOLAB_DEVICE=wanted)
    assert done.returncode == 1
    last = done.stderr.splitlines()[-1]
    assert last.startswith(f"aolab.errors.ContextError: AOLAB_DEVICE = '{wanted}' is not a device of this machine (0: ")


def test_a_driver_below_opengl_33_is_refused(python, gl):
    if "Mesa" not in gl.info["GL_VERSION"]:
        pytest.skip("only Mesa can pretend to be older")
    done = python("import aolab; aolab.Lab()", MESA_GL_VERSION_OVERRIDE="2.1", MESA_GLSL_VERSION_OVERRIDE=None)
    assert done.returncode == 1
    assert "aolab.errors.ContextError: no OpenGL 3.3 context through EGL (device 0: " in done.stderr
    assert "`aolab doctor` names the remedy" in done.stderr
