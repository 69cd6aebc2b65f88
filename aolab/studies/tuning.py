"""What tuning found: the preset, and how it does on the views it was fitted to and on others."""

from dataclasses import asdict, dataclass
from statistics import fmean
from typing import Any

from ..modules import Module
from ..modules.parameters import label


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
