"""Tab completes commands, scenes, modules, occluder kinds, tone maps and papers."""

import os
import subprocess
import sys

import pytest

from aolab.loading import scene_names
from aolab.modules import MODULES
from aolab.papers import PAPERS
from aolab.shell import completion

LINES = {
    "aolab re": ["render", "reference", "reproduce"],
    "aolab render box": ["boxes"],
    "aolab compare boxes --rel": ["--relight"],
    "aolab render --module ssa": ["ssao"],
}


@pytest.mark.parametrize("line", LINES)
def test_bash_gets_the_words_that_fit(line):
    asked = {"_AOLAB_COMPLETE": "complete_bash", "COMP_WORDS": line, "COMP_CWORD": str(line.count(" "))}
    command = [sys.executable, "-m", "aolab.shell.cli"]
    done = subprocess.run(command, env=os.environ | asked, capture_output=True, text=True, timeout=60, check=True)
    assert done.stdout.split() == LINES[line]


def test_every_name_is_offered():
    assert completion.scenes("") == scene_names()
    assert completion.modules("") == list(MODULES)
    assert completion.papers("") == list(PAPERS)
    assert {"depth", "layers", "views"} <= set(completion.occluders(""))
    assert completion.tone_maps("l") == ["linear"]
