"""The tests' shared parts: the order of files, the GL context, a lab, small scenes with known answers, real models."""

import os
import shutil
import stat
import subprocess
import sys
import textwrap
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from itertools import count
from pathlib import Path

import moderngl
import numpy as np
import pytest
import small_scenes

import aolab
from aolab import paths
from aolab.gl import context, texture
from aolab.gl.bindings import Bindings
from aolab.gl.program import Programs
from aolab.gl.texture import Pool
from aolab.modules.passes import Pass
from aolab.pipeline.pass_runner import PassRunner

os.environ.setdefault("PYGLET_HEADLESS", "1")  # pyrender imports pyglet, which otherwise needs X11
os.environ.setdefault("LP_NUM_THREADS", "1")  # threads of llvmpipe in each worker: the workers use the cores already

CHECKOUT = Path(__file__).parents[1]
PAPERS = CHECKOUT / "tests" / "papers"
# files whose slow tests start programs, kernels or clusters, or draw for many seconds: `make long`
LONG = (
    "test_readme", "test_bake", "test_interrupts", "test_notebooks", "test_claims", "test_reproduce", "test_sweep",
    "test_quality", "test_wheel", "test_jupyterlab", "test_otter", "test_grade", "test_measuring", "test_mitsuba",
    "test_exercises", "test_explorer", "test_explain", "test_against_truth", "test_pyrender_depth", "test_viewer",
    "test_peers", "test_streams", "test_lines_run", "test_blocks_run",
)  # fmt: skip


_folders = count()


@pytest.hookimpl(tryfirst=True)  # before pytest selects by marker
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark figures and slow tests by their place and fixtures; the wheel and files with many slow tests run first."""
    for item in items:
        if PAPERS in item.path.parents and item.path.stem not in {"test_reproduce", "test_claims"}:
            item.add_marker("figures")
        if {"python", "mitsuba"} & {*getattr(item, "fixturenames", ())}:  # fixtures that start a process
            item.add_marker("slow")
        if item.path.stem in LONG and item.get_closest_marker("slow"):
            item.add_marker("long")
    # the last file to start is then a short one, and the workers end together; the wheel waits for the package index
    slow = Counter(item.path for item in items if item.get_closest_marker("slow"))
    items.sort(key=lambda item: (item.get_closest_marker("wheel") is None, -slow[item.path]))


@pytest.fixture(scope="session", autouse=True)
def session_cache(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """A cache for fixtures that several tests share; each test itself has its own, `cache_folder`."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("AOLAB_CACHE", str(tmp_path_factory.mktemp("cache")))
        yield


