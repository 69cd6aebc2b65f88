"""Values of options, read from text. Each function raises `ParameterError` with the option and the text."""

import re

from ..errors import ParameterError
from ..queries import pair

Size = tuple[int, int]
Vector = tuple[float, float, float]


def size(text: str) -> Size:
    """'1280x720' as (1280, 720)."""
    if not (match := re.fullmatch(r"(\d{1,9})[xX×](\d{1,9})", text.strip())):
        raise ParameterError(f"size = '{text[:40]}' is not WIDTHxHEIGHT, as in 1280x720")
    return int(match[1]), int(match[2])


def vector(option: str, text: str) -> Vector:
    """'0,1,4' as (0.0, 1.0, 4.0)."""
    try:
        x, y, z = (float(part) for part in text.split(","))
    except ValueError:
        raise ParameterError(f"{option} {text[:40]} is not three numbers X,Y,Z") from None
    return x, y, z


def listed(text: str | None) -> list[str] | None:
    """'a, b' as ['a', 'b']; None stays None."""
    return None if text is None else [word.strip() for word in text.split(",") if word.strip()]


def settings(texts: list[str] | None) -> dict[str, str]:
    """The `KEY=VALUE`s of --set."""
    found = {}
    for text in texts or []:
        try:
            key, value = pair(text)
        except ParameterError:
            raise ParameterError(f"--set {text[:40]}: write KEY=VALUE, as in --set radius=0.5") from None
        found[key] = value
    return found
