"""Error against time: the measured points and their Pareto front."""

from dataclasses import asdict, dataclass
from typing import Any

from ..table import table


@dataclass(frozen=True)
class Point:
    """A setting of a module, with its time and its error.

    `milliseconds` is the time of the passes that a frame has because of the module: the median of their sum. `spread`
    is its interquartile range, and `passes` has the median of each pass. `rmse` and `bias` are those of visibility over
    all pixels with a surface. `front`: no other measured point is at least as fast and at least as good.
    """

    module: str
    settings: dict[str, Any]
    default: bool
    milliseconds: float
    spread: float
    passes: dict[str, float]
    rmse: float
    bias: float
    front: bool = False

    @property
    def label(self) -> str:
        """'ssao 16×2 box4', followed by 'at 0.5' for a scale below 1."""
        rest = dict(self.settings)
        taps = "×".join(str(rest.pop(key)) for key in ("directions", "steps") if key in rest)
        scale = rest.pop("scale", 1)
        words = [self.module, taps, *map(str, rest.values()), f"at {scale:g}" if scale != 1 else ""]
        return " ".join(filter(None, words))


@dataclass(frozen=True)
class Curve:
    """All points. `info` has the conditions of the measurement; `noise` is the RMS of the truth's standard error."""

    points: tuple[Point, ...]
    info: dict[str, Any]
    noise: float

    @property
    def front(self) -> list[Point]:
        """The Pareto front, fastest first: each point has less error than all faster points."""
        return sorted((point for point in self.points if point.front), key=lambda point: point.milliseconds)

    @property
    def title(self) -> str:
        """Scene, size, radius and rays."""
        return "{scene}, {size[0]}×{size[1]}, radius {radius:.3g}, truth of {rays} rays a pixel".format(**self.info)

    @property
    def place(self) -> str:
        """Renderer, machine and number of frames."""
        return "{renderer}; {machine}; medians of {frames} frames".format(**self.info)

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return {**self.info, "truth_standard_error": self.noise, "points": [asdict(point) for point in self.points]}

    def table(self) -> str:
        """The Pareto front, then the other modules' defaults, as lines of text."""
        rows = []
        for one in [*self.front, *(point for point in self.points if point.default and not point.front)]:
            label = one.label + (", default" if one.default else "") + ("" if one.front else ", not on the front")
            rows.append((label, one.milliseconds, one.spread, one.rmse, one.bias))
        columns = {"": "", "ms": ".2f", "±": ".2f", "rmse": ".4f", "bias": "+.4f"}
        return "\n".join([self.title, self.place, table(columns, rows)])
