"""The result of tuning: the preset, and its errors on the views of the fit and on other views."""

from dataclasses import asdict, dataclass
from statistics import fmean
from typing import Any

from ..modules import Module
from ..modules.parameters import label
from ..table import table


@dataclass(frozen=True)
class Row:
    """RMSE and bias of visibility in a view, before and after. `turn` is the angle of the camera (`nearby_cameras`)."""

    scene: str
    turn: float
    held_out: bool
    rmse: float
    bias: float
    tuned_rmse: float
    tuned_bias: float


@dataclass(frozen=True)
class Tuning:
    """The `module` as it was, the module `tuned` on the training views, and the errors of both in every view."""

    module: Module
    tuned: Module
    parameters: tuple[str, ...]
    rows: tuple[Row, ...]
    info: dict[str, Any]

    @property
    def preset(self) -> dict[str, Any]:
        """The tuned values, and other values that differ from the defaults: `aolab.SSAO(**preset)`."""
        usual = type(self.tuned)()
        values = self.tuned.values()
        return {key: values[key] for key in values if key in self.parameters or values[key] != getattr(usual, key)}

    def mean(self, name: str, *, held_out: bool) -> float:
        """The mean of a number of the rows over the training or the held-out views."""
        return fmean(getattr(row, name) for row in self.rows if row.held_out == held_out)

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON."""
        means = {
            kind: {name: self.mean(name, held_out=held_out) for name in ("rmse", "tuned_rmse", "bias", "tuned_bias")}
            for kind, held_out in (("training", False), ("held_out", True))
        }
        return {
            **self.info,
            "module": label(type(self.module)),
            "before": self.module.values(),
            "preset": self.preset,
            **means,
            "views": [asdict(row) for row in self.rows],
        }

    def table(self) -> str:
        """The changes, and the errors before and after in every view, as lines of text."""
        changes = [f"{name} {getattr(self.module, name)} → {getattr(self.tuned, name)}" for name in self.parameters]
        size, views = self.info["size"], len([row for row in self.rows if not row.held_out])
        lines = [
            f"{label(type(self.module))}: {', '.join(changes)}",
            f"{self.info['trials']} trials, {views} view{'s' if views > 1 else ''}, {size[0]}x{size[1]}, "
            f"{self.info['rays']} rays, {self.info['renderer']}",
        ]
        rows = []
        for held_out, head in ((False, "training"), (True, "held out")):
            for row in self.rows:
                if row.held_out == held_out:
                    where = f"{row.scene}{f', {row.turn:+g}°' if row.turn else ''}"
                    rows.append(_cells(where, row.rmse, row.tuned_rmse, row.bias, row.tuned_bias))
            names = ("rmse", "tuned_rmse", "bias", "tuned_bias")
            rows.append(_cells(f"{head}, mean", *(self.mean(name, held_out=held_out) for name in names)))
        columns = {"": "", "rmse": ".4f", "tuned rmse": ".4f", "change": "+.1%", "bias": "+.4f", "tuned bias": "+.4f"}
        lines.append(table(columns, rows))
        lines.append("--set " + " --set ".join(f"{key}={value}" for key, value in self.preset.items()))
        if self.mean("tuned_rmse", held_out=True) > self.mean("rmse", held_out=True):
            lines.append(
                "On the held-out scenes this preset is worse than the module before: do not use it in general."
            )
        return "\n".join(lines)


def _cells(where: str, rmse: float, tuned_rmse: float, bias: float, tuned_bias: float) -> list[str | float | None]:
    return [where, rmse, tuned_rmse, tuned_rmse / rmse - 1 if rmse else None, bias, tuned_bias]
