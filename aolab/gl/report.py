"""The compiler's report in our files and lines: one message a mistake, with a remedy where it is known."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from difflib import SequenceMatcher

from .source import Source
from .words import remedy

FORMS = 3  # of an overloaded function, those nearest to the call

# Mesa "0:12(5): error: ...", Apple and AMD "ERROR: 0:12: ...", NVIDIA "0(12) : error ..."
_PLACED = re.compile(r"^(?:ERROR:\s*)?\d+(?::(?P<line>\d+)(?:\(\d+\))?|\((?P<nvidia>\d+)\))\s*:\s*(?P<rest>.*)$")
_TITLES = {"vertex_shader", "geometry_shader", "fragment_shader", "Program"}
_CANDIDATE = re.compile(r"^error:\s{2,}(?P<form>\S.*)$")
_CALL = re.compile(r"no matching function for call to [`'](?P<name>\w+)\((?P<types>.*?)\)'")
_UNKNOWN = re.compile(
    r"[`'](?P<before>\w+)'\s*:?\s*undeclared|undefined variable \"(?P<nvidia>\w+)\""
    r"|no function with name '(?P<function>\w+)'|undeclared identifier '(?P<after>\w+)'"
)
_UNKNOWN_TYPE = re.compile(r"syntax error, unexpected (?:NEW_)?IDENTIFIER|syntax error.*'(\w+)'")
_NO_SEMICOLON = re.compile(r"^[^#/]*[\w)\]]$")


@dataclass(frozen=True)
class _Message:
    text: str
    number: int = 0  # the line of the source, from 1 on; 0 is none
    forms: tuple[str, ...] = ()

    @property
    def unknown(self) -> str:
        """The undeclared name that the message is about, or ""."""
        match = _UNKNOWN.search(self.text)
        return next(filter(None, match.groups()), "") if match else ""

    @property
    def follows(self) -> bool:
        """Whether the message is about the value of a mistake that has a message of its own."""
        call = _CALL.search(self.text)
        return bool(call and "error" in call["types"].split(", "))


def told(report: str, source: Source, offered: Mapping[str, str]) -> str:
    """The driver's `report` about a `source`: `FILE:LINE: message`, the line itself, and a remedy where it is known.

    `offered` has the declaration of each name that the shader may declare. A further message about the same line or
    the same undeclared name is left out; so are warnings beside errors.
    """
    messages = _first_ones(_read(report, len(source.lines)))
    lines = source.text.splitlines()
    shown = []
    for message in messages:
        if not message.number:
            shown.append(message.text)
            continue
        file, number = source.lines[message.number - 1]
        shown += [f"{file}:{number}: {_with_forms(message)}", f"    {lines[message.number - 1].strip()}"]
        shown += [f"    → {hint}" for hint in [_hint(message, source, offered)] if hint]
    return "\n".join(shown)


def _read(report: str, lines: int) -> Iterable[_Message]:
    """The messages of a report, with the forms of overloaded functions at the call that they are about."""
    found: list[_Message] = []
    for line in report.splitlines():
        placed = _PLACED.match(line)
        number = int(placed["line"] or placed["nvidia"]) if placed else 0
        if not placed or not 1 <= number <= lines:
            if line.strip() and set(line.strip()) != {"="} and not _is_title(line.strip()):
                found.append(_Message(line))
        elif found and (form := _CANDIDATE.match(placed["rest"])):
            found[-1] = replace(found[-1], forms=(*found[-1].forms, form["form"]))
        else:
            found.append(_Message(placed["rest"].strip(), number))
    return found


def _is_title(line: str) -> bool:
    return line in _TITLES or line.startswith(("GLSL Compiler failed", "GLSL Linker failed"))


def _first_ones(messages: Iterable[_Message]) -> list[_Message]:
    """One message a mistake: those that follow from another one are left out."""
    messages = list(messages)
    kept = [message for message in messages if not message.follows and "warning" not in message.text] or messages
    first, lines, names = [], set(), set()
    for message in kept:
        name = message.unknown
        if message.number and (name in names if name else message.number in lines):
            lines.add(message.number)
            continue
        lines.add(message.number)
        names.add(name)
        first.append(message)
    return first


def _with_forms(message: _Message) -> str:
    """The message about a call, with the forms of the function that are nearest to the call."""
    call = _CALL.search(message.text)
    if not message.forms or not call:
        return message.text
    wanted = call["types"].split(", ")

    def nearness(form: str) -> tuple[bool, float, int]:
        types = form.partition("(")[2].rstrip(")").split(", ")
        return types[0] == wanted[0], SequenceMatcher(None, types, wanted).ratio(), -abs(len(types) - len(wanted))

    nearest = sorted(message.forms, key=nearness, reverse=True)[:FORMS]
    rest = f" and {len(message.forms) - FORMS} more" if len(message.forms) > FORMS else ""
    return f"{message.text.partition('; candidates')[0]}; there are {', '.join(nearest)}{rest}"


def _hint(message: _Message, source: Source, offered: Mapping[str, str]) -> str:
    """The remedy of a message, or ""."""
    lines = source.text.splitlines()
    if name := message.unknown:
        return remedy(name, source.text, offered)
    if "syntax error" not in message.text:
        return ""
    if "end of file" in message.text:
        return "is there a closing brace missing?" if source.text.count("{") > source.text.count("}") else ""
    before = next((line.strip() for line in reversed(lines[: message.number - 1]) if line.strip()), "")
    if _NO_SEMICOLON.match(before.partition("//")[0].strip()):
        return f"is there a semicolon missing before? {before}"
    if _UNKNOWN_TYPE.search(message.text):
        code = lines[message.number - 1].partition("//")[0]
        hints = (remedy(word, source.text, {}, near=False) for word in re.findall(r"[A-Za-z_]\w*", code))
        return next(filter(None, hints), "")
    return ""