@pytest.fixture(autouse=True)
def cache_folder(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A cache of the test's own: its results reach neither another test nor the user's cache."""
    folder = tmp_path_factory.mktemp(f"cache-{next(_folders)}", numbered=False)  # numbered reads all names each time
    monkeypatch.setenv("AOLAB_CACHE", str(folder))
    return folder / "references"


@pytest.fixture(scope="session")
def gl() -> moderngl.Context:
    """The process's context. Where none can be made the tests fail: nothing is skipped for want of a driver."""
    return context.get()


@pytest.fixture(scope="module")  # it has an event loop of its own, which must not outlive the tests of a file
def chromium() -> Iterator:
    """A headless Chromium of Playwright; without one, the test is skipped."""
    playwright = pytest.importorskip("playwright.sync_api")
    path = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if path is None:
        pytest.skip("no Chromium on this machine")
    with playwright.sync_playwright() as started:
        browser = started.chromium.launch(executable_path=path, args=["--no-sandbox", "--disable-gpu"])
        yield browser
        browser.close()


@pytest.fixture(scope="session")
def lab(gl: moderngl.Context) -> aolab.Lab:
    """One lab for all tests, so that each shader is compiled once."""
    return aolab.Lab((64, 48))


@pytest.fixture(scope="session")
def plane() -> aolab.Scene:
    """An unoccluded plane."""
    return small_scenes.plane()


@pytest.fixture(scope="session")
def wall() -> aolab.Scene:
    """A floor in front of a high wall, which stands in the plane x = 0."""
    return small_scenes.wall()


@pytest.fixture(scope="session")
def ball() -> aolab.Scene:
    """A sphere over a plane."""
    return small_scenes.ball()


@pytest.fixture(scope="session")
def boxes() -> aolab.Scene:
    """A floor and three boxes."""
    return small_scenes.boxes()


@pytest.fixture(scope="session")
def models() -> Path:
    """The folder of real models, which are not the project's: beside the checkout, or the test skips, visibly."""
    folder = CHECKOUT.parent / "shared" / "models"
    if not folder.is_dir():
        pytest.skip(f"no folder of real models at {folder}")
    return folder


@pytest.fixture(scope="session")
def glsl(gl: moderngl.Context) -> Callable[..., np.ndarray]:
    """Evaluates GLSL: `glsl("lib/space.glsl", "result.xyz = viewPosAt(x.xy, x.z, a);", x, a=(1, 2, 3, 4))`.

    Runs the statements once for each row of `x` (n, 4) and returns `result` (n, 4), both float32; keywords are vec4s.
    """
    runner = PassRunner(Programs(), Pool())

    def evaluate(
        include: str, statements: str, x: np.ndarray, orthographic: bool = False, **uniforms: Sequence[float]
    ) -> np.ndarray:
        x = np.asarray(x, np.float32)
        assert x.shape[1:] == (4,)
        declared = "".join(f"uniform vec4 {name};\n" for name in uniforms)
        shader = (
            f'#include "{include}"\nuniform sampler2D rows;\n{declared}out vec4 value;\nvoid main() {{\n'
            "vec4 x = texelFetch(rows, ivec2(gl_FragCoord.xy), 0), result = vec4(0.0);\n"
            f"{statements}\nvalue = result;\n}}\n"
        )
        size = len(x), 1
        rows = {"rows": texture.make(size, "RGBA32F", x.tobytes())}
        given = Bindings("the test", rows, uniforms, {"orthographic": orthographic})
        made = runner.run(Pass("glsl", shader, {"value": "RGBA32F"}), [given], size)
        return texture.read(made["value"])[0]

    return evaluate


@pytest.fixture
def python(tmp_path: Path) -> Callable[..., subprocess.CompletedProcess[str]]:
    """Runs Python text in a process of its own: `python("import aolab", AOLAB_DEVICE="9")`; None unsets a variable.

    For what a test must not do to its own process: fork it, take its memory, break its driver.
    """

    def run(text: str, **variables: str | None) -> subprocess.CompletedProcess[str]:
        changed = {name: value for name, value in variables.items() if value is not None}
        kept = {name: value for name, value in os.environ.items() if name not in variables}
        command = [sys.executable, "-c", textwrap.dedent(text)]
        return subprocess.run(
            command, cwd=tmp_path, env=kept | changed, capture_output=True, text=True, timeout=120, check=False
        )

    return run


@pytest.fixture
def shaders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A copy of glsl/ to edit, which labs made in this test compile."""
    folder = tmp_path / "glsl"
    shutil.copytree(paths.glsl(), folder)
    monkeypatch.setenv("AOLAB_GLSL", str(folder))
    paths._find.cache_clear()
    yield folder
    monkeypatch.undo()
    paths._find.cache_clear()


@pytest.fixture
def full_device(tmp_path: Path) -> Path:
    """A device that is always full. Root gets one of its own: faulty code must not replace `/dev/full` by a file."""
    if os.geteuid() != 0:
        return Path("/dev/full")
    path = tmp_path / "full"
    try:
        os.mknod(path, 0o666 | stat.S_IFCHR, os.makedev(1, 7))
        path.write_text("x")
    except PermissionError:
        pytest.skip("root may not make devices here")
    except OSError:  # No space left on device
        pass
    return path
