"""The installed wheel stands alone: it renders outside the checkout, from its own shaders and scenes."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

CHECKOUT = Path(__file__).parents[1]
SCRIPTS = "Scripts" if os.name == "nt" else "bin"
# variables that would lead the installed package, or pip, back to the checkout
LEADS_BACK = {"PYTHONPATH", "AOLAB_GLSL", "AOLAB_SCENES", "AOLAB_EXERCISES", "VIRTUAL_ENV"}


def run(*command: str | Path, cwd: Path) -> str:
    """Run in `cwd` without what leads back to the checkout; the output, or a failed test that shows it."""
    environment = {name: value for name, value in os.environ.items() if name not in LEADS_BACK}
    done = subprocess.run(
        command, cwd=cwd, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
    )
    assert done.returncode == 0, f"{' '.join(map(str, command))}\n{done.stdout}"
    return done.stdout


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The scripts' folder of a fresh environment that holds the wheel and its dependencies, nothing else."""
    outside = tmp_path_factory.mktemp("wheel")
    run(sys.executable, "-m", "build", "--wheel", "--outdir", outside, CHECKOUT, cwd=outside)
    (wheel,) = outside.glob("*.whl")
    run(sys.executable, "-m", "venv", outside / "env", cwd=outside)
    scripts = outside / "env" / SCRIPTS
    run(scripts / "python", "-m", "pip", "install", "--quiet", wheel, cwd=outside)
    return scripts


@pytest.mark.wheel
def test_the_installed_wheel_renders(installed: Path, tmp_path: Path) -> None:
    run(installed / "aolab", "render", "cornell", "--size", "64x48", "-o", "x.png", cwd=tmp_path)
    with Image.open(tmp_path / "x.png") as picture:
        pixels = np.asarray(picture.convert("RGB"))
    assert pixels.shape == (48, 64, 3)
    assert pixels.mean() > 10, "the picture is black"
    assert pixels.std() > 5, "the picture is a single colour"


@pytest.mark.wheel
def test_the_installed_wheel_traces_rays_and_measures_errors(installed: Path, tmp_path: Path) -> None:
    """Without any extra: Embree, FLIP and matplotlib come with the wheel."""
    run(installed / "aolab", "reference", "cornell", "--size", "32x24", "--rays", "4", cwd=tmp_path)
    compare = ("compare", "cornell", "--modules", "ssao", "--size", "32x24", "--rays", "4", "-o", "sheet.png")
    assert "flip" in run(installed / "aolab", *compare, cwd=tmp_path)
    with Image.open(tmp_path / "sheet.png") as sheet:
        assert sheet.width > 100


@pytest.mark.wheel
@pytest.mark.parametrize(
    ("folder", "source"), [("glsl", "glsl"), ("scenes", "scenes"), ("exercises", "examples/exercises")]
)
def test_the_installed_wheel_carries_its_own_files(installed: Path, tmp_path: Path, folder: str, source: str) -> None:
    script = (
        f"from aolab import paths; folder = paths.{folder}(); print(folder, *sorted(folder.rglob('*.*')), sep='\\n')"
    )
    place, *files = map(Path, run(installed / "python", "-c", script, cwd=tmp_path).splitlines())
    assert place.is_relative_to(installed.parent.resolve())
    here = {file.relative_to(CHECKOUT / source) for file in (CHECKOUT / source).rglob("*.*")}
    assert {file.relative_to(place) for file in files if "__pycache__" not in file.parts} == {
        file for file in here if "__pycache__" not in file.parts
    }
