"""The shell: `aolab render|modules|scenes|bench|reproduce|doctor`. Errors are one line on stderr and exit code 2."""

import json
import sys
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..errors import Error, Notice, ParameterError
from ..papers import PAPERS
from . import options

if TYPE_CHECKING:
    from .job import Job

app = typer.Typer(
    name="aolab",
    help="A laboratory for ambient lighting in image space.",
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)
Json = Annotated[bool, typer.Option("--json", help="For programs: print JSON.")]


def main() -> None:
    """Entry point: like `app()`, with our own errors told in one line (`--debug` shows where they came from)."""
    debug = "--debug" in sys.argv
    arguments = [argument for argument in sys.argv[1:] if argument != "--debug"] or ["--help"]
    warnings.simplefilter("always", Notice)
    warnings.showwarning = _show_notice
    try:
        sys.exit(app(arguments, prog_name="aolab", standalone_mode=False))
    except KeyboardInterrupt:
        sys.exit(130)
    except Exception as error:
        # typer's own errors of usage know how to say themselves; where they live has moved between its versions
        tell = getattr(error, "format_message", None)
        if debug or not (tell or isinstance(error, Error)):
            raise
        lines = (tell() if tell else str(error)).splitlines()
        print("aolab:", " | ".join(line.strip() for line in lines if line.strip()), file=sys.stderr)
        sys.exit(2)


def _show_notice(message: Any, category: type[Warning], filename: str, lineno: int, *_: Any) -> None:
    kind = "note" if issubclass(category, Notice) else f"{filename}:{lineno}: {category.__name__}"
    print(f"aolab: {kind}: {message}", file=sys.stderr)


@app.command()
def render(
    scene: options.Scene = None,
    module: options.Module = None,
    set_: options.Set = None,
    occluders: options.Occluders = None,
    size: options.Size = None,
    seed: options.Seed = None,
    accumulate: options.Accumulate = None,
    eye: options.Eye = None,
    target: options.Target = None,
    fov: options.Fov = None,
    exposure: options.Exposure = None,
    tone_map: options.ToneMap = None,
    like: options.Like = None,
    output: options.Output = Path("out.png"),
    buffers: options.Buffers = None,
    stats: options.Stats = None,
) -> None:
    """Render SCENE and write the picture."""
    job = _job(scene, like, module, set_, occluders, (eye, target, fov))
    job.choose(size=size, seed=seed, accumulate=accumulate, exposure=exposure, tone_map=tone_map)
    job.render(output, buffers, stats)
    print(output)


@app.command()
def reference(
    scene: options.Scene = None,
    module: options.Module = None,
    set_: options.Set = None,
    size: options.Size = None,
    seed: options.Seed = None,
    eye: options.Eye = None,
    target: options.Target = None,
    fov: options.Fov = None,
    like: options.Like = None,
    output: options.Output = Path("reference.png"),
    buffers: options.Buffers = None,
    stats: options.Stats = None,
    rays: options.Rays = 256,
    radius: options.Radius = None,
) -> None:
    """Ray-trace SCENE, with the radius and falloff of a module or a radius of its own, and write the picture."""
    job = _job(scene, like, module, set_, None, (eye, target, fov))
    job.choose(size=size, seed=seed)
    job.trace(rays, radius, output, buffers, stats)
    print(output)


def _job(
    scene: str | None,
    like: Path | None,
    module: str | None,
    set_: list[str] | None,
    occluders: str | None,
    camera: tuple[str | None, str | None, float | None],
) -> "Job":
    """The job that the options describe; those that are not given leave what the picture or the scene says."""
    from ..modules import MODULES
    from .job import Job

    job = Job.like(like) if like else Job()
    if scene is not None:
        job.scene = scene
    if job.scene is None:
        raise ParameterError("which scene? Name one (`aolab scenes` lists them), a model file, or --like FILE.png")
    if module is not None and module != job.module:
        job.module, job.parameters = module, {}
    changes = dict(_key_value(text) for text in set_ or [])
    if occluders is not None:
        changes["occluders"] = occluders
    job.parameters = MODULES[job.module].changed(job.parameters, changes) if job.module in MODULES else changes
    job.place_camera(*camera)
    return job


