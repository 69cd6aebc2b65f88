"""A real Jupyter kernel: callbacks in a subshell's thread render, and Tab completes names."""

import json
from collections.abc import Callable, Iterator

import pytest

jupyter_client = pytest.importorskip("jupyter_client")

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def kernel() -> Iterator:
    """A client of a fresh kernel."""
    manager, client = jupyter_client.manager.start_new_kernel(kernel_name="python3")
    yield client
    client.stop_channels()
    manager.shutdown_kernel(now=True)


@pytest.fixture(scope="module")
def run(kernel) -> Callable[..., str]:
    """Runs a cell and returns its printed text: `run("print(1)", subshell)`. A cell that raises fails the test."""

    def cell(code: str, subshell: str | None = None) -> str:
        content = {"code": code, "silent": False, "store_history": False, "user_expressions": {}, "allow_stdin": False}
        message = kernel.session.msg("execute_request", content)
        if subshell:
            message["header"]["subshell_id"] = subshell
        kernel.shell_channel.send(message)
        printed = []
        while True:
            answer = kernel.get_iopub_msg(timeout=120)
            if answer["parent_header"].get("msg_id") != message["header"]["msg_id"]:
                continue
            assert answer["msg_type"] != "error", answer["content"]["evalue"]
            if answer["msg_type"] == "stream":
                printed.append(answer["content"]["text"])
            if answer["msg_type"] == "status" and answer["content"]["execution_state"] == "idle":
                return "".join(printed)

    return cell


@pytest.fixture(scope="module")
def subshell(kernel) -> str:
    """The identifier of a subshell, in whose thread JupyterLab runs the callbacks of widgets."""
    kernel.control_channel.send(kernel.session.msg("create_subshell_request"))
    return kernel.get_control_msg(timeout=60)["content"]["subshell_id"]


def test_a_callback_that_renders_first_leaves_the_context_to_the_main_thread(run, subshell):
    assert run("import threading; print(threading.current_thread().name)", subshell).startswith("subshell")
    run("import aolab; lab = aolab.Lab((32, 18)); frame = lab.render('boxes', 'ssao')", subshell)
    assert run("print(aolab.gl.context.owner().thread == threading.main_thread().ident)") == "True\n"
    assert run("print(lab.render('boxes', 'ssao').image.shape)") == "(18, 32, 3)\n"
    assert run("print(frame['visibility'].shape, lab.render('boxes', 'ssdo').image.shape)", subshell) == (
        "(18, 32) (18, 32, 3)\n"
    )


@pytest.mark.parametrize(
    ("before", "offered", "not_offered"),
    [
        ('aolab.render("boxes", "ssao", pow', ["power="], ["bounces="]),
        ('aolab.render("boxes", "ssdo", ', ["bounces=", "radius="], ["power="]),
        ('aolab.render("boxes", "ss', ["ssao", "ssdo"], ["boxes", "s3ho"]),
        ('aolab.load("bo', ["boxes"], ["ssao"]),
        ('frame["vis', ["visibility"], ["viewZ"]),
    ],
)
def test_tab_completes(kernel, run, before, offered, not_offered):
    run("import aolab; frame = aolab.render('boxes', 'ssao', size=(32, 18))")
    message = kernel.complete(before, len(before))
    while True:
        answer = kernel.get_shell_msg(timeout=60)
        if answer["parent_header"]["msg_id"] == message:
            break
    matches = [match.strip("\"'])") for match in answer["content"]["matches"]]
    assert set(offered) <= set(matches)
    assert not set(not_offered) & set(matches)


INTERACT = """
import threading
import aolab, ipywidgets
lab, seen = aolab.Lab((32, 18)), []

@ipywidgets.interact(power=(0.5, 4.0))
def draw(power=1.0):
    frame = lab.render("boxes", "ssao", power=power)
    seen.append((power, frame["visibility"][frame.mask].mean(), threading.current_thread().name))
    return frame

print(draw.widget.children[0].model_id)
"""


def test_a_slider_of_interact_renders(kernel, run, subshell):
    pytest.importorskip("ipywidgets")
    slider = run(INTERACT).strip().splitlines()[-1]
    for value in (2.0, 4.0):  # as JupyterLab does when the handle moves
        data = {"method": "update", "state": {"value": value}, "buffer_paths": []}
        message = kernel.session.msg("comm_msg", {"comm_id": slider, "data": data})
        message["header"]["subshell_id"] = subshell
        kernel.shell_channel.send(message)
        while True:
            answer = kernel.get_iopub_msg(timeout=60)
            if answer["parent_header"].get("msg_id") == message["header"]["msg_id"]:
                assert answer["msg_type"] != "error", answer["content"]["evalue"]
                if answer["msg_type"] == "stream":
                    raise AssertionError(answer["content"]["text"])  # interact prints a traceback of the callback
                if answer["content"].get("execution_state") == "idle":
                    break
    powers, means, threads = zip(*json.loads(run("import json; print(json.dumps(seen, default=float))")), strict=True)
    assert powers == (1.0, 2.0, 4.0)
    assert means[0] > means[1] > means[2]
    assert threads[0] == "MainThread"
    assert threads[-1].startswith("subshell")
