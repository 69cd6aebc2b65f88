"""A reproduced figure: a picture, numbers, and the bounds that the paper's claim needs."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf
from typing import Any

import numpy as np
from PIL import Image

from ..pictures.sheet import contact_sheet


@dataclass(frozen=True)
class Need:
    """A number that a claim needs between two bounds, both excluded. NaN lies between no bounds."""

    what: str
    value: float
    above: float = -inf
    below: float = inf

    @property
    def met(self) -> bool:
        return self.above < self.value < self.below

    @property
    def bounds(self) -> str:
        sides = (("above", self.above), ("below", self.below))
        return " and ".join(f"{side} {bound:.3g}" for side, bound in sides if abs(bound) < inf)

    def __str__(self) -> str:
        return f"{self.what} is {self.value:.3g}, needed {self.bounds}"

    def to_dict(self) -> dict[str, Any]:
        """Plain values for JSON; a missing bound is None."""
        above, below = (bound if abs(bound) < inf else None for bound in (self.above, self.below))
        return {"what": self.what, "value": float(self.value), "above": above, "below": below, "met": self.met}


def verdict(needs: Sequence[Need]) -> str:
    """Whether the claim holds; if it does not, by how much."""
    unmet = [str(need) for need in needs if not need.met]
    return f"DOES NOT HOLD: {'; '.join(unmet)}" if unmet else "holds"


@dataclass(frozen=True, eq=False)
class Figure:
    """`claim` is the paper's, as a sentence. It holds if all `needs` are met, those of aolab's defaults and those of
    the paper's own settings. `numbers` are plain values for JSON. `finding`: a further result, as a sentence, or "".
    """

    picture: Image.Image
    numbers: dict[str, Any]
    claim: str
    needs: tuple[Need, ...]
    finding: str = ""

    @property
    def holds(self) -> bool:
        return all(need.met for need in self.needs)

    @property
    def unmet(self) -> set[str]:
        """The names of the needs that are not met."""
        return {need.what for need in self.needs if not need.met}

    @property
    def verdict(self) -> str:
        return verdict(self.needs)


def figure(
    heading: str,
    claim: str,
    needs: Sequence[Need],
    numbers: dict[str, Any],
    pictures: Sequence[tuple[str, np.ndarray]],
    columns: int,
    finding: str = "",
) -> Figure:
    """The figure whose picture shows captioned `pictures` in rows of `columns`, under `title`."""
    picture = contact_sheet(pictures, columns, title=title(heading, claim, needs, finding))
    return Figure(picture, numbers, claim, tuple(needs), finding)


def title(heading: str, claim: str, needs: Sequence[Need], finding: str = "") -> str:
    """The text above a figure's picture. Its verdict is that of the JSON file."""
    return f"{heading}. Claim: {claim}. Verdict: {verdict(needs)}." + (f" Finding: {finding}." if finding else "")
