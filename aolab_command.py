"""The command `aolab`: its entry point, outside the package, whose import alone takes 0.03 s.

Until the modules of the command are imported, and after its end, Ctrl-C ends the process at once, in one line.
"""

# `signal` without its enumerations, whose import takes 5 ms
import _signal as signal  # pyright: ignore[reportMissingImports]
import os

INTERRUPTED = 130  # the exit code that shells report for SIGINT


def main() -> None:
    """Run the command in `sys.argv`, and end the process with its exit code."""
    handler = signal.getsignal(signal.SIGINT)
    outside = handler if handler is signal.SIG_IGN else _end  # SIG_IGN: in the background of a script
    signal.signal(signal.SIGINT, outside)
    from aolab.shell import cli

    try:
        cli.main(imported=lambda: signal.signal(signal.SIGINT, handler))
    finally:
        signal.signal(signal.SIGINT, outside)


def _end(*_: object) -> None:
    os.write(2, b"aolab: interrupted\n")
    os._exit(INTERRUPTED)
