"""`aolab bench --quality`: measure error against time, and write the picture and its data."""

import json
from pathlib import Path
from typing import Any

from ..errors import Error, FileError
from ..output import check_writable, replacing
from ..studies.curve import Curve
from ..studies.quality import curve


def quality_command(scene: str, output: Path, **how: Any) -> Curve:
    """Measure, draw `output`, and write the data beside it as JSON; what can be refused is refused before the work."""
    if output.suffix.lower() != ".png":
        raise FileError(f"cannot write {output}: the picture is written as .png")
    data = output.with_suffix(".json")
    for path in (output, data):
        check_writable(path)
    try:
        from ..studies.quality_picture import draw
    except ImportError as error:
        raise Error(f"the picture needs matplotlib: pip install matplotlib ({error})") from error
    measured = curve(scene, **how)
    with replacing(output) as file:
        draw(measured).savefig(file, format="png")
    with replacing(data) as file:
        file.write((json.dumps(measured.to_dict(), indent=2) + "\n").encode())
    return measured
