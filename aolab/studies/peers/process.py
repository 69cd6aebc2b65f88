"""A process for each peer: OpenGL displays, and crashes, stay its own."""

import multiprocessing
import os
import sys
from multiprocessing.connection import Connection
from time import perf_counter
from typing import Any

import numpy as np

from ...errors import ParameterError
from .peer import PeerClass

STARTS = 300  # seconds in which a peer must have drawn its first frames
DRAWS = 60


class PeerProcess:
    """A `Peer` in a process of its own. Raises `ParameterError` if the peer cannot draw, with its reason."""

    def __init__(self, kind: PeerClass, *arguments: Any) -> None:
        spawn = multiprocessing.get_context("spawn")  # a forked process would share the OpenGL context
        self._pipe, theirs = spawn.Pipe()
        self._process = spawn.Process(target=_serve, args=(kind, arguments, theirs), daemon=True)
        self._process.start()
        theirs.close()
        self.name, self.settings, self.visibility = self._answer(STARTS)

    def milliseconds(self, occlusion: bool) -> float:
        """The time of a frame, with or without ambient occlusion."""
        self._pipe.send(occlusion)
        return self._answer(DRAWS)

    def close(self) -> None:
        self._process.terminate()
        self._process.join()

    def _answer(self, seconds: float) -> Any:
        try:
            if not self._pipe.poll(seconds):
                self.close()
                raise ParameterError(f"it did not answer in {seconds} seconds")
            answer = self._pipe.recv()
        except (EOFError, ConnectionError) as error:
            self._process.join()
            raise ParameterError(f"its process ended with exit code {self._process.exitcode}") from error
        if isinstance(answer, Exception):
            raise ParameterError(str(answer)) from answer
        return answer


def _serve(kind: PeerClass, arguments: tuple[Any, ...], pipe: Connection) -> None:
    """Make the peer, send its name, settings and visibility, then draw as often as asked."""
    silent = os.open(os.devnull, os.O_WRONLY)
    for stream in (sys.stdout, sys.stderr):  # libraries report there about the displays that they tried
        os.dup2(silent, stream.fileno())
    try:
        peer = kind(*arguments)
        visibility: np.ndarray = peer.visibility()
    except Exception as error:  # of another project's library, of any kind: the reason goes to the user
        pipe.send(RuntimeError(f"{type(error).__name__}: {error}"))
        return
    pipe.send((peer.name, peer.settings, visibility))
    while True:
        occlusion = pipe.recv()
        start = perf_counter()
        peer.draw(occlusion)
        pipe.send((perf_counter() - start) * 1e3)
