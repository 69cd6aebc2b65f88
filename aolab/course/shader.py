"""GLSL text as functions: an exercise empties some, and a check puts a student's beside those of the solution."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from .. import paths
from ..errors import ParameterError, suggestion

# includes that stand for one of several files, and the file of the default choice
STANDS_FOR = {"occluders.glsl": "occluders/depth.glsl", "measure.glsl": "measures/sqrt.glsl"}
_INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]+"([^"]+)"[^\n]*\n', re.MULTILINE)
_COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
_HEAD = re.compile(r"\b(\w+)\s+(\w+)\s*\(([^()]*)\)\s*\{")


@dataclass(frozen=True)
class Function:
    """A function of a text: `text[start:end]` is the whole of it, `text[body:end - 1]` the part within the braces."""

    signature: str  # as in "firstBlocked(Receiver, int, out Occluder)"
    start: int
    body: int
    end: int

    @property
    def name(self) -> str:
        return self.signature.partition("(")[0]


def functions(text: str) -> list[Function]:
    """The functions that a GLSL text defines, in order. A function whose braces do not close ends with the text."""
    plain = _COMMENT.sub(lambda comment: re.sub(r"[^\n]", " ", comment[0]), text)
    found, end = [], 0
    for head in _HEAD.finditer(plain):
        if head.start() < end or head[1] in ("else", "return"):  # within the function before
            continue
        end = _closing(plain, head.end())
        found.append(Function(f"{head[2]}({', '.join(_types(head[3]))})", head.start(), head.end(), end))
    return found


def _closing(plain: str, at: int) -> int:
    """The place behind the brace that closes the block whose inside starts at `at`."""
    depth = 1
    for brace in re.finditer(r"[{}]", plain[at:]):
        depth += 1 if brace[0] == "{" else -1
        if depth == 0:
            return at + brace.end()
    return len(plain)


def _types(parameters: str) -> list[str]:
    """The types of a list of parameters, with `out` and `inout`."""
    dropped = {"in", "const", "lowp", "mediump", "highp", "void"}
    words = [[word for word in one.split() if word not in dropped] for one in parameters.split(",")]
    return [" ".join(one[:-1] if len(one) > 1 else one) for one in words if one]


def function(text: str, name: str) -> Function:
    """The function `name` of a text; its whole signature chooses among several with one name.

    Raises `ParameterError` for a function that is missing or ambiguous.
    """
    known = functions(text)
    named = [one for one in known if name in (one.name, one.signature)]
    if not named:
        raise ParameterError(f"the function '{name}' is missing{suggestion(name, {one.name for one in known})}")
    if len(named) > 1:
        raise ParameterError(f"several functions are '{name}': {', '.join(one.signature for one in named)}")
    return named[0]


def with_body(text: str, name: str, body: str) -> str:
    """The text with another body of the function `name`; the lines of `body` are indented."""
    one = function(text, name)
    lines = "".join(f"    {line}\n" if line else "\n" for line in body.strip("\n").splitlines())
    return f"{text[: one.body]}\n{lines}{text[one.end - 1 :]}"


def with_functions(text: str, other: str, names: Iterable[str]) -> str:
    """The text with the functions `names` as they are in the text `other`."""
    for name in names:
        mine, theirs = function(text, name), function(other, name)
        text = text[: mine.start] + other[theirs.start : theirs.end] + text[mine.end :]
    return text


def same_code(a: str, b: str) -> bool:
    """Whether two texts differ in nothing but comments and spaces."""
    return _code(a) == _code(b)


def _code(text: str) -> list[str]:
    return re.findall(r"\w+|[^\w\s]", _COMMENT.sub(" ", text))


def edited(text: str, edits: Mapping[str, str], where: str) -> str:
    """The text with each key of `edits` replaced by its value. Raises `ParameterError` unless it is there once."""
    for old, new in edits.items():
        if text.count(old) != 1:
            raise ParameterError(f"{where}: the shader has {text.count(old)} times, not once: {old}")
        text = text.replace(old, new)
    return text


def assembled(shader: str, folder: Path, inline: Iterable[str]) -> str:
    """The text of a shader, with the files of `inline` in place of their includes.

    The files are looked up in `folder`, then under glsl/. An include of `STANDS_FOR` may be named by its file. Raises
    `ParameterError` for a file that is missing, or that no text includes.
    """
    wanted, used = set(inline), set[str]()

    def put(include: re.Match[str]) -> str:
        name = STANDS_FOR.get(include[1], include[1]) if include[1] not in wanted else include[1]
        if name not in wanted:
            return include[0]
        if name in used:
            return ""
        used.add(name)
        text = _INCLUDE.sub(put, source(name, folder))
        return f"// ---- from {name}\n{text}// ---- end of {name}\n"

    text = _INCLUDE.sub(put, source(shader, folder))
    if left := wanted - used:
        raise ParameterError(f"no include of {shader} leads to '{min(left)}'")
    return text


def with_own_includes(text: str, folder: Path) -> str:
    """The text with the files of `folder` in place of their includes, each once."""
    used = set[str]()

    def put(include: re.Match[str]) -> str:
        if not (folder / include[1]).is_file():
            return include[0]
        if include[1] in used:
            return ""
        used.add(include[1])
        return _INCLUDE.sub(put, (folder / include[1]).read_text(encoding="utf-8") + "\n")

    return _INCLUDE.sub(put, text)


def source(name: str, folder: Path) -> str:
    """The text of a file of `folder`, or of glsl/."""
    for place in (folder, paths.glsl()):
        if (place / name).is_file():
            return (place / name).read_text(encoding="utf-8")
    known = [str(path.relative_to(paths.glsl())) for path in paths.glsl().rglob("*.*")]
    raise ParameterError(f"no shader '{name}' in {folder} or under glsl/{suggestion(name, known)}")
