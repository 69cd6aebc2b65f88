"""The costs of methods beside each other: times in turns, and ratios as medians over the turns."""

import statistics
from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass
from typing import TypeVar

from ..pipeline.frame import Frame

Key = TypeVar("Key", bound=Hashable)
REPEATS = 9  # turns; figures give their median


@dataclass(frozen=True)
class Cost:
    """Milliseconds of one frame: the whole call, and its `passes` by name."""

    frame: float
    passes: Mapping[str, float]

    def of(self, stem: str) -> float:
        """All passes whose names begin with `stem`."""
        return sum(milliseconds for name, milliseconds in self.passes.items() if name.startswith(stem))


def in_turns(draws: Mapping[Key, Callable[[], Frame]], repeats: int) -> dict[Key, list[Cost]]:
    """The costs of `repeats` frames of each.

    Every turn draws one frame of each, so that the other work of the machine meets all of them. The first turn
    compiles the shaders; its costs are left out.
    """
    costs: dict[Key, list[Cost]] = {name: [] for name in draws}
    for turn in range(repeats + 1):
        for name, draw in draws.items():
            frame = draw().complete("image")
            if turn:
                costs[name].append(Cost(frame.frame_ms, frame.timings))
    return costs


def median_ratio(values: list[float], others: list[float]) -> float:
    """The median over the turns of one time over another."""
    return statistics.median(value / other for value, other in zip(values, others, strict=True))
