"""Lines of numbers as arrays: fast where they are as they should be, and with the line's number where not."""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..errors import FileError, shorten


@dataclass
class Lines:
    """Some lines of a file, without their keyword where they have one."""

    texts: Sequence[str]
    numbers: np.ndarray  # (n,): of each line in the file, from 1
    keyword: str = ""

    def shown(self, row: int) -> str:
        """A line as errors show it: `line 7: 'v 1 2 three'`."""
        return f"line {self.numbers[row]}: '{shorten(f'{self.keyword} {self.texts[row].strip()}'.strip())}'"


def counts_of(lines: Lines) -> np.ndarray:
    """(n,): how many words each line has."""
    return np.fromiter(map(len, map(str.split, lines.texts)), np.int64, len(lines.texts))


def flat(lines: Lines, counts: np.ndarray) -> np.ndarray:
    """The numbers of all lines, one after the other, float64. Raises `FileError` for a word that is no number."""
    values = numbers(" ".join(lines.texts), float, int(counts.sum()))
    if values is None:
        for row, text in enumerate(lines.texts):
            if numbers(text, float, len(text.split())) is None:
                raise FileError(f"{lines.shown(row)} is not made of numbers")
        raise FileError("holds a word where numbers belong")
    return values


def table(lines: Lines, least: int) -> np.ndarray:
    """(n, columns) float64, as many as the longest line has; numbers that a line lacks are 0.

    Raises `FileError` for a line of fewer than `least` numbers, and for a word that is no number.
    """
    if not len(lines.texts):
        return np.zeros((0, least))
    counts = counts_of(lines)
    short = np.flatnonzero(counts < least)
    if len(short):
        raise FileError(f"{lines.shown(short[0])} has {counts[short[0]]} numbers; {least} are needed")
    values, columns = flat(lines, counts), int(counts.max())
    if (counts == columns).all():
        return values.reshape(-1, columns)
    filled = np.zeros((len(counts), columns))
    filled[np.repeat(np.arange(len(counts)), counts), within(counts)] = values
    return filled


def within(counts: np.ndarray) -> np.ndarray:
    """The place of each item within its group, for groups of `counts` items, one after the other."""
    return np.arange(int(counts.sum())) - np.repeat(np.cumsum(counts) - counts, counts)


def numbers(text: str | bytes, dtype: type, count: int) -> np.ndarray | None:
    """(count,) numbers of a text with spaces between; None where the text holds something else, or others."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            values = np.fromstring(text, dtype, sep=" ")  # type: ignore[call-overload]
        except (ValueError, DeprecationWarning):
            return None
    return values if len(values) == count else None
