"""Error against time: the points of a measurement and their Pareto front."""

from dataclasses import asdict, dataclass
from typing import Any


@dataclass(frozen=True)
class Point:
    """One setting of a module: what it adds to a frame, and how it errs.

    `milliseconds` is the median of the sum of the passes that the frame has because of the module, `spread` its
    interquartile range, `passes` each one's median; `rmse` and `bias` are of visibility, over all pixels with a
    surface. `front`: nothing else measured is at least as fast and at least as good.
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
        """'ssao 16×2 box4', and 'at 0.5' behind it for a scale below 1."""
        rest = dict(self.settings)
        taps = "×".join(str(rest.pop(key)) for key in ("directions", "steps") if key in rest)
        scale = rest.pop("scale", 1)
        words = [self.module, taps, *map(str, rest.values()), f"at {scale:g}" if scale != 1 else ""]
        return " ".join(filter(None, words))


@dataclass(frozen=True)
class Curve:
    """All points; `info` says where and how they were measured, `noise` is the RMS of the truth's standard error."""

    points: tuple[Point, ...]
    info: dict[str, Any]
    noise: float

    @property
    def front(self) -> list[Point]:
        """The Pareto front, fastest first: each of its points errs less than all that are faster."""
        return sorted((point for point in self.points if point.front), key=lambda point: point.milliseconds)

    @property
    def title(self) -> str:
        """Scene, size, radius and rays."""
        return "{scene}, {size[0]}×{size[1]}, radius {radius:.3g}, truth of {rays} rays a pixel".format(**self.info)

    @property
    def place(self) -> str:
        """Renderer, machine, and how often each time was taken."""
        return "{renderer}; {machine}; medians of {frames} frames".format(**self.info)

    def to_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {**self.info, "truth_standard_error": self.noise, "points": [asdict(point) for point in self.points]}

    def table(self) -> str:
        """The front, and the defaults beside it, as lines to read."""
        lines = [self.title, self.place, f"{'':<40}{'ms':>9}{'±':>8}{'rmse':>9}{'bias':>9}"]
        for one in [*self.front, *(point for point in self.points if point.default and not point.front)]:
            about = one.label + (", default" if one.default else "") + ("" if one.front else ", not on the front")
            lines.append(f"{about:<40}{one.milliseconds:9.2f}{one.spread:8.2f}{one.rmse:9.4f}{one.bias:+9.4f}")
        return "\n".join(lines)
