"""Every notebook of examples/notebooks runs from top to bottom, at a small size."""

import os
import re
from pathlib import Path

import nbclient
import nbformat
import pytest

pytestmark = pytest.mark.slow

CHECKOUT = Path(__file__).parents[2]
NOTEBOOKS = sorted((CHECKOUT / "examples" / "notebooks").glob("*.ipynb"))
SMALL = "size = (96, 54)"


@pytest.mark.parametrize("path", NOTEBOOKS, ids=[path.stem for path in NOTEBOOKS])
def test_a_notebook_runs(path, tmp_path, monkeypatch):
    notebook = nbformat.read(path, 4)
    changed = 0
    for cell in notebook.cells:
        cell.source, count = re.subn(r"^size = \(\d+, \d+\)$", SMALL, cell.source, flags=re.MULTILINE)
        changed += count
    assert changed == 1, "each notebook sets `size` once"
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(CHECKOUT), os.environ.get("PYTHONPATH", "")]))
    client = nbclient.NotebookClient(notebook, timeout=600, resources={"metadata": {"path": str(tmp_path)}})
    client.execute()  # raises CellExecutionError for the first cell that raises
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    told = [output for output in outputs if output.output_type == "stream" and output.name == "stderr"]
    assert not [output.text for output in told if "Traceback" in output.text]
    assert any("image/png" in output.get("data", {}) for output in outputs), "a notebook shows a picture"


def test_there_are_five_and_they_carry_no_outputs():
    assert len(NOTEBOOKS) == 5
    for path in NOTEBOOKS:
        for cell in nbformat.read(path, 4).cells:
            assert not cell.get("outputs"), f"{path.name}: clear its outputs before a commit"
