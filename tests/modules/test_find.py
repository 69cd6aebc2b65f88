"""Modules by name, file, class and instance; parameters as text; shaders in files of one's own."""

import time
from pathlib import Path

import numpy as np
import pytest

import aolab
from aolab import paths
from aolab.errors import FileError, ParameterError, ShaderError
from aolab.modules import MODULES, SSAO, SSDO, find

STUDENT = """
import aolab


class Mine(aolab.Module):
    shader = {shader}
    level: float = aolab.parameter(0.5, "The visibility.", ge=0, le=1)
"""
SHADER = """#include "helper.glsl"
uniform float level;
out float visibility;
void main() { visibility = half_of(level); }
"""
HELPER = "float half_of(float x) { return 0.5 * x; }\n"


@pytest.fixture
def folder(tmp_path) -> Path:
    """A folder with a module, its shader and a file that the shader includes; it is not the working directory."""
    (tmp_path / "student.py").write_text(STUDENT.format(shader="'mine.frag'"))
    (tmp_path / "mine.frag").write_text(SHADER)
    (tmp_path / "helper.glsl").write_text(HELPER)
    return tmp_path


def test_a_name_with_parameters():
    assert find("ssao?directions=32&radius=0.5&filter=none", MODULES) == SSAO(directions=32, radius=0.5, filter="none")
    assert find("ssao?steps=2", MODULES, steps=3, bias="0.5") == SSAO(steps=3, bias=0.5)
    assert find("ssdo", MODULES, bounces="1") == SSDO(bounces=1)
    assert find("s3ho?indirect=true", MODULES).indirect is True  # pyright: ignore[reportAttributeAccessIssue]


def test_a_class_and_an_instance():
    assert find(SSAO, MODULES, steps=2) == SSAO(steps=2)
    module = SSAO(steps=2)
    assert find(module, MODULES) is module
    assert find(module, MODULES, bias=0.5) == SSAO(steps=2, bias=0.5)


@pytest.mark.parametrize("thing", [None, 3, dict, ["ssao"], Path("ssao")])
def test_other_things_are_no_modules(thing):
    with pytest.raises(ParameterError, match=r"module = .* is not a module: give a name \(none, ssao"):
        aolab.render("boxes", thing)


@pytest.mark.parametrize("shader", ["'mine.frag'", "__import__('pathlib').Path('mine.frag')"])
def test_a_shader_is_looked_up_beside_its_class(lab, boxes, folder, shader):
    (folder / "student.py").write_text(STUDENT.format(shader=shader))
    frame = lab.render(boxes, f"{folder}/student.py:Mine", level=0.5)
    assert np.nanmax(np.abs(frame["visibility"] - 0.25)) < 1e-3
    assert frame.info["module"] == f"{folder}/student.py:Mine"


def test_a_shader_by_an_absolute_path_and_by_one_of_the_working_directory(lab, boxes, folder, monkeypatch):
    monkeypatch.chdir(folder)
    for path in (folder / "mine.frag", str(folder / "mine.frag"), Path("mine.frag"), "mine.frag", "./mine.frag"):

        class Mine(aolab.Module):
            shader = path
            level: float = 0.5

        assert np.nanmax(np.abs(lab.render(boxes, Mine)["visibility"] - 0.25)) < 1e-3


def test_a_name_of_a_built_in_shader_stays_one(tmp_path, monkeypatch, lab, boxes):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "none.frag").write_text("out float visibility;\nvoid main() { visibility = 0.0; }\n")

    class Built(aolab.Module):
        shader = "none.frag"

    class Own(aolab.Module):
        shader = Path("none.frag")

    assert np.nanmax(lab.render(boxes, Built)["visibility"]) == 1
    assert np.nanmax(lab.render(boxes, Own)["visibility"]) == 0


@pytest.mark.parametrize("watch", [False, True])
def test_an_edit_of_a_file_is_seen(boxes, folder, watch):
    """Of the shader, of a file that it includes, and of the Python file."""
    name = f"{folder}/student.py"
    lab = aolab.Lab((16, 9), watch=watch)

    def level(path: Path, text: str) -> float:
        time.sleep(0.01)  # file systems have coarse clocks
        path.write_text(text)
        return float(np.nanmax(lab.render(boxes, name)["visibility"]))

    assert level(folder / "mine.frag", SHADER) == pytest.approx(0.25, abs=1e-3)
    assert level(folder / "helper.glsl", HELPER.replace("0.5", "0.25")) == pytest.approx(0.125, abs=1e-3)
    assert level(folder / "mine.frag", SHADER.replace("half_of(level)", "level")) == pytest.approx(0.5, abs=1e-3)
    edited = STUDENT.format(shader="'mine.frag'").replace("0.5", "1.0")
    assert level(folder / "student.py", edited) == pytest.approx(1, abs=1e-3)


