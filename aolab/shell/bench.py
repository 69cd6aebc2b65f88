"""`aolab bench`."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from typer import Option

from . import options

if TYPE_CHECKING:
    from ..studies.curve import Curve


def bench(
    size: options.PixelSize = "1280x720",
    scene: Annotated[str, Option(help="The scene that is drawn.")] = "boxes",
    frames: Annotated[int, Option(metavar="N", min=3, help="Frames for each measurement.")] = 15,
    scaling: Annotated[
        bool, Option("--scaling", help="Measure how the time grows with pixels, taps and triangles.")
    ] = False,
    start: Annotated[
        bool, Option("--start", help="Measure the import, and the time from process start to a saved picture.")
    ] = False,
    quality: Annotated[
        str | None,
        Option(metavar="SCENE", help="Measure error against time: every module over a range of its settings."),
    ] = None,
    rays: options.Rays = 256,
    output: Annotated[
        Path, Option("-o", "--output", metavar="FILE.png", help="With --quality: the picture; .json beside it.")
    ] = Path("quality.png"),
    as_json: options.Json = False,
) -> None:
    """Measure the time of every pass of every module.

    Prints milliseconds: medians over repeated frames, and interquartile ranges. --quality traces rays and measures
    hundreds of settings: it takes tens of minutes without a GPU, and a bar shows the time that is left.
    """
    from ..studies import bench as measure
    from . import text

    if quality is not None:
        curve = measured_quality(quality, output, size=text.size(size), rays=rays, frames=frames)
        print(json.dumps(curve.to_dict(), indent=2) if as_json else f"{curve.table()}\n{output}")
        return
    if scaling:
        result = measure.scaling(text.size(size), frames)
    elif start:
        result = measure.start_up(frames)
    else:
        result = measure.frames(scene, text.size(size), frames)
    print(json.dumps(result, indent=2) if as_json else measure.table(result))


def measured_quality(scene: str, output: Path, **how: Any) -> "Curve":
    """Measure, draw `output`, and write the data beside it as JSON. Files and libraries are checked before the work."""
    from ..extras import need
    from ..output import check_writable, replacing
    from ..studies.quality import curve
    from .files import check_picture, write_json

    data = output.with_suffix(".json")
    check_picture(output)
    check_writable(data)
    need("pictures")
    from ..studies.quality_picture import draw

    measured = curve(scene, **how)
    with replacing(output) as file:
        draw(measured).savefig(file, format="png")
    write_json(data, measured.to_dict())
    return measured
