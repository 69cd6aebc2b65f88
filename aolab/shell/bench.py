"""`aolab bench`."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from typer import Option

from . import options

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..studies.curve import Curve
    from ..studies.peers import Race


def bench(
    size: options.PixelSize = "1280x720",
    scene: Annotated[str, Option(help="The scene that is drawn.")] = "boxes",
    frames: Annotated[int, Option(metavar="N", min=3, help="Frames for each measurement.")] = 15,
    scaling: Annotated[
        bool,
        Option("--scaling", help="Measure how the time grows with pixels, taps, triangles, lights."),
    ] = False,
    start: Annotated[
        bool, Option("--start", help="Measure the import, and the time from process start to a saved picture.")
    ] = False,
    quality: Annotated[
        str | None,
        Option(metavar="SCENE", help="Measure error against time: every module over a range of its settings."),
    ] = None,
    peers: Annotated[
        str | None,
        Option(metavar="SCENE", help="Race the ambient occlusion of VTK and Open3D, where they are installed."),
    ] = None,
    radius: Annotated[
        float | None, Option(metavar="UNITS", help="With --peers: the radius, in scene units. Default: by the scene.")
    ] = None,
    rays: options.Rays = 256,
    output: Annotated[
        Path,
        Option(
            "-o",
            "--output",
            metavar="FILE.png",
            help="With --quality, --scaling, --peers: the picture; .json beside it.",
        ),
    ] = Path("bench.png"),
    as_json: options.Json = False,
) -> None:
    """Measure the time of every pass of every module.

    Prints milliseconds: medians over repeated frames, and interquartile ranges. --quality traces rays and measures
    hundreds of settings: it takes tens of minutes without a GPU, and a bar shows the time that is left. --peers draws
    the same scene with other renderers, in turns, and compares all with the same rays: a minute or two.
    """
    from . import text

    if quality is not None or peers is not None:
        how = {"size": text.size(size), "rays": rays, "frames": frames}
        result = (
            measured_race(peers, output, radius=radius, **how)
            if quality is None
            else measured_quality(quality, output, **how)
        )
        print(json.dumps(result.to_dict(), indent=2) if as_json else f"{result.table()}\n{output}")
        return
    if scaling:
        found, lines = measured_scaling(output, text.size(size), frames)
        print(json.dumps(found, indent=2) if as_json else f"{lines}\n{output}")
        return
    from ..studies import bench as measure

    times = measure.start_up(frames) if start else measure.frames(scene, text.size(size), frames)
    print(json.dumps(times, indent=2) if as_json else measure.table(times))


def measured_quality(scene: str, output: Path, **how: Any) -> "Curve":
    """Measure the curve of error against time, draw `output`, and write the data beside it as JSON."""
    from ..studies.quality import curve

    _check(output)
    measured = curve(scene, **how)
    _write_curve(measured, measured.to_dict(), output)
    return measured


def measured_race(scene: str | None, output: Path, **how: Any) -> "Race":
    """Race the other renderers that are installed, draw `output`, and write the data beside it as JSON."""
    from ..studies.peers import race

    _check(output)
    measured = race(scene, **how)
    _write_curve(measured.curve, measured.to_dict(), output)
    return measured


def measured_scaling(output: Path, size: tuple[int, int], frames: int) -> tuple[dict[str, Any], str]:
    """Measure the growth of a frame's time, draw `output`, and write the data beside it. The data, and its table."""
    from ..studies.scaling import scaling, table

    _check(output)
    from ..studies.scaling_picture import draw

    measured = scaling(size, frames)
    _write(draw(measured), measured, output)
    return measured, table(measured)


def _check(output: Path) -> None:
    """Raise for files that cannot be written and libraries that are missing, before the work."""
    from ..extras import need
    from ..output import check_writable
    from .files import check_picture

    check_picture(output)
    check_writable(output.with_suffix(".json"))
    need("pictures")


def _write_curve(curve: "Curve", data: dict[str, Any], output: Path) -> None:
    from ..studies.quality_picture import draw

    _write(draw(curve), data, output)


def _write(figure: "Figure", data: dict[str, Any], output: Path) -> None:
    from ..output import replacing
    from .files import write_json

    with replacing(output) as file:
        figure.savefig(file, format="png")
    write_json(output.with_suffix(".json"), data)