def _key_value(text: str) -> tuple[str, Any]:
    key, separator, value = text.partition("=")
    if not separator or not key:
        raise ParameterError(f"--set {text}: write KEY=VALUE, as in --set radius=0.5")
    return key.strip().replace("-", "_"), value.strip()


@app.command()
def compare(
    scene: Annotated[str, typer.Argument(help="A scene's name, or a model file.")],
    modules: Annotated[str | None, typer.Option(metavar="A,B", help="As in 'none,ssao?steps=4'. Default: all.")] = None,
    size: Annotated[str, typer.Option(metavar="WxH", help="Pixels.")] = "480x270",
    rays: options.Rays = 256,
    radius: options.Radius = None,
    buffer: Annotated[str, typer.Option(help="What is compared.")] = "visibility",
    output: Annotated[
        Path | None, typer.Option("-o", "--output", metavar="FILE.png", help="Draw the sheet of pictures.")
    ] = None,
    relight: Annotated[
        int | None, typer.Option(metavar="K", min=1, help="The ambient light's error instead, over K turns of the sky.")
    ] = None,
    as_json: Json = False,
) -> None:
    """Compare modules with the ray-traced truth, sorted by error; with -o, as a sheet of pictures."""
    from .compare import compare_command, relight_command

    if relight is not None:
        if output is not None or buffer != "visibility":
            raise ParameterError("--relight prints errors of ambient light: it takes no -o and no --buffer")
        print(relight_command(scene, modules, size, rays, radius, relight, as_json))
        return
    print(compare_command(scene, modules, size, rays, radius, buffer, output, as_json))


@app.command()
def modules(name: Annotated[str | None, typer.Argument(help="One module only.")] = None, as_json: Json = False) -> None:
    """List the modules and their parameters: name, type, default, range, unit, and what it does."""
    from ..errors import suggestion
    from ..modules import MODULES
    from ..modules.parameters import Choice, describe

    if name is not None and name not in MODULES:
        raise ParameterError(f"no module '{name}'{suggestion(name, MODULES)}")
    chosen = {key: module for key, module in MODULES.items() if name in (None, key)}
    if as_json:
        print(json.dumps({key: module.model_json_schema() for key, module in chosen.items()}, indent=2))
        return
    for key, module in chosen.items():
        print(f"{key}: {module.title}\n  {module.paper}")
        for field in module.model_fields:
            _print_parameter(describe(module, field))
    choices = {of.label(): of for of in chosen[next(iter(chosen))].stated().values() if issubclass(of, Choice)}
    for name, choice in choices.items():
        print(f"{name}:")
        for field in choice.model_fields:
            _print_parameter(describe(choice, field))


def _print_parameter(about: dict[str, str]) -> None:
    facts = ", ".join(filter(None, (about["type"], about["range"], about["unit"])))
    print(f"  {about['name']} = {about['default']}  ({facts})\n      {about['description']}")


@app.command()
def scenes(as_json: Json = False) -> None:
    """List the scenes, their parameters and defaults."""
    from ..loading import describe_scene, scene_names

    described = [describe_scene(name) for name in scene_names()]
    if as_json:
        print(json.dumps({one.name: {"summary": one.summary, "parameters": one.parameters} for one in described}))
        return
    for one in described:
        parameters = "&".join(f"{key}={value}" for key, value in one.parameters.items())
        print(f"{one.name}{'?' if parameters else ''}{parameters}\n  {one.summary}")


@app.command()
def doctor(as_json: Json = False) -> None:
    """Say what can render here: renderer, versions, devices, extras, and the fix for what is missing."""
    from .doctor import examine, report

    findings = examine()
    print(json.dumps(findings, indent=2) if as_json else report(findings))
    if not findings["renders"]:
        raise typer.Exit(1)


