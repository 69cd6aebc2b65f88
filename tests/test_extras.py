"""Libraries that are not installed are named with their purpose and the command for this environment."""

import importlib.util
import shutil
import sys
import types

import pytest

from aolab import ParameterError, extras


@pytest.fixture(autouse=True)
def no_notebook(monkeypatch):
    """Tests of notebooks import ipykernel into this process; the commands then suit a notebook."""
    monkeypatch.delitem(sys.modules, "ipykernel", raising=False)


def test_the_command_runs_pip_of_this_python(monkeypatch):
    monkeypatch.setattr(sys, "executable", "/a folder/python")
    assert extras.install_command("optuna") == "'/a folder/python' -m pip install optuna"


def test_the_command_suits_the_environment(monkeypatch, tmp_path):
    monkeypatch.setattr(sys, "executable", "/env/bin/python")
    with monkeypatch.context() as patch:
        patch.setitem(sys.modules, "ipykernel", types.ModuleType("ipykernel"))
        assert extras.install_command("optuna") == "%pip install optuna"
    with monkeypatch.context() as patch:
        (tmp_path / "pipx_metadata.json").touch()
        patch.setattr(sys, "prefix", str(tmp_path))
        assert extras.install_command("optuna") == "pipx inject aolab optuna"
    with monkeypatch.context() as patch:  # an environment that uv made has no pip
        patch.setattr(importlib.util, "find_spec", lambda name: None)
        patch.setattr(shutil, "which", lambda name: "/bin/uv")
        assert extras.install_command("optuna") == "uv pip install --python /env/bin/python optuna"


def test_a_missing_library_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "flip_evaluator", None)
    message = r"the error measure FLIP needs flip-evaluator: .* install flip-evaluator, or nothing \("
    with pytest.raises(ParameterError, match=message):
        extras.need("flip", ", or nothing")


def test_an_installed_library_is_imported():
    assert extras.is_installed("pictures")
    assert extras.need("pictures").__name__ == "matplotlib"
