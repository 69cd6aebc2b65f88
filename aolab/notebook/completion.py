"""Tab completion in IPython and Jupyter: names of modules, scenes and buffers, and the parameters of a module.

>>> aolab.render("boxes", "ssao", <Tab>        # the parameters of ssao
>>> aolab.load("<Tab>                          # the scenes
"""

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from IPython.core.completer import CompletionContext
    from IPython.core.interactiveshell import InteractiveShell

CALL = re.compile(
    r"\b(render|load|explore|reference|explain|compare_modules|sweep|animate)\s*\(((?:[^()]|\([^()]*\))*)$"
)
TEXT = re.compile(r"""(["'])([^"']*)\1""")
SCENE_FIRST = ("render", "explore", "reference", "explain", "compare_modules", "sweep", "animate")


def candidates(before: str) -> list[str]:
    """The names that may follow the text `before` the cursor, which ends within a call; without the begun word.

    In a string: the scenes for the first argument, the modules for another. Elsewhere: `NAME=` for each parameter of
    the module that the call names, or of all modules if it names none.
    """
    found = CALL.search(before)
    if found is None:
        return []
    function, inside = found.groups()
    rest = TEXT.sub("", inside)
    if '"' in rest or "'" in rest:  # the cursor is in a string
        argument = rest.count(",")
        return _scenes() if function == "load" or argument == 0 else _modules()
    if function in ("load", "reference"):
        return []
    from ..modules import MODULES

    named = [text for _, text in TEXT.findall(inside) if text in MODULES]
    known = dict.fromkeys(name for module in (named[:1] or MODULES) for name in MODULES[module].stated())
    return [f"{name}=" for name in known if not re.search(rf"\b{name}\s*=", inside)]


def install(ipython: "InteractiveShell") -> None:
    """Add the candidates to the completer of a running IPython; a second call changes nothing."""
    from IPython.core.completer import SimpleCompletion, context_matcher

    matchers = ipython.Completer.custom_matchers
    if any(getattr(matcher, "matcher_identifier", "") == "aolab" for matcher in matchers):
        return

    @context_matcher(identifier="aolab")
    def matcher(context: "CompletionContext") -> dict:
        before = context.full_text[: context.cursor_position]
        word = re.search(r"[\w?=&.]*$", before)
        begun = word[0] if word else ""
        names = candidates(before[: len(before) - len(begun)])
        found = [SimpleCompletion(name, type="param" if name[-1] == "=" else "value") for name in names]
        return {"completions": [one for one in found if one.text.startswith(begun)], "matched_fragment": begun}

    matchers.append(matcher)


def _scenes() -> list[str]:
    from ..loading.named import scene_names

    return scene_names()


def _modules() -> list[str]:
    from ..modules import MODULES

    return list(MODULES)
