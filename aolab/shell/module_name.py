"""The module that --module, --shader and --like-module name together."""

from pathlib import Path

from ..errors import ParameterError


def module_name(module: str | None, shader: Path | None, like_module: str | None) -> str | None:
    """The module as `find` reads it; None if no option names a module. Raises `ParameterError`."""
    if shader is None:
        if like_module is not None:
            raise ParameterError(
                f"--like-module {like_module} needs --shader FILE.frag; or write --module {like_module}"
            )
        return module
    if module is not None and like_module is not None:
        raise ParameterError("--shader takes the parameters of one module: give --like-module or --module, not both")
    name, mark, parameters = (like_module or module or "ssao").partition("?")
    return f"{shader}:{name}{mark}{parameters}"
