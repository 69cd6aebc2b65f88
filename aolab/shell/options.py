"""Options that several commands take. None means: not given."""

from pathlib import Path
from typing import Annotated

from typer import Argument, Option

from . import completion

Scene = Annotated[
    str | None,
    Argument(
        metavar="SCENE",
        help="A scene by name, with parameters as in 'toasters?time=1.5', or a model file.",
        show_default=False,
        autocompletion=completion.scenes,
    ),
]
Module = Annotated[
    str | None,
    Option(
        metavar="NAME",
        help="The method: a name of `aolab modules`, or FILE.py:CLASS, a module of your own. Default: ssao.",
        autocompletion=completion.modules,
    ),
]
Shader = Annotated[
    Path | None, Option(metavar="FILE.frag", help="A fragment shader of your own in place of the module's.")
]
LikeModule = Annotated[
    str | None,
    Option(
        metavar="NAME",
        help="With --shader: the module whose parameters and outputs the shader has. Default: --module.",
        autocompletion=completion.modules,
    ),
]
Set = Annotated[
    list[str] | None, Option("--set", metavar="KEY=VALUE", help="A parameter of the module. May be given repeatedly.")
]
Occluders = Annotated[
    str | None,
    Option(
        metavar="KIND",
        help="The surfaces that can block: those in the depth buffer, in peeled layers, or in further views. "
        "Default: depth.",
        autocompletion=completion.occluders,
    ),
]
Size = Annotated[str | None, Option(metavar="WxH", help="Width and height in pixels. Default: 1280x720.")]
Seed = Annotated[int | None, Option(metavar="N", help="Number of the set of random samples. Default: 0.")]
Accumulate = Annotated[
    int | None, Option(metavar="K", help="Average K frames, at most 16384, each with other samples. Default: 1.")
]
Eye = Annotated[str | None, Option(metavar="X,Y,Z", help="Position of the camera. Default: the scene's.")]
Target = Annotated[str | None, Option(metavar="X,Y,Z", help="Point at which the camera looks. Default: the scene's.")]
Up = Annotated[str | None, Option(metavar="X,Y,Z", help="Direction that is upwards in the picture. Default: 0,1,0.")]
UpAxis = Annotated[
    str | None,
    Option(metavar="y|z", help="The axis of a model file that points up, as in scans; also 'scan.ply?up_axis=z'."),
]
Fov = Annotated[float | None, Option(metavar="DEGREES", help="Vertical field of view. Default: the scene's.")]
Exposure = Annotated[float | None, Option(metavar="FACTOR", help="Factor on radiance before the tone map. Default: 1.")]
ToneMap = Annotated[
    str | None,
    Option(metavar="NAME", help="Tone map: filmic or linear. Default: filmic.", autocompletion=completion.tone_maps),
]
Like = Annotated[
    Path | None,
    Option(metavar="FILE.png", help="Repeat a picture that aolab wrote. Other options override its settings."),
]
Output = Annotated[Path, Option("-o", "--output", metavar="FILE.png", help="The picture to write.")]
Buffer = Annotated[
    str | None,
    Option(
        metavar="NAME",
        help="The buffer that the picture shows, as in visibility; its scale is printed. Default: image.",
    ),
]
Buffers = Annotated[
    Path | None,
    Option(metavar="FILE", help="Write every buffer by name, as .npz (NumPy) or .exr (a layer for each buffer)."),
]
Stats = Annotated[
    Path | None,
    Option(metavar="FILE.json", help="Write the parameters, and the milliseconds of each pass in a second frame."),
]
Rays = Annotated[int, Option(metavar="N", help="Rays for each pixel, an even number.")]
Radius = Annotated[
    float | None, Option(metavar="R", help="Reach of occlusion in scene units, in place of the module's own.")
]
PixelSize = Annotated[str, Option(metavar="WxH", help="Width and height in pixels.")]
Json = Annotated[bool, Option("--json", help="Print JSON, for programs.")]
