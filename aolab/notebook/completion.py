"""Tab completion in IPython and Jupyter: names of modules, scenes and buffers, and the parameters of a module.

>>> aolab.render("boxes", "ssao", <Tab>        # the parameters of ssao
>>> aolab.render("boxes", filter="<Tab>        # the values of a parameter
>>> module.replace(<Tab>                       # the parameters of this module
>>> aolab.load("<Tab>                          # the scenes
>>> aolab.load("toasters?<Tab>                 # the parameters of a scene, or of a module, within its text
>>> frame.show("<Tab>                          # the buffers of this frame
"""

import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, get_args

if TYPE_CHECKING:
    from IPython.core.completer import CompletionContext
    from IPython.core.interactiveshell import InteractiveShell

# a function of the package, and its arguments up to the cursor, with brackets within brackets among them
CALL = re.compile(
    r"(?:\b(\w+)\s*\.\s*)?\b(render|load|explore|reference|explain|compare_modules|compare|relighting_error|sweep"
    r"|animate|bake|show|replace)\s*\(((?:[^()]|\((?:[^()]|\([^()]*\))*\))*)$"
)
TEXT = re.compile(r"""(["'])([^"']*)\1""")
KEYWORD = re.compile(r"""(\w+)\s*=\s*[\[(]?[\s,]*["'][^"']*$""")  # of the string in which the text ends
SCENE_FIRST = (
    "render", "explore", "reference", "explain", "compare_modules", "relighting_error", "sweep", "animate", "load",
    "bake",
)  # fmt: skip
BUFFERS_OF_FRAMES = ("show", "compare")


def candidates(before: str, variables: Mapping[str, Any] | None = None, begun: str = "") -> list[str]:
    """The names that may follow the text `before` the cursor, which ends within a call; `begun` is the word after it.

    In a string: scenes, modules, buffers or the values of a parameter, by the argument; after NAME?, the parameters
    of the scene or module NAME, with this begun word. Elsewhere: `KEY=` for each parameter of the module that the
    call names, or of all modules if it names none; for `load`, those of the scene. `variables` holds the frames whose
    buffers are offered, and the modules whose parameters are.
    """
    found = CALL.search(before)
    if found is None:
        return []
    owner, function, inside = found.groups()
    rest = TEXT.sub("", inside)
    if '"' in rest or "'" in rest:  # the cursor is in a string
        keyword = KEYWORD.search(rest)
        names = _values(function, keyword[1] if keyword else "", owner or "", inside, rest, variables or {})
        return _with_parameters(begun, names) if "?" in begun else names
    names = _parameters(function, owner or "", inside, variables or {})
    return [f"{name}=" for name in names if not re.search(rf"\b{name}\s*=", inside)]


def install(ipython: "InteractiveShell") -> None:
    """Add the candidates to the completer of a running IPython; a second call changes nothing."""
    from IPython.core.completer import SimpleCompletion, context_matcher

    matchers = ipython.Completer.custom_matchers
    if any(getattr(matcher, "matcher_identifier", "") == "aolab" for matcher in matchers):
        return

    @context_matcher(identifier="aolab")
    def matcher(context: "CompletionContext") -> dict:
        # the cursor's position is that in its line
        before = "\n".join([*context.full_text.split("\n")[: context.cursor_line], context.text_until_cursor])
        word = re.search(r"[\w?=&.+]*$", before)
        begun = word[0] if word else ""
        names = candidates(before[: len(before) - len(begun)], ipython.user_ns, begun)
        found = [SimpleCompletion(name, type="param" if name[-1] == "=" else "value") for name in names]
        fitting = [one for one in found if one.text.startswith(begun)]
        # IPython offers its magic commands and all files in any string; a file fits where a scene does
        others = _MAGIC if fitting and fitting[0].text in _scenes() else _MAGIC | {"IPCompleter.file_matcher"}
        return {"completions": fitting, "matched_fragment": begun, "suppress": others if fitting else False}

    matchers.append(matcher)


