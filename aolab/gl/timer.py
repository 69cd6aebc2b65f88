"""How long each pass took: GPU queries on hardware; on a software renderer, wall clock around `finish()`."""

from collections.abc import Iterator
from contextlib import contextmanager
from time import perf_counter

from . import context


class Timer:
    """Milliseconds by pass name; a name that comes up again (accumulation, filters) is added up."""

    def __init__(self) -> None:
        self._gl = context.get()
        self.software = context.is_software()
        self._milliseconds: dict[str, float] = {}
        self._queries: list[tuple[str, object]] = []

    @contextmanager
    def measure(self, name: str) -> Iterator[None]:
        """Time the GL commands issued inside."""
        if self.software:
            start = perf_counter()
            yield
            self._gl.finish()
            self._add(name, (perf_counter() - start) * 1e3)
        else:
            query = self._gl.query(time=True)
            with query:
                yield
            self._queries.append((name, query))

    def _add(self, name: str, milliseconds: float) -> None:
        self._milliseconds[name] = self._milliseconds.get(name, 0.0) + milliseconds

    def result(self) -> dict[str, float]:
        """{pass name: milliseconds}, in the order of the passes; waits for the GPU."""
        for name, query in self._queries:
            self._add(name, query.elapsed / 1e6)  # type: ignore[attr-defined]
        self._queries.clear()
        return dict(self._milliseconds)
