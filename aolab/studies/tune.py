"""Parameters of a module, fitted to the truth on some scenes and tested on other scenes.

XeGTAO (Intel 2021) found its constants this way. The search is fair to all modules: the same scenes and cameras, the
same algorithm, and the same number of trials for each parameter.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from statistics import fmean
from typing import Any

import numpy as np

from ..errors import ParameterError
from ..extras import need
from ..gl import context
from ..gl.texture import Size
from ..loading import load
from ..modules import MODULES, Module, find
from ..modules.parameters import label
from ..pipeline.frame import Frame
from ..pipeline.lab import Lab
from ..progress import progress_bar
from ..scene.camera import Camera
from ..scene.scene import Scene
from ..truth import reference
from ..version import __version__
from .nearby_cameras import cameras
from .quality import visibility_error
from .search_space import Axis, axis, tunable
from .tuning import Row, Tuning

TRAINING = ("boxes", "colonnade", "toasters")
HELD_OUT = ("cornell", "atrium", "skyscrapers")
TRIALS = 25  # for each parameter
IMMATERIAL = 1e-3  # share of the error: a change that gains less is undone, since the search wanders at random there


@dataclass(frozen=True)
class _View:
    """A picture that is matched."""

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
    """Fit `parameters` (default: all numbers of the module's own) to the least mean RMSE of visibility.

    The mean is over all `scenes`, each seen by its own camera and by cameras beside it (`nearby_cameras`), `views` in
    all. `test_scenes` are only tested. The defaults are `TRAINING` and `HELD_OUT`. Parameters that the truth shares or
    that cost time stay (`search_space`), and so do parameters that have no effect on visibility in these scenes.
    The first trial is the module as given, so that the result is never worse on the scenes of the fit. The other trials
    come from a tree-structured Parzen estimator (Bergstra et al. 2011) with `seed`. In the end, a change that gains
    less than 0.1 % is undone. `trials`: 25 for each parameter by default.
    Raises `ParameterError`, also without Optuna, and the exceptions of `aolab.render` and `aolab.reference`.
    """
    module = find(module, MODULES)
    names = tunable(module) if parameters is None else list(dict.fromkeys(parameters))
    axes = [axis(module, name) for name in names]
    if trials is not None and (not isinstance(trials, int) or trials < 1):
        raise ParameterError(f"trials = {trials!r} is not a whole number from 1 on")
    if "visibility" not in {*module.outputs, *module.derived}:
        raise ParameterError(f"{label(type(module))} has no visibility; it has {', '.join(module.outputs)}")
    optuna = need("tune")
    training = [load(one) for one in (TRAINING if scenes is None else scenes)]
    held_out = [load(one) for one in (HELD_OUT if test_scenes is None else test_scenes)]
    _check(training, held_out)
    # visibility does not depend on lights, and shadow maps cost time
    training, held_out = ([scene.replace(lights=()) for scene in group] for group in (training, held_out))

    lab = Lab(size)
    idle = {one.name for one in axes if not _matters(lab, module, one, training)}
    if idle and parameters is not None:
        raise ParameterError(f"visibility does not depend on {', '.join(sorted(idle))} in these scenes")
    axes = [one for one in axes if one.name not in idle]
    if not axes:
        raise ParameterError(f"{label(type(module))} has no number of its own to tune; name one in `parameters`")
    trials = TRIALS * len(axes) if trials is None else trials
    to_match, to_judge = (
        _views(group, module, lab, views, size, rays, progress) for group in (training, held_out)
    )  # fmt: skip
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
    return Tuning(module, tuned, tuple(one.name for one in axes), tuple(rows), info)


def _matters(lab: Lab, module: Module, one: Axis, scenes: list[Scene]) -> bool:
    """Whether visibility in any of the scenes changes over the range of a parameter."""
    values = one.choices or (one.start, one.low, one.high)
    variants = [module.replace(**{one.name: value}) for value in values]
    for scene in scenes:
        first, *others = (lab.render(scene, variant)["visibility"] for variant in variants)
        if any(not np.array_equal(first, other, equal_nan=True) for other in others):
            return True
    return False


def _check(training: list[Scene], held_out: list[Scene]) -> None:
    for what, group in (("scenes", training), ("test_scenes", held_out)):
        if not group:
            raise ParameterError(f"{what} is empty: name at least one scene")
    known = {scene.source or id(scene) for scene in training}
    if both := [_name(scene) for scene in held_out if (scene.source or id(scene)) in known]:
        raise ParameterError(f"{', '.join(both)}: a scene is either for the fit or for the test, not for both")


def _name(scene: Scene) -> str:
    return scene.source or scene.name


def _views(
    scenes: list[Scene], module: Module, lab: Lab, count: int, size: Size, rays: int, shown: bool | None
) -> list[_View]:
    """Every scene from `count` cameras, with the ray-traced truth."""
    views = []
    with progress_bar("views", len(scenes) * count, "view", shown=shown) as bar:
        for scene in scenes:
            for turn, camera in cameras(scene, count, lab, size).items():
                truth = reference(
                    scene, size=size, camera=camera, rays=rays, like=module, buffers=("visibility",), progress=shown
                )
                views.append(_View(scene, turn, camera, truth))
                bar.update()
    return views


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
    shown: bool | None,
) -> Module:
    """The module with the least mean RMSE over `views`; a parameter that does not reduce it stays as it was."""

    def score(tried: Any) -> float:
        return fmean(_error(lab, tried, view)["rmse"] for view in views)

    optuna.logging.set_verbosity(optuna.logging.WARNING)  # by default it logs a line for each trial
    study = optuna.create_study(sampler=optuna.samplers.TPESampler(seed=seed))
    study.enqueue_trial({one.name: one.start for one in axes})
    best, least = module, float("inf")
    with progress_bar("trials", trials, "trial", shown=shown) as bar:
        for _ in range(trials):
            trial = study.ask()
            tried = module.replace(**{one.name: one.suggest(trial) for one in axes})
            error = score(tried)
            study.tell(trial, error)
            if error < least:
                best, least = tried, error  # type: ignore[assignment]
            bar.update()

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
