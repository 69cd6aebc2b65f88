"""`aolab render`."""

from pathlib import Path

from . import options


def render(
    scene: options.Scene = None,
    module: options.Module = None,
    shader: options.Shader = None,
    like_module: options.LikeModule = None,
    set_: options.Set = None,
    occluders: options.Occluders = None,
    size: options.Size = None,
    seed: options.Seed = None,
    accumulate: options.Accumulate = None,
    eye: options.Eye = None,
    target: options.Target = None,
    up: options.Up = None,
    up_axis: options.UpAxis = None,
    fov: options.Fov = None,
    exposure: options.Exposure = None,
    tone_map: options.ToneMap = None,
    like: options.Like = None,
    output: options.Output = Path("out.png"),
    buffer: options.Buffer = None,
    buffers: options.Buffers = None,
    stats: options.Stats = None,
) -> None:
    """Render a scene and write the picture."""
    from .files import Files
    from .job import asked
    from .module_name import module_name
    from .text import settings

    job = asked(scene, like)
    job.turn_up(up_axis)
    chosen = {} if occluders is None else {"occluders": occluders}
    job.use(module_name(module, shader, like_module), settings(set_) | chosen)
    job.move(eye, target, up, fov)
    job.choose(size=size, seed=seed, accumulate=accumulate, exposure=exposure, tone_map=tone_map, buffer=buffer)
    files = Files(output, job.buffer, buffers, stats)
    files.check()
    print(files.write(job.render(warm=stats is not None)))
