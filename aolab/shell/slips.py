"""Common slips on the command line, and the line that was meant."""

from itertools import takewhile

SEPARATORS = {"--size": "x", "--eye": ",", "--target": ",", "--up": ","}  # of an option's numbers
MODULE = {"compare": "--modules {}", "tune": "tune {}", "modules": "modules {}"}  # others: --module
PARAMETER = {"compare": '--modules "ssao?{}"', "bench": "aolab render --set {}"}  # others: --set
WITHOUT = {  # commands without an option for a module
    "sweep": "the scene, the module and its parameters stand in a file: aolab sweep SPEC.toml (docs/sweeps.md)",
    "bench": "`aolab bench` measures every module",
    "bake": "`aolab bake` traces rays, without a module",
    "reproduce": "a figure has its own scenes and modules; write aolab render boxes --module ssao",
}
OPTIONS = {"help": "--help", "version": "--version"}  # words that people write as commands
PYTHON = (
    "load",
    "show",
    "explain",
    "explore",
    "microscope",
    "glyph",
    "glyph_picker",
    "relighting_error",
    "contact_sheet",
)
WANTED = {  # arguments that are missing
    "SCENE": "which scene? Name one (`aolab scenes` lists them), or a model file",
    "MODULE": "which module? Name one (`aolab modules` lists them)",
    "PAPER": "which paper? Name one, as in `aolab reproduce s3ho` (`aolab reproduce --help` lists them)",
    "SPEC.toml": "which cases? Name a file (docs/sweeps.md describes it)",
    "NAME": "which exercise? Name one (`aolab exercise list` lists them)",
}


def meant(message: str, arguments: list[str]) -> str | None:
    """A better message than typer's `message` about `arguments`, with the right line; None if there is none."""
    if message.startswith("No such command") and arguments:
        return _subcommand(arguments) if arguments[0] == "exercise" else _command(arguments[0])
    if message.startswith("Missing argument"):
        return WANTED.get(message.split("'")[1])
    if message.startswith(("No such option", "Got unexpected extra argument", "--set", "size = ", "--")):
        return _spaces(arguments) or _option(message, arguments) or _extra(message, arguments)
    if message.startswith("no file") and arguments[0] == "sweep":
        return f"{message}: {WITHOUT['sweep']}"
    return None


def _command(word: str) -> str:
    """`aolab boxes`, `aolab ssao`, `aolab help`, `aolab explain` and `aolab rendr`."""
    from ..errors import nearest, suggestion
    from ..loading import scene_names
    from ..modules import MODULES
    from .app import NAMES

    name = word.partition("?")[0]
    if word.lower() in OPTIONS:
        return f"no command '{word}': write: aolab {OPTIONS[word.lower()]}"
    if word.endswith(".png"):
        return f"no command '{word}': to repeat a picture, write: aolab render --like {word}"
    if name in scene_names() or "." in word:
        return f"no command '{word}': to render a scene, write: aolab render {word}"
    if word in PYTHON:
        return f"no command '{word}': it is a function in Python, aolab.{word}(...){suggestion(word, NAMES)}"
    if nearest(word, NAMES) is None:
        if scene := nearest(name, scene_names()):
            return f"no command '{word}': to render a scene, write: aolab render {scene}{word[len(name) :]}"
        if module := nearest(name, MODULES):
            return f"no command '{word}': a module needs a scene; write: aolab render boxes --module {module}"
    return f"no command '{word}'{suggestion(word, NAMES)}"


def _subcommand(arguments: list[str]) -> str:
    """`aolab exercise chek`."""
    from ..errors import suggestion
    from .exercise import NAMES

    word = arguments[1]
    return f"no command 'exercise {word}'{suggestion(word, NAMES)}"


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
    """`--radius 0.5`, where `radius` is a parameter of a module, and options of other commands."""
    if not message.startswith("No such option"):
        return None
    for index, argument in enumerate(arguments):
        option, _, value = argument.partition("=")
        if not argument.startswith("--") or option not in message.replace(":", " ").split():
            continue
        value = value or (arguments[index + 1] if len(arguments) > index + 1 else "")
        key = option.removeprefix("--").replace("-", "_")
        absent = ("module", "modules") if arguments[0] in PARAMETER else ("module", "modules", "set", "scene")
        if key in absent and arguments[0] in WITHOUT:
            return f"no option {option} here: {WITHOUT[arguments[0]]}"
        if key in ("module", "modules"):
            return f"no option {option} here; write {_module(arguments[0], value or 'NAME')}"
        if key == "set" and arguments[0] in PARAMETER:
            return f"no option --set here; write {PARAMETER[arguments[0]].format(value or 'KEY=VALUE')}"
        if key == "scene":
            return f"no option --scene: the scene is an argument; write aolab {arguments[0]} {value or 'SCENE'}"
        if _is_parameter(key):
            line = PARAMETER.get(arguments[0], "--set {}").format(f"{key}={value or 'VALUE'}")
            return f"no option {option}: {key} is a parameter of modules; write {line}"
    return None


def _extra(message: str, arguments: list[str]) -> str | None:
    """`render boxes ssao`, `compare boxes ssao,ssdo`, `render boxes radius=0.5` and `bench boxes`."""
    from ..errors import nearest
    from ..loading import scene_names
    from ..modules import MODULES

    if not message.startswith("Got unexpected extra"):
        return None
    for word in message.rpartition("(")[2].rstrip(")").split():
        if _is_parameter(word.partition("=")[0]) and "=" in word:
            return f"unexpected '{word}': write {PARAMETER.get(arguments[0], '--set {}').format(word)}"
        written = [name.partition("?") for name in word.split(",")]
        names = [nearest(name, MODULES) for name, _, _ in written]
        if None not in names:
            if arguments[0] in WITHOUT:
                return f"unexpected '{word}': {WITHOUT[arguments[0]]}"
            found = ",".join(f"{name}{mark}{rest}" for name, (_, mark, rest) in zip(names, written, strict=True))
            return f"unexpected '{word}': a module is an option; write {_module(arguments[0], found)}"
        if arguments[0] == "scenes" and word.partition("?")[0] in scene_names():
            return f"unexpected '{word}': this command lists all scenes; to render one, write: aolab render {word}"
        if arguments[0] == "bench" and word in scene_names():
            return f"unexpected '{word}': here a scene is an option; write --scene {word}"
        if word.partition("?")[0] in scene_names():
            return f"unexpected '{word}': a command takes one scene; write aolab {arguments[0]} {word}"
    return None


def _module(command: str, name: str) -> str:
    return MODULE.get(command, "--module {}").format(name)


def _is_parameter(key: str) -> bool:
    from ..modules import MODULES

    return any(key in module.stated() for module in MODULES.values())


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
