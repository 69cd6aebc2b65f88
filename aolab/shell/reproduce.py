"""`aolab reproduce`."""

import json
from pathlib import Path
from typing import Annotated

from typer import Argument, Option

from ..papers import PAPERS
from . import completion, options


def reproduce(
    paper: Annotated[
        str,
        Argument(
            metavar="PAPER", help=f"The paper, by its method: {', '.join(PAPERS)}.", autocompletion=completion.papers
        ),
    ],
    figure: Annotated[
        str | None,
        Argument(metavar="FIGURE", help="A figure or table, as in fig7 or table1. Default: all.", show_default=False),
    ] = None,
    folder: Annotated[
        Path, Option("-o", "--output", metavar="DIR", help="The folder for FIGURE.png and FIGURE.json.")
    ] = Path("."),
    size: Annotated[
        str | None, Option(metavar="WxH", help="Width and height of a picture in pixels. Default: each figure's own.")
    ] = None,
    as_json: options.Json = False,
) -> None:
    """Draw a paper's figures and tables, and test its claims.

    A line for each figure states whether the numbers support the claim of the paper. All figures of a paper take
    minutes without a GPU; a bar shows the time that is left.
    """
    from ..papers.reproduce import figures
    from ..papers.reproduce import reproduce as draw
    from ..progress import progress_bar, write_line
    from . import text

    found = []
    with progress_bar(paper, len(figures(paper, figure)), " figures") as bar:
        for name, content in draw(paper, figure, folder, text.size(size) if size else None):
            found.append(content)
            bar.update()
            if not as_json:
                write_line(f"{folder / name}.png: {content['claim']}. {content['verdict']}")
    if as_json:
        print(json.dumps(found, indent=2))
