"""`aolab tune`: fit a module's parameters, and write them as a preset."""

import json
from pathlib import Path
from typing import Any

from ..output import check_writable, replacing
from ..studies.tune import tune
from ..studies.tuning import Tuning
from .job import typed


def tune_command(module: str, values: dict[str, Any], output: Path | None, **how: Any) -> Tuning:
    """Tune the module with these values, which may be text, and write the preset as JSON."""
    if output is not None:
        check_writable(output)
    tuning = tune(typed(module, values), **how)
    if output is not None:
        with replacing(output) as file:
            file.write((json.dumps(tuning.preset, indent=2) + "\n").encode())
    return tuning
