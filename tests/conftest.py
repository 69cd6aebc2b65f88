"""What the tests share: the GL context, a lab, small scenes with known answers, real models."""

from pathlib import Path

import moderngl
import pytest
import small_scenes

import aolab
from aolab.gl import context

CHECKOUT = Path(__file__).parents[1]


@pytest.fixture(scope="session")
def gl() -> moderngl.Context:
    """The process's context. Where none can be made the tests fail: nothing is skipped for want of a driver."""
    return context.get()


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
