"""Fair presets: a module's parameters fitted to the truth on some scenes, and judged on others.

The way XeGTAO (Intel 2021) found its constants. Every module gets the same chance: the same scenes and cameras, the
same search, as many trials a parameter.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from statistics import fmean
from typing import Any

from ..errors import Error, ParameterError
from ..gl import context
from ..gl.texture import Size
from ..loading import load
from ..modules import MODULES, Module, find
from ..modules.parameters import label
from ..pipeline.frame import Frame
from ..pipeline.lab import Lab
from ..scene.camera import Camera
from ..scene.scene import Scene
from ..truth import reference
from ..version import __version__
from . import nearby_cameras as orbit
from .quality import visibility_error
from .search_space import Axis, axis, tunable
from .tuning import Row, Tuning

TRAINING = ("boxes", "colonnade", "toasters")
HELD_OUT = ("cornell", "atrium", "skyscrapers")
TRIALS = 25  # a parameter
IMMATERIAL = 1e-3  # share of the error: what gains less is put back, since the search wanders where nothing matters


@dataclass(frozen=True)
class _View:
    """One picture to be matched."""

    scene: Scene
    turn: float
    camera: Camera
    truth: Frame


def tune(
    module: str | Module | type[Module],
    parameters: Sequence[str] | None = None,
    *,
    scenes: Sequence[Any] | None = None,
    test_scenes: Sequence[Any] | None = None,
    trials: int | None = None,
    views: int = 3,
    size: Size = (320, 180),
    rays: int = 128,
    seed: int = 0,
    progress: bool | None = None,
) -> Tuning:
    """Fit `parameters` (all of the module's own numbers by default) to the least mean RMSE of visibility.

    The mean is over all `scenes`, each from its own camera and others (`orbit.cameras`), `views` in all; `test_scenes`
    only judge; by default they are `TRAINING` and `HELD_OUT`. Radius and falloff are the truth's, too, and stay; so
    does what costs time (`search_space`). The first trial is the module as given, so that the result is never worse
    where it was fitted; the others are the choice of a tree-structured Parzen estimator (Bergstra et al. 2011), seeded.
    In the end a change that gains less than 0.1 % is put back. `trials`: 25 a parameter by default.
    Raises `ParameterError`, `Error` without Optuna, and what `aolab.render` and `aolab.reference` raise.
    """
    module = find(module, MODULES)
    names = tunable(module) if parameters is None else list(dict.fromkeys(parameters))
    if not names:
        raise ParameterError(f"{label(type(module))} has no number of its own to tune; name one in `parameters`")
    axes = [axis(module, name) for name in names]
    trials = TRIALS * len(axes) if trials is None else trials
    if not isinstance(trials, int) or trials < 1:
        raise ParameterError(f"trials = {trials!r} is not a whole number from 1 on")
    if "visibility" not in {*module.outputs, *module.derived}:
        raise ParameterError(f"{label(type(module))} gives no visibility; it gives {', '.join(module.outputs)}")
    optuna = _optuna()
    training = [load(one) for one in (TRAINING if scenes is None else scenes)]
    held_out = [load(one) for one in (HELD_OUT if test_scenes is None else test_scenes)]
    _check(training, held_out)

    lab = Lab(size)
    to_match, to_judge = (
        [view for scene in group for view in _views(scene, module, lab, views, size, rays, progress)]
        for group in (training, held_out)
    )
    tuned = _search(optuna, module, axes, to_match, lab, trials, seed, progress)
    rows = [
        _row(lab, module, tuned, view, held_out)
        for held_out, group in ((False, to_match), (True, to_judge))
        for view in group
    ]
    info = {
        "aolab": __version__,
        "renderer": context.renderer(),
        "size": list(size),
        "rays": rays,
        "trials": trials,
        "seed": seed,
        "ranges": {one.name: list(one.choices) or [one.low, one.high] for one in axes},
    }
    return Tuning(module, tuned, tuple(names), tuple(rows), info)


def _optuna() -> Any:
    try:
        import optuna
    except ImportError as error:
        raise Error(f"tuning needs Optuna: pip install optuna ({error})") from error
    return optuna


def _check(training: list[Scene], held_out: list[Scene]) -> None:
    for what, group in (("scenes", training), ("test_scenes", held_out)):
        if not group:
            raise ParameterError(f"{what} is empty: name at least one scene")
    known = {scene.source or id(scene) for scene in training}
    if both := [_name(scene) for scene in held_out if (scene.source or id(scene)) in known]:
        raise ParameterError(f"{', '.join(both)}: to be fitted to and to judge; a scene can be one of both only")


def _name(scene: Scene) -> str:
    return scene.source or scene.name


def _views(
    scene: Scene, module: Module, lab: Lab, count: int, size: Size, rays: int, progress: bool | None
) -> Iterator[_View]:
    dark = scene.replace(lights=())  # visibility knows no lights, and shadow maps cost time
    for turn, camera in orbit.cameras(dark, count, lab, size).items():
        truth = reference(
            dark, size=size, camera=camera, rays=rays, like=module, buffers=("visibility",), progress=progress
        )
        yield _View(dark, turn, camera, truth)


def _error(lab: Lab, module: Module, view: _View) -> dict[str, float]:
    return visibility_error(lab.render(view.scene, module, camera=view.camera), view.truth)


def _search(
    optuna: Any,
    module: Module,
    axes: list[Axis],
    views: list[_View],
    lab: Lab,
    trials: int,
    seed: int,
    progress: bool | None,
) -> Module:
    """The module with the least mean RMSE over `views`; what does not matter for that stays as it was."""
    from tqdm import tqdm

    def score(tried: Any) -> float:
        return fmean(_error(lab, tried, view)["rmse"] for view in views)

    optuna.logging.set_verbosity(optuna.logging.WARNING)  # a line a trial is not for a library to print
    study = optuna.create_study(sampler=optuna.samplers.TPESampler(seed=seed))
    study.enqueue_trial({one.name: one.start for one in axes})
    best, least = module, float("inf")
    for _ in tqdm(range(trials), desc="trials", disable=None if progress is None else not progress):
        trial = study.ask()
        tried = module.replace(**{one.name: one.suggest(trial) for one in axes})
        error = score(tried)
        study.tell(trial, error)
        if error < least:
            best, least = tried, error  # type: ignore[assignment]

    enough = least * (1 + IMMATERIAL)
    if score(module) <= enough:
        return module
    for one in axes:
        if score(back := best.replace(**{one.name: one.start})) <= enough:
            best = back  # type: ignore[assignment]
    return best


def _row(lab: Lab, module: Module, tuned: Module, view: _View, held_out: bool) -> Row:
    before, after = _error(lab, module, view), _error(lab, tuned, view)
    return Row(
        scene=_name(view.scene),
        turn=view.turn,
        held_out=held_out,
        rmse=before["rmse"],
        bias=before["bias"],
        tuned_rmse=after["rmse"],
        tuned_bias=after["bias"],
    )
