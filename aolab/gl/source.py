"""Shader sources: `#include`, injected constants, and a map from the compiler's line numbers back to our files."""

import re
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from math import isfinite
from pathlib import Path

from .. import paths
from ..errors import ShaderError, suggestion
from ..input import read_text

VERSION = "#version 330 core"
SUFFIXES = (".glsl", ".frag", ".vert")
_INCLUDE = re.compile(r'^\s*#\s*include\b\s*(?:"([^"]+)")?')
_CONSTANT = re.compile(r"^(\s*const\s+(int|float|bool|uint)\s+(\w+)\s*);(.*)$")
_CONDITION = re.compile(r"^\s*#\s*(?:if|elif)\b(.*)$")
_DEFINE = re.compile(r"^\s*#\s*define\s+(\w+)")
_COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
_SAMPLER = re.compile(r"^\s*uniform\s+[iu]?sampler\w+\s+(\w+)", re.MULTILINE)
# an `out` of the shader, not of a function: it ends in a semicolon and has no parenthesis beyond its layout
_OUT = re.compile(r"^\s*(?:layout\s*\([^)]*\)\s*)?out\s+(?:(?:low|medium|high)p\s+)?\w+\s+([^;(){}]+);", re.MULTILINE)

Constant = bool | int | float


@dataclass
class Source:
    """GLSL ready for the compiler. `lines[i]` is (file, line number) of line i + 1 of `text`."""

    name: str
    text: str
    lines: list[tuple[str, int]]
    files: set[Path] = field(default_factory=set)
    constants: set[str] = field(default_factory=set)

    @property
    def outs(self) -> list[str]:
        """The names of the shader's `out` variables, in the order of their declarations; an array by its bare name."""
        declared = ",".join(_OUT.findall(_COMMENT.sub("", self.text)))
        return re.findall(r"(\w+)\s*(?:\[[^\]]*\])?\s*(?:,|$)", declared)


def assemble(
    shader: str | Path,
    constants: Mapping[str, Constant] | None = None,
    aliases: Mapping[str, str] | None = None,
    name: str = "inline",
) -> Source:
    """Resolve a shader's includes and fill in its constants. Messages about GLSL text have `<name>` as its file.

    `shader` is a file under glsl/ ("ssao.frag"), the path of another file, or GLSL text (anything with a line break
    or a brace).
    An include of a file outside of glsl/ is looked up beside that file first, then under glsl/. A line
    `const int directions;` is a hole that `constants["directions"]` fills. `aliases` maps an include's name to the
    file, or to the GLSL text, that stands for it. Raises `ShaderError` for a missing file, a cycle (with its chain), a
    constant that is not given.
    """
    builder = _Builder(dict(constants or {}), dict(aliases or {}))
    builder.emit(VERSION, "glsl", 0)
    if is_text(shader):
        file = f"<{name}>"
        builder.add(file, str(shader), [])
    else:
        file = builder.include(shader, [], f"shader '{shader}'")
    return Source(file, "\n".join(builder.text) + "\n", builder.lines, builder.files, builder.used)


def is_text(shader: str | Path) -> bool:
    """Whether `shader` is GLSL text; otherwise it is the name of a file under glsl/, or the path of another file."""
    return isinstance(shader, str) and ("\n" in shader or "{" in shader)


@dataclass(frozen=True)
class Declared:
    """The names in a shader's text, at any depth of includes, whether the compiler needs them or not."""

    includes: frozenset[str]
    samplers: frozenset[str]
    files: frozenset[Path] = frozenset()  # that hold the text


def declared(shader: str | Path, aliases: Mapping[str, str] | None = None) -> Declared:
    """The includes and samplers of a shader; `aliases` as of `assemble`. An include without a file is not followed."""
    includes: set[str] = set()
    samplers: set[str] = set()
    files: set[Path] = set()
    waiting: list[tuple[str | Path, Path | None]] = [(shader, None)]
    while waiting:
        one, including = waiting.pop()
        path = None if is_text(one) else located(one, including)
        if path is None and not is_text(one):
            continue
        files |= {path} if path else set()
        text = str(one) if path is None else read_text(path, _shown(path))
        names = {match[1] for line in text.splitlines() if (match := _INCLUDE.match(line)) and match[1]}
        samplers.update(_SAMPLER.findall(_COMMENT.sub("", text)))
        waiting += [((aliases or {}).get(name, name), path) for name in names - includes]
        includes |= names
    return Declared(frozenset(includes), frozenset(samplers), frozenset(files))


def located(name: str | Path, including: Path | None) -> Path | None:
    """The file `name`, or None: under glsl/, or, if the file `including` is outside of glsl/, first beside that file.

    A shader by itself (`including` is None) may also be in the working directory; a `Path` is looked up only there.
    """
    root = paths.glsl()
    built_in = (root / name).resolve()
    places = [built_in] if built_in.is_relative_to(root) and not isinstance(name, Path) else []
    if including is None:
        places.append(Path(name).resolve())
    elif not including.is_relative_to(root):
        places.insert(0, (including.parent / name).resolve())
    return next(filter(_is_file, places), None)


