"""Plain words (CONTRIBUTING.md, "How we write"): no folder's prose has the worst breaches of the rule.

The check reads pages, docstrings, comments, messages and the names of tests. It finds only patterns that a regular
expression can find: prose without findings may still be hard to read.
"""

import ast
import io
import re
import tokenize
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
FOLDERS = ("aolab", "docs", "examples", "glsl", "scenes", "tests", "tools")
SKIPPED = ("_build", "generated")

START = r"(?:^|[.:;!?] )"  # of a sentence, or of a clause after a colon or semicolon
PERSONS = ("paper ", "papers ", "author ", "authors ", "reader ", "student ", "who ")  # those may speak
PATTERNS = [
    re.compile(START + r"[Ww]hat (?!if\b|for\b)[^.:;!?]*+(?!\?)"),  # but questions may start so
    re.compile(START + r"[Tt]hat (?:is|was|has|makes?|would|can|cannot|costs?)\b"),
    re.compile(START + r"[Oo]ne (?:of (?!the\b)|that|which|who|is|was|has|may|can|cannot|must|for|from|in|with)\b"),
    re.compile("".join(f"(?<!{person})" for person in PERSONS) + r"\b(?:says|tells|knows|asks)\b"),
    re.compile(r"\b(?i:program|shader|module|function|method|class|test|filter|pass|lab|driver) holds\b"),
]
FENCE = re.compile(r"^(```|:::).*?^\1$", re.MULTILINE | re.DOTALL)
NOT_PROSE = re.compile(r"^(#|---|\w+: )|\$\$")  # headings, front matter, equations
CODE = re.compile(r"`[^`]*`|\$[^$]*\$|\"[^\"]*\"")  # also quotations, of a paper's words


def page(text: str) -> Iterator[str]:
    """The paragraphs, list items and table cells of a Markdown page, without code."""
    for paragraph in re.split(r"\n\s*\n|\n(?=\s*(?:[-*|:]|\d+\.) ?)", FENCE.sub("", text)):
        if not NOT_PROSE.match(paragraph):
            yield from re.split(r"\s\|\s", paragraph.lstrip("-*|: \n0123456789."))


def python(text: str) -> Iterator[str]:
    """Comments (neighbouring lines as one), strings of several words, and the names of test functions as sentences."""
    comment: list[str] = []
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT:
            comment.append(token.string.lstrip("# "))
        elif token.type != tokenize.NL:
            yield " ".join(comment)
            comment = []
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value.count(" ") > 2:
            yield from re.split(r"\n\s*\n", node.value)
        elif isinstance(node, ast.FunctionDef) and node.name.startswith("test_"):
            yield node.name.removeprefix("test_").replace("_", " ")


def shader(text: str) -> Iterator[str]:
    """Comments: neighbouring whole lines as one, comments behind code one by one."""
    for block in re.findall(r"(?:^[ \t]*//.*\n)+|//.*", text, re.MULTILINE):
        yield " ".join(line.strip(" \t/") for line in block.splitlines())


READERS = {".md": page, ".py": python, ".frag": shader, ".vert": shader, ".glsl": shader}


def findings(path: Path) -> Iterator[str]:
    for paragraph in READERS[path.suffix](path.read_text(encoding="utf-8")):
        prose = CODE.sub("CODE", " ".join(paragraph.split()))
        for pattern in PATTERNS:
            for match in pattern.finditer(prose):
                yield f"{path.relative_to(ROOT)}: ...{prose[max(match.start() - 30, 0) : match.end() + 30]}..."


def by_folder() -> dict[str, list[Path]]:
    paths = [path for folder in FOLDERS for path in (ROOT / folder).rglob("*")] + list(ROOT.glob("*.md"))
    folders = defaultdict(list)
    for path in sorted(paths):
        if path.suffix in READERS and path != Path(__file__) and not set(path.parts) & set(SKIPPED):
            folders[path.parent.relative_to(ROOT).as_posix()].append(path)
    return dict(folders)


@pytest.mark.parametrize(("folder", "paths"), by_folder().items(), ids=by_folder())
def test_prose_is_in_plain_words(folder: str, paths: list[Path]) -> None:
    found = [finding for path in paths for finding in findings(path)]
    assert not found, f"{len(found)} in {folder}:\n" + "\n".join(found)
