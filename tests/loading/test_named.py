"""The scenes of a `scenes/` folder, here one of our own."""

import subprocess
import sys
from pathlib import Path

import pytest

import aolab
from aolab import paths
from aolab.errors import FileError, ParameterError, SceneError
from aolab.loading import describe_scene, scene_names

TOASTERS = '''
"""Of the module."""
import functools
import numpy as np
import aolab
from aolab.scene.mesh import Mesh
from aolab.scene.scene import Instance, Scene

@functools.cache
def triangle():
    return Mesh(np.eye(3), np.array([[0, 1, 2]]))

def toasters(time: float = 0.0, detail: int = 1, lit=True, at: tuple[float, ...] = (0.0, 0.0), kind="plain",
             seed: int | None = None):
    """Toasters that march.

    More.
    """
    pose = np.eye(4)
    pose[:2, 3] = at
    toasters.called = dict(time=time, detail=detail, lit=lit, at=at, kind=kind, seed=seed)
    if kind == "burnt":
        raise ZeroDivisionError("too hot")
    return 3 if kind == "wrong" else Scene(tuple(Instance(triangle(), pose) for _ in range(detail)))
'''


@pytest.fixture
def scenes(tmp_path, monkeypatch):
    """A folder of scenes with `toasters` in it."""
    (tmp_path / "toasters.py").write_text(TOASTERS)
    (tmp_path / "_parts.py").write_text("")
    (tmp_path / "box.py").write_text("from aolab.scene.mesh import Mesh\ndef box():\n    pass\n")
    monkeypatch.setenv("AOLAB_SCENES", str(tmp_path))
    paths._find.cache_clear()
    yield tmp_path
    paths._find.cache_clear()


@pytest.mark.usefixtures("scenes")
class TestNamed:
    def test_by_name(self):
        scene = aolab.load("toasters")
        assert (scene.name, scene.source, scene.triangles) == ("toasters", "toasters", 1)

    def test_query_and_keywords_are_the_same(self):
        query, keywords = aolab.load("toasters?time=1.5&detail=2"), aolab.load("toasters", time=1.5, detail=2)
        assert query.source == keywords.source == "toasters?time=1.5&detail=2"
        assert query.triangles == keywords.triangles == 2

    def test_source_is_canonical_and_makes_the_scene_again(self):
        scene = aolab.load("toasters?kind=a%26b", at=(1, -2.5e-7), lit=False, time=0)
        assert scene.source == "toasters?lit=false&at=1.0,-2.5e-07&kind=a%26b"
        again = aolab.load(scene.source)
        assert again.source == scene.source
        assert again.bounds.tolist() == scene.bounds.tolist()

    @pytest.mark.parametrize(
        ("query", "name", "value"),
        [("time=2", "time", 2.0), ("detail=3", "detail", 3), ("lit=no", "lit", False), ("lit=1", "lit", True),
         ("at=1,2", "at", (1.0, 2.0)), ("kind=7", "kind", "7"), ("seed=4", "seed", 4), ("time=1e+1", "time", 10.0)],
    )  # fmt: skip
    def test_values_are_converted_by_annotation_or_default(self, query, name, value):
        from aolab.loading.named import _function

        aolab.load(f"toasters?{query}")
        called = _function("toasters").called[name]
        assert called == value
        assert type(called) is type(value)

    @pytest.mark.parametrize(
        "query", ["time=soon", "time=nan", "time=inf", "detail=1.5", "lit=perhaps", "at=1,x", "detail=", "seed=many"]
    )
    def test_values_of_another_type(self, query):
        key, _, value = query.partition("=")
        with pytest.raises(
            ParameterError, match=rf"scene 'toasters': {key} = '{value}' is not a \w+ \(parameters: time"
        ):
            aolab.load(f"toasters?{query}")

    @pytest.mark.parametrize("given", [{"time": None}, {"detail": 1.5}, {"detail": True}, {"lit": 2}, {"kind": 5}])
    def test_keywords_of_another_type(self, given):
        with pytest.raises(ParameterError, match="is not a"):
            aolab.load("toasters", **given)

    def test_unknown_parameter(self):
        with pytest.raises(ParameterError, match=r"no parameter 'tme'; did you mean 'time'\?.*time=0\.0, detail=1"):
            aolab.load("toasters?tme=1")
        with pytest.raises(ParameterError, match="no parameter 'size'; known: at, detail"):
            aolab.load("toasters", size=1)
        with pytest.raises(ParameterError, match="it takes no parameters"):
            aolab.load("box", size=1)

    def test_parameter_given_twice(self):
        with pytest.raises(ParameterError, match="'time' is given twice"):
            aolab.load("toasters?time=1", time=2)

    def test_half_a_query(self):
        with pytest.raises(ParameterError, match="'time' is not key=value"):
            aolab.load("toasters?time")

    def test_unknown_scene(self):
        with pytest.raises(
            FileError, match=r"no scene 'toaster' in .*; did you mean 'toasters'\? \(known: box, toasters"
        ):
            aolab.load("toaster")

    def test_names(self):
        assert scene_names() == ["box", "toasters"]

    def test_description(self):
        described = describe_scene("toasters")
        assert described.summary == "Of the module."
        assert described.parameters["at"] == (0.0, 0.0)
        assert list(described.parameters) == ["time", "detail", "lit", "at", "kind", "seed"]

    def test_description_of_a_file_without_docstring(self, scenes):
        (scenes / "toasters.py").write_text(TOASTERS.replace('"""Of the module."""', ""))
        assert describe_scene("toasters").summary == "Toasters that march."

    def test_meshes_that_a_scene_keeps_are_shared_between_calls(self):
        first, second = aolab.load("toasters"), aolab.load("toasters?time=1")
        assert first.instances[0].mesh is second.instances[0].mesh

    def test_an_edited_scene_is_read_again(self, scenes):
        aolab.load("toasters")
        (scenes / "toasters.py").write_text(TOASTERS.replace("detail: int = 1", "detail: int = 5"))
        assert aolab.load("toasters").triangles == 5

    def test_a_scene_that_fails_names_itself_and_keeps_the_cause(self):
        with pytest.raises(SceneError, match="scene 'toasters' failed: ZeroDivisionError: too hot") as caught:
            aolab.load("toasters?kind=burnt")
        assert isinstance(caught.value.__cause__, ZeroDivisionError)

    def test_a_scene_that_returns_something_else(self):
        with pytest.raises(SceneError, match="scene 'toasters' returned a int"):
            aolab.load("toasters?kind=wrong")

    def test_a_scene_file_with_an_error(self, scenes):
        (scenes / "broken.py").write_text("def broken(:\n")
        with pytest.raises(FileError, match=r"scene 'broken' \(.*broken\.py\) cannot be imported: SyntaxError"):
            aolab.load("broken")
        (scenes / "nothing.py").write_text("")
        with pytest.raises(FileError, match=r"defines no function nothing\(\)"):
            aolab.load("nothing")


def test_importing_the_loader_imports_nothing_heavy():
    code = "import sys, aolab.loading; print([m for m in ('trimesh', 'scipy', 'PIL', 'moderngl') if m in sys.modules])"
    root = Path(aolab.__file__).parents[1]
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=root)
    assert done.stdout.strip() == "[]"