def beside(shader: str | Path, module: str) -> str | Path:
    """The absolute path of a `shader` that stands in the folder of the Python module `module`; else `shader` itself."""
    file = getattr(sys.modules.get(module), "__file__", None)
    if not file or is_text(shader) or (isinstance(shader, str) and _is_file(paths.glsl() / shader)):
        return shader
    path = Path(file).parent / shader
    return path.resolve() if _is_file(path) else shader


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except (OSError, ValueError):  # no name that a file could have
        return False


def _shown(path: Path) -> str:
    """The name of a shader's file in messages: `glsl/FILE`, or its path, short if it is in the working directory."""
    for folder, prefix in ((paths.glsl(), "glsl/"), (Path.cwd(), "")):
        if path.is_relative_to(folder):
            return prefix + path.relative_to(folder).as_posix()
    return str(path)


class _Builder:
    def __init__(self, constants: dict[str, Constant], aliases: dict[str, str]) -> None:
        self.constants, self.aliases = constants, aliases
        self.text: list[str] = []
        self.lines: list[tuple[str, int]] = []
        self.files: set[Path] = set()
        self.used: set[str] = set()
        self.texts: set[str] = set()
        self.defined: set[str] = set()

    def emit(self, text: str, file: str, line: int) -> None:
        self.text.append(text)
        self.lines.append((file, line))

    def include(self, name: str | Path, chain: list[Path], where: str) -> str:
        """Add a file once, and return its name for messages; `chain` is the files that include it."""
        alias, name = str(name), self.aliases.get(str(name), name)
        if is_text(name):
            if alias not in self.texts:  # once only
                self.texts.add(alias)
                self.add(f"<{alias}>", str(name), chain)
            return f"<{alias}>"
        including = chain[-1] if chain else None
        path = located(name, including)
        if path is None:
            raise ShaderError(f"{where}: {self.missing(name, including)}")
        if path in chain:
            cycle = [*chain[chain.index(path) :], path]
            raise ShaderError(f"{where}: include cycle: {' -> '.join(one.name for one in cycle)}")
        shown = _shown(path)
        if path not in self.files:  # once only
            self.files.add(path)
            self.add(shown, read_text(path, shown), [*chain, path])
        return shown

    def missing(self, name: str | Path, including: Path | None) -> str:
        """The message about a file that is not there."""
        if isinstance(name, Path):
            return f"no file {name}"
        root = paths.glsl()
        known = [str(path.relative_to(root)) for path in root.rglob("*") if path.suffix in SUFFIXES]
        if including is None or including.is_relative_to(root):
            return f"no file 'glsl/{name}'{suggestion(name, [*known, *self.aliases])}"
        known += [path.name for path in including.parent.iterdir() if path.suffix in SUFFIXES]
        return f"no file '{name}'{suggestion(name, [*known, *self.aliases])}"

    def add(self, file: str, text: str, chain: list[Path]) -> None:
        for number, line in enumerate(text.splitlines(), start=1):
            where = f"{file}:{number}"
            if line.lstrip().startswith("#version"):
                raise ShaderError(f"{where}: leave out #version; aolab writes '{VERSION}'")
            if match := _INCLUDE.match(line):
                if not match[1]:
                    raise ShaderError(f'{where}: write #include "FILE", a path under glsl/, not: {line.strip()}')
                self.include(match[1], chain, where)
            elif match := _CONSTANT.match(line):
                self.emit(f"{match[1]} = {self.literal(match[2], match[3], where)};{match[4]}", file, number)
            else:
                if match := _DEFINE.match(line):
                    self.defined.add(match[1])
                if match := _CONDITION.match(line):
                    self.refuse_unknown(match[1], where)
                self.emit(line, file, number)

    def literal(self, kind: str, name: str, where: str) -> str:
        if name not in self.constants:
            raise ShaderError(f"{where}: constant '{name}' is not given{suggestion(name, self.constants)}")
        self.used.add(name)
        value = self.constants[name]
        if kind == "bool":
            return "true" if value else "false"
        if kind == "float" and isfinite(value):
            return repr(float(value))
        if not isfinite(value) or float(value) != int(value):
            raise ShaderError(f"{where}: constant '{name}' is {kind}, but was given {value}")
        return f"{int(value)}{'u' if kind == 'uint' else ''}"

    def refuse_unknown(self, condition: str, where: str) -> None:
        """The preprocessor takes an unknown name for 0 without a word; we do not."""
        condition = re.sub(r"//.*|defined\s*\(?\s*\w+\s*\)?", "", condition)
        for name in re.findall(r"[A-Za-z_]\w*", condition):
            if name not in self.defined and not name.startswith(("GL_", "__")):
                raise ShaderError(f"{where}: '{name}' is not defined{suggestion(name, self.defined)}")
