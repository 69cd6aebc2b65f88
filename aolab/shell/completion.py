"""Values that the shell completes when Tab is pressed (`aolab --install-completion`)."""


def scenes(incomplete: str) -> list[str]:
    """Scenes by name; the shell itself completes the names of files."""
    from ..loading import scene_names

    return _starting(incomplete, scene_names())


def modules(incomplete: str) -> list[str]:
    """Modules by name."""
    from ..modules import MODULES

    return _starting(incomplete, list(MODULES))


def occluders(incomplete: str) -> list[str]:
    """Kinds of occluders."""
    from ..modules.occluders import OCCLUDERS

    return _starting(incomplete, list(OCCLUDERS))


def tone_maps(incomplete: str) -> list[str]:
    """Tone maps."""
    return _starting(incomplete, ["filmic", "linear"])


def papers(incomplete: str) -> list[str]:
    """Papers with figures to reproduce."""
    from ..papers import PAPERS

    return _starting(incomplete, list(PAPERS))


def exercises(incomplete: str) -> list[str]:
    """Exercises by name."""
    from ..course.exercise import names

    return _starting(incomplete, names())


def _starting(incomplete: str, names: list[str]) -> list[str]:
    return [name for name in names if name.startswith(incomplete)]
