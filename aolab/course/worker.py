"""The process of one check: `python -m aolab.course.worker ORDER RESULT.json`."""

import json
import sys
import warnings
from dataclasses import asdict
from pathlib import Path

from ..errors import Error, Notice
from .check import check


def main(order: str, out: str) -> None:
    """Check the folder of the order, JSON with the arguments of `check`, and write the result."""
    warnings.simplefilter("ignore", Notice)
    try:
        result = check(**json.loads(order))
    except Error as error:
        sys.exit(str(error).replace("\n", " | "))
    Path(out).write_text(json.dumps(asdict(result)), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
