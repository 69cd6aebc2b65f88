"""Means over pairs of independent samples, and how uncertain these means are."""

from collections.abc import Iterable, Mapping

import numpy as np

Pair = tuple[str, str]
Sums = dict[str | Pair, np.ndarray]


class Moments:
    """Sums over samples that come in pairs, for `count` points: `means`, `variances` and `covariances` by integral.

    The two samples of a pair are independent and come from one stratum. Then the variance of the mean over N samples
    is Σ (a - b)² / N², without bias, and the covariance of two means likewise (Cochran 1977, Sampling Techniques,
    section 5A). `channels` holds the integrals' names; `crosses` holds the pairs of integrals whose covariance counts.
    """

    def __init__(self, count: int, channels: Mapping[str, int], crosses: Iterable[Pair] = ()) -> None:
        self._samples = np.zeros((count, 1), np.float32)
        self._sums: Sums = {name: np.zeros((count, width), np.float32) for name, width in channels.items()}
        self._squares: Sums = {name: np.zeros_like(total) for name, total in self._sums.items()}
        self._products: Sums = {
            (a, b): np.zeros((count, max(channels[a], channels[b])), np.float32)
            for a, b in crosses
            if a in channels and b in channels
        }

    def add(self, first: Mapping[str, np.ndarray], second: Mapping[str, np.ndarray]) -> None:
        """Add a pair of samples, (count, channels) each, by integral."""
        differences = {}
        for name, a in first.items():
            b = second[name]
            self._sums[name] += a
            self._sums[name] += b
            differences[name] = difference = a - b
            self._squares[name] += difference * difference
        for (a, b), product in self._products.items():
            if a in differences and b in differences:
                product += differences[a] * differences[b]

    def counted(self, samples: int) -> None:
        """The sums now hold `samples` more samples; integrals with rays of their own are scaled to this number."""
        self._samples += np.float32(samples)

    def exact(self, name: str, values: np.ndarray) -> None:
        """Set the integral `name`, which needs no samples, to `values` (count, channels); after `counted`."""
        self._sums[name] += values * self._samples

    def put(self, where: np.ndarray, part: "Moments") -> None:
        """Add the sums of `part` to those of the points `where`."""
        self._samples[where] += part._samples
        for mine, theirs in (
            (self._sums, part._sums),
            (self._squares, part._squares),
            (self._products, part._products),
        ):
            for key, values in theirs.items():
                mine[key][where] += values

    def mean(self, name: str) -> np.ndarray:
        """(count, channels) float32."""
        return self._sums[name] / self._samples

    def variance(self, name: str) -> np.ndarray:
        """(count, channels) float32: the squared standard error of the mean."""
        return self._squares[name] / self._samples**2

    def covariance(self, a: str, b: str) -> np.ndarray:
        """(count, channels) float32: of the means of `a` and `b`, which the same samples brought."""
        return self._products[a, b] / self._samples**2