def test_an_edit_that_does_not_compile_is_told_in_each_frame_until_it_is_mended(boxes, folder):
    """As cells of a notebook are run: the old result must not stand for the edited shader."""

    class Mine(aolab.Module):
        shader = folder / "mine.frag"
        level: float = 0.5

    def written(text: str) -> None:
        time.sleep(0.01)  # file systems have coarse clocks
        (folder / "mine.frag").write_text(text)

    lab = aolab.Lab((16, 9))
    assert np.nanmax(lab.render(boxes, Mine)["visibility"]) == pytest.approx(0.25, abs=1e-3)
    written(SHADER.replace("half_of(level)", "half_of(levl)"))
    for _ in range(2):
        with pytest.raises(aolab.ShaderError, match="levl"):
            lab.render(boxes, Mine)
    assert np.nanmax(lab.render(boxes, "none")["visibility"]) == 1  # other modules go on
    (folder / "mine.frag").unlink()
    with pytest.raises(aolab.ShaderError, match=r"no file .*mine.frag"):
        lab.render(boxes, Mine)
    written(SHADER.replace("half_of(level)", "half_of(level) * share").replace("void", "const float share;\nvoid"))
    with pytest.raises(aolab.ShaderError, match="share"):
        lab.render(boxes, Mine)

    class Mine(Mine):  # the cell of the class is run again, with the new parameter
        share: float = 0.5

    assert np.nanmax(lab.render(boxes, Mine)["visibility"]) == pytest.approx(0.125, abs=1e-3)


def test_a_class_of_a_file_stays_the_same_while_the_file_does(folder):
    first = find(f"{folder}/student.py:Mine", MODULES)
    assert type(find(f"{folder}/student.py", MODULES)) is type(first)
    assert type(find(f"{folder}/mine.frag:ssao", MODULES)) is type(find(f"{folder}/mine.frag:ssao", MODULES))


def test_a_shader_with_the_declaration_of_another_module(lab, boxes, folder):
    (folder / "taps.frag").write_text(
        "const int directions;\nout float visibility;\nvoid main() { visibility = float(directions) / 16.0; }\n"
    )
    module = find(f"{folder}/taps.frag:ssao?directions=4", MODULES)
    assert isinstance(module, SSAO)
    assert np.nanmax(np.abs(lab.render(boxes, module)["visibility"] - 0.25)) < 1e-3
    nested = find(f"{folder}/mine.frag:{folder}/student.py:Mine", MODULES, level=0.1)
    assert np.nanmax(np.abs(lab.render(boxes, nested)["visibility"] - 0.05)) < 1e-3


FILES = {
    "bad.py": "import aolab\nx = 1\nfoo()\n",
    "quits.py": "import sys\nsys.exit(3)\n",
    "syntax.py": "def f(:\n",
    "empty.py": "import aolab\nfrom aolab import SSAO\n",
    "two.py": "import aolab\nclass A(aolab.Module): pass\nclass B(aolab.SSAO): pass\n",
    "broken.frag": '#include "helper.glsl"\nout float visibility;\nvoid main() { oops; }\n',
    "include.frag": '\n#include "helpr.glsl"\nout float visibility;\nvoid main() {}\n',
    "cycle.frag": '#include "cycle.glsl"\n',
    "cycle.glsl": '#include "cycle.frag"\n',
}


@pytest.mark.parametrize(
    ("name", "error", "message"),
    [
        ("bad.py", FileError, r"bad\.py:3: NameError: name 'foo' is not defined"),
        ("quits.py", FileError, r"quits\.py:2: SystemExit: 3"),
        ("syntax.py", FileError, r"syntax\.py: SyntaxError: .*line 1"),
        ("empty.py", ParameterError, r"empty\.py defines 0 modules; write .*empty\.py:CLASS \(none\)"),
        ("two.py", ParameterError, r"two\.py defines 2 modules; write .*two\.py:CLASS \(A, B\)"),
        ("two.py:C", ParameterError, r"two\.py has no module 'C'; known: A, B"),
        ("students.py", FileError, r"no file .*students\.py; did you mean '.*student\.py'"),
        ("mine.frag", ParameterError, r"mine\.frag' is a shader: write .*mine\.frag:MODULE"),
        ("mine.frag:ssoa", ParameterError, r"no module 'ssoa'; did you mean 'ssao'"),
        ("min.frag:ssao", FileError, r"no file .*min\.frag; did you mean '.*mine\.frag'"),
        ("broken.frag:ssao", ShaderError, r"broken\.frag:3: .*oops"),
        ("include.frag:ssao", ShaderError, r"include\.frag:2: no file 'helpr\.glsl'; did you mean 'helper\.glsl'"),
        ("cycle.frag:ssao", ShaderError, r"include cycle: cycle\.frag -> cycle\.glsl -> cycle\.frag"),
    ],
)
def test_a_mistake_is_named_with_its_place(lab, boxes, folder, name, error, message):
    for file, text in FILES.items():
        (folder / file).write_text(text)
    with pytest.raises(error, match=message):
        lab.render(boxes, f"{folder}/{name}")


def test_a_mark_of_byte_order_is_no_part_of_a_shader(lab, plane, tmp_path):
    """Some editors on Windows write one."""
    text = (paths.glsl() / "ssao.frag").read_bytes()
    (tmp_path / "marked.frag").write_bytes(b"\xef\xbb\xbf" + text)
    frame = lab.render(plane, f"{tmp_path}/marked.frag:ssao")
    np.testing.assert_array_equal(frame["visibility"], lab.render(plane, "ssao")["visibility"])


def test_a_folder_is_no_shader(tmp_path):
    (tmp_path / "folder.frag").mkdir()
    with pytest.raises(FileError, match=r"folder\.frag is no file; name the shader"):
        find(f"{tmp_path}/folder.frag:ssao", MODULES)
