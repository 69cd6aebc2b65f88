"""The shell's options, stated once for every command that takes them; None leaves what is said elsewhere."""

from pathlib import Path
from typing import Annotated

from typer import Argument, Option

Scene = Annotated[
    str | None,
    Argument(help="A scene's name, its parameters as in 'toasters?time=1.5', or a model file.", show_default=False),
]
Module = Annotated[str | None, Option(help="The method; see `aolab modules`. Default: ssao.")]
Set = Annotated[
    list[str] | None, Option("--set", metavar="KEY=VALUE", help="A parameter of the module; may be repeated.")
]
Occluders = Annotated[str | None, Option(metavar="KIND", help="What is tested for blocking.")]
Size = Annotated[str | None, Option(metavar="WxH", help="Pixels. Default: 1280x720.")]
Seed = Annotated[int | None, Option(help="Chooses the sample set. Default: 0.")]
Accumulate = Annotated[int | None, Option(metavar="K", help="Average K frames with different sample sets. Default: 1.")]
Eye = Annotated[str | None, Option(metavar="X,Y,Z", help="The camera's position.")]
Target = Annotated[str | None, Option(metavar="X,Y,Z", help="The point that the camera looks at.")]
Fov = Annotated[float | None, Option(metavar="DEGREES", help="Vertical field of view.")]
Exposure = Annotated[float | None, Option(help="Multiplies radiance before the tone map. Default: 1.")]
ToneMap = Annotated[str | None, Option(help="filmic or linear. Default: filmic.")]
Like = Annotated[Path | None, Option(metavar="FILE.png", help="Make this picture again; other options override.")]
Output = Annotated[Path, Option("-o", "--output", metavar="FILE.png", help="The picture to write.")]
Buffers = Annotated[Path | None, Option(metavar="FILE.npz", help="Write every buffer by name.")]
Stats = Annotated[Path | None, Option(metavar="FILE.json", help="Write parameters and timings of a warm frame.")]
Rays = Annotated[int, Option(help="Rays a pixel, even.")]
Radius = Annotated[float | None, Option(help="Reach of occlusion, in scene units. Default: the module's.")]
