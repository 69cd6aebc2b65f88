"""Fair presets: a module's parameters fitted to the truth on some scenes, and judged on others.

The way XeGTAO (Intel 2021) found its constants. Every module gets the same chance: the same scenes and cameras, the
same search, as many trials a parameter.
"""

import json
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from statistics import fmean
from typing import Any

from . import orbit
from .camera import Camera
from .command import typed
from .errors import Error, ParameterError
from .frame import Frame
from .gl import context
from .gl.texture import Size
from .lab import Lab
from .loading import load
from .modules import MODULES, Module, find
from .output import check_writable, replacing
from .parameters import label
from .quality import visibility_error
from .scene import Scene
from .search_space import Axis, axis, tunable
from .truth import reference
from .version import __version__

TRAINING = ("boxes", "colonnade", "toasters")
HELD_OUT = ("cornell", "atrium", "skyscrapers")
TRIALS = 25  # a parameter


@dataclass(frozen=True)
class Row:
    """One view: RMSE and bias of visibility there, before and after. `turn` is its camera's angle (`orbit.cameras`)."""

    scene: str
    turn: float
    held_out: bool
    rmse: float
    bias: float
    tuned_rmse: float
    tuned_bias: float


@dataclass(frozen=True)
class Tuning:
    """What was found: `module` as it was, `tuned` as it is best on the training views, and both on every view."""

    module: Module
    tuned: Module
    parameters: tuple[str, ...]
    rows: tuple[Row, ...]
    info: dict[str, Any]

    @property
    def preset(self) -> dict[str, Any]:
        """The tuned values, and what else differs from the module's defaults: `aolab.SSAO(**preset)`."""
        usual = type(self.tuned)()
        values = self.tuned.model_dump()
        return {key: values[key] for key in values if key in self.parameters or values[key] != getattr(usual, key)}

    def mean(self, name: str, *, held_out: bool) -> float:
        """A `Row`'s number, averaged over the training or the held-out views."""
        return fmean(getattr(row, name) for row in self.rows if row.held_out == held_out)

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        means = {
            kind: {name: self.mean(name, held_out=held_out) for name in ("rmse", "tuned_rmse", "bias", "tuned_bias")}
            for kind, held_out in (("training", False), ("held_out", True))
        }
        return {
            **self.info,
            "module": label(type(self.module)),
            "before": self.module.model_dump(),
            "preset": self.preset,
            **means,
            "views": [asdict(row) for row in self.rows],
        }

    def table(self) -> str:
        """What changed, and what that did on the training views and on the others, as lines to read."""
        changes = [f"{name} {getattr(self.module, name)} → {getattr(self.tuned, name)}" for name in self.parameters]
        size, views = self.info["size"], len([row for row in self.rows if not row.held_out])
        lines = [
            f"{label(type(self.module))}: {', '.join(changes)}",
            f"{self.info['trials']} trials on {views} views, {size[0]}x{size[1]}, {self.info['rays']} rays, "
            f"{self.info['renderer']}",
            f"{'':<24}{'rmse':>9}{'tuned':>9}{'':>9}{'bias':>10}{'tuned':>9}",
        ]
        for held_out, head in ((False, "training"), (True, "held out")):
            for row in self.rows:
                if row.held_out == held_out:
                    where = f"{row.scene}{f', {row.turn:+g}°' if row.turn else ''}"
                    lines.append(_line(where, row.rmse, row.tuned_rmse, row.bias, row.tuned_bias))
            names = ("rmse", "tuned_rmse", "bias", "tuned_bias")
            lines.append(_line(f"{head}, mean", *(self.mean(name, held_out=held_out) for name in names)))
        lines.append("--set " + " --set ".join(f"{key}={value}" for key, value in self.preset.items()))
        if self.mean("tuned_rmse", held_out=True) > self.mean("rmse", held_out=True):
            lines.append("On the held-out scenes this preset is worse than what it replaces: do not use it in general.")
        return "\n".join(lines)


def _line(where: str, rmse: float, tuned_rmse: float, bias: float, tuned_bias: float) -> str:
    change = f"{100 * (tuned_rmse / rmse - 1):+8.1f}%" if rmse else f"{'':9}"
    return f"{where:<24}{rmse:9.4f}{tuned_rmse:9.4f}{change}{bias:+10.4f}{tuned_bias:+9.4f}"


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
    `trials`: 25 a parameter by default.
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
    if "visibility" not in module.outputs:
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


def tune_command(module: str, values: dict[str, Any], output: Path | None, **how: Any) -> Tuning:
    """Tune the module with these values, which may be text, and write the preset as JSON."""
    if output is not None:
        check_writable(output)
    tuning = tune(typed(module, values), **how)
    if output is not None:
        with replacing(output) as file:
            file.write((json.dumps(tuning.preset, indent=2) + "\n").encode())
    return tuning


def _optuna() -> Any:
    try:
        import optuna
    except ImportError as error:
        raise Error(f'tuning needs Optuna: pip install "aolab[tune]" ({error})') from error
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
    """The module with the least mean RMSE over `views`; of equals the first, which is the module as it was."""
    from tqdm.auto import tqdm

    optuna.logging.set_verbosity(optuna.logging.WARNING)  # a line a trial is not for a library to print
    study = optuna.create_study(sampler=optuna.samplers.TPESampler(seed=seed))
    study.enqueue_trial({one.name: one.start for one in axes})
    best, least = module, float("inf")
    for _ in tqdm(range(trials), desc="trials", disable=None if progress is None else not progress):
        trial = study.ask()
        tried = module.replace(**{one.name: one.suggest(trial) for one in axes})
        error = fmean(_error(lab, tried, view)["rmse"] for view in views)  # type: ignore[arg-type]
        study.tell(trial, error)
        if error < least:
            best, least = tried, error  # type: ignore[assignment]
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
