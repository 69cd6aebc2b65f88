"""The package's folders import in one direction, and no two files import each other in a circle."""

import ast
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

import aolab

PACKAGE = Path(aolab.__file__).parent
# a folder imports from itself, from the folders below it in this list, and from the files at the top
ORDER = ["shell", "papers", "notebook", "course", "studies", "measures", "baking", "truth", "pipeline", "modules", "gl",
         "loading", "scene", "pictures", "maths", ""]  # fmt: skip
FILES = {str(path.relative_to(PACKAGE)): path for path in sorted(PACKAGE.rglob("*.py"))}


def imported(path: Path) -> set[Path]:
    """The package's files that a file names in an import, at its top or in a function."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and node.level:
            folder = path.parents[node.level - 1].joinpath(*(node.module or "").split("."))
            targets = [folder, *(folder / alias.name for alias in node.names)]
            candidates = [file for target in targets for file in (target.with_suffix(".py"), target / "__init__.py")]
            found |= {file for file in candidates if file.is_file() and file != path}
    return found


@pytest.mark.parametrize("name", [name for name in FILES if name != "__init__.py"])  # the face names all folders
def test_a_file_imports_from_its_folder_and_from_those_below(name):
    place = Path(name).parts[0] if "/" in name else ""
    for file in imported(FILES[name]):
        parts = file.relative_to(PACKAGE).parts
        there = parts[0] if len(parts) > 1 else ""
        assert ORDER.index(there) >= ORDER.index(place), f"{name} imports {'/'.join(parts)}, which stands above it"


def test_no_files_import_each_other_in_a_circle():
    graph = {path: {file for file in imported(path) if file.name != "__init__.py"} for path in FILES.values()}
    list(TopologicalSorter(graph).static_order())  # raises CycleError, which names the circle


def test_every_folder_has_a_place_in_the_order():
    assert {path.name for path in PACKAGE.iterdir() if (path / "__init__.py").is_file()} == {*ORDER} - {""}
