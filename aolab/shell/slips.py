"""Common slips on the command line, and the line that was meant."""

from itertools import takewhile

SEPARATORS = {"--size": "x", "--eye": ",", "--target": ",", "--up": ","}  # of an option's numbers
PARAMETERS_BY_NAME = {"compare": '--modules "ssao?{}={}"'}  # commands without --set


def meant(message: str, arguments: list[str]) -> str | None:
    """A better message than typer's `message` about `arguments`, with the right line; None if there is none."""
    if message.startswith("No such command") and arguments:
        return _command(arguments[0])
    if message.startswith(("No such option", "Got unexpected extra argument", "--set", "size = ", "--")):
        return _spaces(arguments) or _option(message, arguments) or _extra(message, arguments)
    return None


def _command(word: str) -> str:
    """`aolab boxes` and `aolab rendr`."""
    from ..errors import suggestion
    from ..loading import scene_names
    from .app import COMMANDS

    if word.endswith(".png"):
        return f"no command '{word}': to repeat a picture, write: aolab render --like {word}"
    if word.partition("?")[0] in scene_names() or "." in word:
        return f"no command '{word}': to render a scene, write: aolab render {word}"
    return f"no command '{word}'{suggestion(word, [command.__name__ for command in COMMANDS])}"


def _spaces(arguments: list[str]) -> str | None:
    """`--set radius 0.5`, `--size 640 360` and `--eye 0 1 -4`."""
    for index, option in enumerate(arguments):
        rest = arguments[index + 1 :]
        if option == "--set" and len(rest) > 1 and "=" not in rest[0] and not rest[1].startswith("--"):
            return f"--set {rest[0]} {rest[1]}: write --set {rest[0]}={rest[1]}"
        words = list(takewhile(_is_number, rest))
        if option in SEPARATORS and len(words) > 1:
            return f"{option} {' '.join(words)}: write {option} {SEPARATORS[option].join(words)}"
    return None


def _option(message: str, arguments: list[str]) -> str | None:
    """`--radius 0.5`, where `radius` is a parameter of a module."""
    from ..modules import MODULES

    if not message.startswith("No such option"):
        return None
    for index, argument in enumerate(arguments):
        name, _, value = argument.removeprefix("--").partition("=")
        key = name.replace("-", "_")
        if not argument.startswith("--") or argument.partition("=")[0] not in message.split():
            continue
        if any(key in module.stated() for module in MODULES.values()):
            value = value or (arguments[index + 1] if len(arguments) > index + 1 else "VALUE")
            line = PARAMETERS_BY_NAME.get(arguments[0], "--set {}={}").format(key, value)
            return f"no option --{name}: {key} is a parameter of modules; write {line}"
    return None


def _extra(message: str, arguments: list[str]) -> str | None:
    """`render boxes ssao`."""
    from ..modules import MODULES

    for word in arguments[1:]:
        name = word.partition("?")[0].lower()
        if message.startswith("Got unexpected extra") and name in MODULES and f"({word}" in message:
            return f"unexpected '{word}': a module is an option; write --module {name}{word[len(name) :]}"
    return None


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