@app.command()
def bench(
    size: Annotated[str, typer.Option(metavar="WxH", help="Pixels.")] = "1280x720",
    scene: Annotated[str, typer.Option(help="What to draw.")] = "boxes",
    frames: Annotated[int, typer.Option(min=3, help="How often each measurement is repeated.")] = 15,
    scaling: Annotated[bool, typer.Option("--scaling", help="How cost grows with pixels, taps and triangles.")] = False,
    start: Annotated[
        bool, typer.Option("--start", help="Import, and process start to saved picture at 640x360.")
    ] = False,
    quality: Annotated[
        str | None,
        typer.Option(metavar="SCENE", help="Error against milliseconds, every module over a range of its settings."),
    ] = None,
    rays: options.Rays = 256,
    output: Annotated[
        Path, typer.Option("-o", "--output", metavar="FILE.png", help="For --quality: the picture; data beside it.")
    ] = Path("quality.png"),
    as_json: Json = False,
) -> None:
    """Measure: per pass, median and spread over repeated frames; the whole frame; Python's share; the bare loop."""
    from ..studies import bench as measure
    from .job import parse_size

    if quality is not None:
        from .quality import quality_command

        curve = quality_command(quality, output, size=parse_size(size), rays=rays, frames=frames)
        print(json.dumps(curve.to_dict(), indent=2) if as_json else f"{curve.table()}\n{output}")
        return
    if scaling:
        result = measure.scaling(parse_size(size), frames)
    elif start:
        result = measure.start_up(frames)
    else:
        result = measure.frames(scene, parse_size(size), frames)
    print(json.dumps(result, indent=2) if as_json else measure.table(result))


@app.command()
def tune(
    module: Annotated[str, typer.Argument(help="The method; see `aolab modules`.")],
    parameters: Annotated[
        str | None, typer.Option(metavar="A,B", help="What to fit. Default: all numbers of the module's own.")
    ] = None,
    set_: options.Set = None,
    scenes: Annotated[str | None, typer.Option(metavar="A,B", help="What to fit to.")] = None,
    test_scenes: Annotated[str | None, typer.Option(metavar="A,B", help="Other scenes, which only judge.")] = None,
    views: Annotated[int, typer.Option(help="Cameras a scene: its own, and others from the side.")] = 3,
    trials: Annotated[int | None, typer.Option(help="Default: 25 a parameter.", show_default=False)] = None,
    size: Annotated[str, typer.Option(metavar="WxH", help="Pixels.")] = "320x180",
    rays: options.Rays = 128,
    seed: Annotated[int, typer.Option(help="Of the search.")] = 0,
    output: Annotated[
        Path | None, typer.Option("-o", "--output", metavar="FILE.json", help="Write the preset: the parameters.")
    ] = None,
    as_json: Json = False,
) -> None:
    """Fit a module's parameters to the truth on some scenes, and report what that does on others."""
    from .job import parse_size
    from .tune import tune_command

    result = tune_command(
        module,
        dict(_key_value(text) for text in set_ or []),
        output,
        parameters=_words(parameters),
        scenes=_words(scenes),
        test_scenes=_words(test_scenes),
        views=views,
        trials=trials,
        size=parse_size(size),
        rays=rays,
        seed=seed,
    )
    print(json.dumps(result.to_dict(), indent=2) if as_json else result.table())


@app.command()
def reproduce(
    paper: Annotated[str, typer.Argument(help=f"The paper, by its method's name: {', '.join(PAPERS)}.")],
    figure: Annotated[
        str | None, typer.Argument(help="As in fig7 or table1. Default: all of them.", show_default=False)
    ] = None,
    folder: Annotated[
        Path, typer.Option("-o", "--output", metavar="DIR", help="Where FIGURE.png and FIGURE.json are written.")
    ] = Path("."),
    size: Annotated[
        str | None, typer.Option(metavar="WxH", help="Pixels of one picture. Default: each figure's own.")
    ] = None,
    as_json: Json = False,
) -> None:
    """Draw a paper's figures and tables anew, and say whether the numbers hold the paper's claims."""
    from ..papers.reproduce import reproduce as drawn
    from .job import parse_size

    found = []
    for name, content in drawn(paper, figure, folder, parse_size(size) if size else None):
        found.append(content)
        if not as_json:
            print(f"{folder / name}.png: {content['claim']}. {content['verdict']}")
    if as_json:
        print(json.dumps(found, indent=2))


def _words(text: str | None) -> list[str] | None:
    return None if text is None else [word.strip() for word in text.split(",") if word.strip()]


if __name__ == "__main__":
    main()