_MAGIC = {f"IPCompleter.{name}" for name in ("magic_matcher", "magic_config_matcher", "magic_color_matcher")}


def _values(function: str, keyword: str, owner: str, inside: str, rest: str, variables: Mapping[str, Any]) -> list[str]:
    """The texts that fit an argument: the one with this `keyword`, or else the one at this place."""
    place = rest.count(",")
    if keyword in ("buffer", "buffers") or (function in BUFFERS_OF_FRAMES and not keyword):
        first = re.match(r"\s*(\w+)", inside)
        frame = owner if function == "show" else first[1] if first else ""
        return _buffers(function, variables.get(frame))
    if keyword in ("scene", "scenes", "source") or (not keyword and place == 0 and function in SCENE_FIRST):
        return _scenes()
    if keyword in ("module", "modules", "like") or (not keyword and function not in ("load", "bake", "reference")):
        return _modules()
    if keyword == "tone_map":
        from ..pipeline.lighting import ToneMap

        return list(get_args(ToneMap))
    return _words(keyword)


def _with_parameters(begun: str, names: list[str]) -> list[str]:
    """The words `NAME?KEY=` or `NAME?KEY=VALUE` that go on from the begun word, whose NAME is one of `names`."""
    name, _, rest = begun.partition("?")
    if name.partition("+")[0] not in names:
        return []
    *former, last = rest.split("&")
    key, equals, _ = last.partition("=")
    head = "".join(f"{one}&" for one in former)
    if equals:
        return [f"{name}?{head}{key}={word}" for word in _words(key)] if name not in _scenes() else []
    return [f"{name}?{head}{key}=" for key in _stated(name) if not re.search(rf"\b{key}=", head)]


def _parameters(function: str, owner: str, inside: str, variables: Mapping[str, Any]) -> list[str]:
    from ..modules import MODULES, Module

    if function == "replace":  # of a module; Jedi offers the parameters of the others
        module = variables.get(owner)
        return list(module.stated()) if isinstance(module, Module) else []
    texts = [text.partition("?")[0] for _, text in TEXT.findall(inside)]
    if function == "load":
        return _stated(texts[0]) if texts else []
    if function in ("reference", "compare", "bake", "show"):
        return []
    named = [_stated(text) for text in texts if text.partition("+")[0] in MODULES]
    given = [variables.get(word) for word in re.findall(r"\w+", TEXT.sub("", inside))]
    kinds = [one if isinstance(one, type) else type(one) for one in given]
    named += [list(kind.stated()) for kind in kinds if issubclass(kind, Module)]
    all_of_them = (name for module in MODULES.values() for name in module.stated())
    return named[0] if named else list(dict.fromkeys(all_of_them))


def _stated(name: str) -> list[str]:
    """The parameters of a scene or a module; [] for another name."""
    from ..errors import Error
    from ..loading.named import describe_scene, scene_names
    from ..modules import MODULES, find

    if name in scene_names():
        return list(describe_scene(name).parameters)
    try:
        return list(find(name, MODULES).stated())
    except Error:
        return []


def _words(parameter: str) -> list[str]:
    """The words that are values of a parameter, in any module."""
    from ..modules import MODULES
    from ..modules.parameters import words

    parts = [module.stated()[parameter] for module in MODULES.values() if parameter in module.stated()]
    return list(dict.fromkeys(word for part in parts for word in words(part, parameter)))


def _buffers(function: str, frame: Any) -> list[str]:
    from ..modules.buffers import BUFFERS
    from ..pipeline.frame import Frame
    from ..truth.buffers import BUFFERS as TRACED

    if isinstance(frame, Frame):
        return frame.buffers
    if function == "show":  # `aolab.show` takes frames
        return []
    return list(TRACED if function == "reference" else BUFFERS)


def _scenes() -> list[str]:
    from ..loading.named import scene_names

    return scene_names()


def _modules() -> list[str]:
    from ..modules import MODULES

    return list(MODULES)
