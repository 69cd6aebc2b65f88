"""The command `aolab`: an error is one line on standard error and exit code 2; `--debug` shows its traceback.

Only the standard library is imported here, so that an interrupt while the rest is imported is caught, too.
"""

import codecs
import gc
import os
import sys
from collections.abc import Callable
from typing import Any

DONE, REFUSED, INTERRUPTED = 0, 2, 130  # exit codes; 130 is what shells report for SIGINT
PLAIN = {"≥": ">=", "≤": "<=", "×": "x", "±": "+-", "→": "->", "°": " degrees", "−": "-", "–": "-", "…": "..."}
# Variables of libraries, each set unless the user has set it: a command starts without work that it does not need.
LIBRARIES = {
    "OPENBLAS_NUM_THREADS": "1",  # NumPy's import starts a thread for each further core, which spins for 30 ms
    "PYDANTIC_DISABLE_PLUGINS": "__all__",  # the search for plugins reads the metadata of all installed packages
}
OBJECTS = 50_000  # between two collections of garbage: a frame leaves none, and the objects of all imports stay


def main(imported: Callable[[], object] = lambda: None) -> None:
    """Run the command in `sys.argv` and end the process with its exit code; `imported` is called between the imports
    and the run."""
    for name, value in LIBRARIES.items():
        os.environ.setdefault(name, value)
    gc.set_threshold(OBJECTS)
    debug = "--debug" in sys.argv
    arguments = [argument for argument in sys.argv[1:] if argument != "--debug"] or ["--help"]
    _write_any_character()
    try:
        code = _run(arguments, imported)
        if sys.stdout is not None:  # it may be closed
            sys.stdout.flush()
    except KeyboardInterrupt:
        code = INTERRUPTED
    except Exception as error:
        if isinstance(error, BrokenPipeError):
            _close_output()
            sys.exit(REFUSED)  # the reader of a pipe has ended, and needs no message
        interrupted = isinstance(error.__cause__, KeyboardInterrupt)  # Python 3.11, in `__set_name__` of a class
        message = "" if interrupted else _message(error, arguments)
        if debug or message is None:
            raise
        if message:
            print("aolab:", message, file=sys.stderr)
        code = INTERRUPTED if interrupted else REFUSED
    if code == INTERRUPTED:
        print(f"{_clean_line()}aolab: interrupted", file=sys.stderr)
    sys.exit(code)


def _run(arguments: list[str], imported: Callable[[], object]) -> int:
    import warnings

    from ..errors import Notice
    from ..interrupts import after_imports
    from .app import NAMES, app

    imported()
    warnings.simplefilter("always", Notice)
    warnings.showwarning = _show_notice
    with after_imports():
        # typer returns the code of `typer.Exit`, and of an interrupt
        asked = arguments[:1] if arguments[0] in NAMES else ()
        return app(*asked)(arguments, prog_name="aolab", standalone_mode=False) or DONE


def _message(error: Exception, arguments: list[str]) -> str | None:
    """One line for an error that a user can mend; None for a fault of the program."""
    from ..errors import Error
    from .slips import meant

    # typer's errors of usage; the module that defines them differs between its versions
    usage = getattr(error, "format_message", None)
    if isinstance(error, Error) or usage:
        text = usage() if usage else str(error)
        lines = (meant(text, arguments) or text).splitlines()
        return " | ".join(line.strip() for line in lines if line.strip())
    if isinstance(error, OSError):
        if error.filename is None:
            _close_output()
            return f"cannot write to standard output: {error.strerror or error}"
        return f"{error.strerror or error}: {str(error.filename)[:80]}"
    return None


def _show_notice(message: Any, category: type[Warning], filename: str, lineno: int, *_: Any) -> None:
    from ..errors import Notice

    kind = "note" if issubclass(category, Notice) else f"{filename}:{lineno}: {category.__name__}"
    line = f"aolab: {kind}: {message}"
    if "aolab.progress" in sys.modules:  # a bar may be shown
        from ..progress import write_line

        write_line(line, sys.stderr)
    else:
        print(line, file=sys.stderr)


def _clean_line() -> str:
    """The characters that remove `^C` from a terminal."""
    is_terminal = os.name == "posix" and sys.stderr is not None and sys.stderr.isatty()
    return "\r\x1b[K" if is_terminal else ""


def _write_any_character() -> None:
    """Where the terminal's encoding lacks a character, as ASCII lacks ≥, write plain characters in its place."""

    def plain(error: UnicodeError) -> tuple[str, int]:
        assert isinstance(error, UnicodeEncodeError)
        return "".join(PLAIN.get(one, "?") for one in error.object[error.start : error.end]), error.end

    codecs.register_error("aolab-plain", plain)
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="aolab-plain")  # pyright: ignore[reportAttributeAccessIssue]


def _close_output() -> None:
    """Send the rest of standard output nowhere: Python would try to write it again at its end, and fail again."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)


if __name__ == "__main__":
    main()
