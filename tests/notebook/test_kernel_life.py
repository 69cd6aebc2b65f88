"""The life of a kernel: restarts, interrupts in a frame, two notebooks at once, and a thousand frames in a row."""

import json
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

import pytest

manager = pytest.importorskip("jupyter_client.manager")

pytestmark = [pytest.mark.slow, pytest.mark.long]

RENDER = """
import aolab
lab = aolab.Lab((64, 36))
print(lab.render("boxes", "ssdo", bounces=1).image.tobytes().hex())
"""
PATIENCE = 120  # seconds


class Kernel:
    """A running kernel and its client."""

    def __init__(self) -> None:
        self.manager, self.client = manager.start_new_kernel(kernel_name="python3")

    def send(self, code: str) -> str:
        return self.client.execute(code, store_history=False, allow_stdin=False)

    def answer(self, message: str) -> tuple[str, str]:
        """The printed text of a cell that was sent, and the name of its error or ""."""
        printed, error = [], ""
        while True:
            seen = self.client.get_iopub_msg(timeout=PATIENCE)
            if seen["parent_header"].get("msg_id") != message:
                continue
            if seen["msg_type"] == "stream" and seen["content"]["name"] == "stdout":
                printed.append(seen["content"]["text"])
            if seen["msg_type"] == "error":
                error = seen["content"]["ename"]
            if seen["content"].get("execution_state") == "idle":
                return "".join(printed), error

    def run(self, code: str) -> str:
        printed, error = self.answer(self.send(code))
        assert not error, error
        return printed

    def close(self) -> None:
        self.client.stop_channels()
        self.manager.shutdown_kernel(now=True)


@contextmanager
def kernels(count: int) -> Iterator[list[Kernel]]:
    with ExitStack() as stack:
        started = [Kernel() for _ in range(count)]
        for kernel in started:
            stack.callback(kernel.close)
        yield started


@pytest.fixture(scope="module")
def kernel() -> Iterator[Kernel]:
    with kernels(1) as (one,):
        yield one


@pytest.fixture(scope="module")
def picture(kernel) -> str:
    """The render in a fresh kernel."""
    return kernel.run(RENDER)


def test_a_restarted_kernel_renders_the_same(kernel, picture):
    kernel.run("frame = lab.render('boxes', 'ssao')")  # its light is not computed yet
    kernel.manager.restart_kernel(now=True)
    kernel.client.wait_for_ready(timeout=PATIENCE)
    assert kernel.run(RENDER) == picture


@pytest.mark.parametrize(
    "long_work",
    [
        'lab.render("boxes", "ssao", size=(640, 360), accumulate=16_000)',
        'lab.render("boxes", "ssao", size=(1280, 720), directions=64, steps=16)',
        'aolab.reference("boxes", size=(640, 360), rays=100_000, cache=False)',
        'aolab.sweep("boxes", "ssao", size=(64, 36), seed=range(100_000), reference=False)',
    ],
    ids=["many frames", "a large frame", "a reference", "a sweep"],
)
def test_an_interrupt_ends_long_work_and_leaves_the_lab_whole(kernel, picture, long_work):
    kernel.run(RENDER)
    message = kernel.send(f"print('begun', flush=True)\n{long_work}")
    time.sleep(4)  # in mid-frame
    begun = time.monotonic()
    kernel.manager.interrupt_kernel()
    printed, error = kernel.answer(message)
    print(f"{long_work}: ended {time.monotonic() - begun:.1f} s after the interrupt")
    assert (printed, error) == ("begun\n", "KeyboardInterrupt")
    assert kernel.run('print(lab.render("boxes", "ssdo", bounces=1).image.tobytes().hex())') == picture


def test_two_notebooks_render_at_once(picture):
    with kernels(2) as pair:
        for _ in range(3):
            sent = [(kernel, kernel.send(RENDER)) for kernel in pair]
            assert [kernel.answer(message) for kernel, message in sent] == [(picture, "")] * 2


THOUSAND = """
import gc, json, os
import aolab

lab, scene, sizes = aolab.Lab((64, 36)), aolab.load("boxes"), ((64, 36), (48, 48))
resident = []
for i in range(1200):
    module = ("ssao", "s3ho", "ssdo")[i % 3]
    frame = lab.render(scene, module, size=sizes[i // 50 % 2], seed=i % 4, radius=(0.3, 0.5)[i % 2])
    frame.image
    if i % 200 == 199:
        gc.collect()
        with open("/proc/self/statm") as file:
            resident.append(int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 2**20)
print(json.dumps(resident))
"""


def test_a_thousand_frames_leave_memory_as_it_is(kernel):
    resident = json.loads(kernel.run(THOUSAND))  # MiB after 200 frames, 400, ...
    print(f"resident: {', '.join(f'{one:.0f}' for one in resident)} MiB")
    assert resident[-1] - resident[0] < 10  # 10 KiB a frame; a frame's textures alone are 600 KiB
