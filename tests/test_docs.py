"""The documentation and the code agree. The pages are read as text: no Sphinx, no OpenGL."""

import re
from itertools import pairwise
from pathlib import Path

import pytest

import aolab
from aolab.modules import MODULES, Module

DOCS = Path(__file__).parent.parent / "docs"
PAGES = {path.relative_to(DOCS).as_posix(): path.read_text(encoding="utf-8") for path in DOCS.rglob("*.md")}
PAGES = {name: text for name, text in PAGES.items() if not name.startswith(("_build/", "generated/"))}

CELL = re.compile(r"^```\{code-cell\}.*?^```$", re.MULTILINE | re.DOTALL)
QUOTE = re.compile(r"^```\{(literalinclude|include)\} (\S+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
QUOTES = [(page, *match.groups()) for page, text in PAGES.items() for match in QUOTE.finditer(text)]
MARKER = re.compile(r"^:(start-at|start-after|end-at|end-before): (.+)$", re.MULTILINE)


def page_of(module: str) -> str:
    name = f"modules/{module}.md"
    assert name in PAGES, f"module '{module}' has no page docs/{name}"
    return PAGES[name]


def prose_of(page: str) -> str:
    return CELL.sub("", page)


@pytest.mark.parametrize("module", MODULES)
def test_the_page_of_a_module_has_its_facts_its_parameters_and_what_they_do(module: str) -> None:
    page = page_of(module)
    assert f"```{{module-facts}} {module}\n" in page
    assert f"```{{parameters}} {module}\n" in page
    own = MODULES[module].model_fields.keys() - Module.model_fields.keys()
    unnamed = [name for name in own if f"`{name}" not in prose_of(page)]
    assert not unnamed, f"docs/modules/{module}.md does not say what these do: {unnamed}"


@pytest.mark.parametrize("module", MODULES)
def test_the_page_of_a_module_lists_its_papers(module: str) -> None:
    listed = page_of(module).partition("\n## References\n")[2]
    cited = re.findall(r"(\w+)(?: and \w+| et al\.)? (\d{4})", MODULES[module].paper)
    assert cited, f"the paper of '{module}' is not cited as NAME YEAR: {MODULES[module].paper}"
    for author, year in cited:
        entries = [line for line in re.split(r"\n- ", listed) if author in line and year in line]
        assert entries, f"docs/modules/{module}.md, References: {author} {year} is missing"


@pytest.mark.parametrize("module", MODULES)
def test_defaults_are_not_written_a_second_time(module: str) -> None:
    for name, field in MODULES[module].model_fields.items():
        number = re.escape(str(field.default).removesuffix(".0"))
        value = rf"(?<![\w.]){number}(\.0)?(?!\w|\.\d)"
        written = re.compile(rf"^(?=.*`{name}`)(?=.*\bdefault)(?=.*{value}).*$|`{name} ?= ?{value}`", re.MULTILINE)
        again = written.search(prose_of(page_of(module)))
        assert not again, f"docs/modules/{module}.md repeats the default of {name}: {again[0] if again else ''}"


@pytest.mark.parametrize(("page", "directive", "file", "options"), QUOTES)
def test_the_quotations_of_a_page_exist(page: str, directive: str, file: str, options: str) -> None:
    source = (DOCS / page).parent / file
    assert source.is_file(), f"docs/{page} quotes {file}, which does not exist"
    assert ":lines:" not in options, f"docs/{page} quotes {file} by line numbers; use text, which moves with the code"
    rest = source.read_text(encoding="utf-8")
    markers = MARKER.findall(options)
    assert markers or directive == "include"
    for kind, marker in markers:
        marker = marker.strip('"')
        _, found, rest = rest.partition(marker)
        assert found, f"docs/{page}: {file} has no '{marker}' (:{kind}:), or not after the marker before it"
        if kind in ("start-at", "end-at"):
            rest = found + rest


@pytest.mark.parametrize(
    ("page", "directive", "file", "options"), [quote for quote in QUOTES if ":dedent:" in quote[3]]
)
def test_quoted_lines_have_the_indent_that_is_taken_from_them(
    page: str, directive: str, file: str, options: str
) -> None:
    lines = ((DOCS / page).parent / file).read_text(encoding="utf-8").splitlines()
    markers = {kind: marker.strip('"') for kind, marker in MARKER.findall(options)}
    first = next(number for number, line in enumerate(lines) if markers.get("start-at", "") in line)
    last = next((n for n in range(first, len(lines)) if "end-at" in markers and markers["end-at"] in lines[n]), first)
    width = int(re.search(r":dedent: (\d+)", options)[1])  # type: ignore[index]
    for line in lines[first : last + 1]:
        assert not line[:width].strip(), f"docs/{page} quotes '{line}' of {file}, which is not indented by {width}"


def test_pages_quote_each_modules_shader() -> None:
    for name, module in MODULES.items():
        assert any(
            page == f"modules/{name}.md" and file.endswith(f"glsl/{module.shader}") for page, _, file, _ in QUOTES
        )


LESSONS = [page for page in PAGES if page.startswith("learn/") and page != "learn/index.md"]


@pytest.mark.parametrize("page", LESSONS)
def test_a_lesson_has_a_picture_to_change_an_equation_a_line_of_a_shader_and_a_hidden_answer(page: str) -> None:
    text = PAGES[page]
    assert any("aolab.Flipbook(" in cell for cell in CELL.findall(text)), f"docs/{page}: no picture with a slider"
    assert re.search(r"^\$\$ .*\$\$ \(learn-[\w-]+\)$", text, re.MULTILINE), f"docs/{page}: no numbered equation"
    assert any(quoting == page and "/glsl/" in file for quoting, _, file, _ in QUOTES), f"docs/{page}: no shader line"
    _, _, question = text.partition("\n## Question\n")
    assert re.search(r"\?\n\n:::\{dropdown\} Answer\n", question), f"docs/{page}: no question with a hidden answer"
    assert f"<{Path(page).stem}.ipynb>`" in text, f"docs/{page}: the notebook of another page"


def test_ten_lessons_are_numbered_in_the_order_of_the_index_and_each_leads_to_the_next() -> None:
    listed = re.findall(r"^\d+\. \[(.+)\]\((\w+\.md)\)", PAGES["learn/index.md"], re.MULTILINE)
    assert sorted(f"learn/{file}" for _, file in listed) == sorted(LESSONS)
    assert len(listed) == 10
    for number, (title, file) in enumerate(listed, 1):
        assert f"\n# {number} · {title}\n" in PAGES[f"learn/{file}"]
    for (_, file), (title, following) in pairwise(listed):
        assert f"Next: [{title}]({following})" in PAGES[f"learn/{file}"]


def test_the_gallery_has_every_script() -> None:
    scripts = sorted(path.name for path in (DOCS.parent / "examples").glob("*.py"))
    offered = re.findall(r"<\.\./examples/(\w+\.py)>`", PAGES["gallery.md"])
    assert sorted(offered) == scripts
    drawn = re.findall(r'^thumbnail\(\s*"(\w+)\.py"', PAGES["gallery.md"], re.MULTILINE)
    shown = re.findall(r"^```\{glue:figure\} (\w+)\n:alt: .", PAGES["gallery.md"], re.MULTILINE)
    assert sorted(drawn) == sorted(shown)


def test_the_python_reference_names_all_that_is_public_and_no_more() -> None:
    documented = re.findall(r"^\.\. auto\w+:: aolab\.(\w+)", PAGES["api.md"], re.MULTILINE)
    assert sorted(documented) == dir(aolab)


def test_every_page_is_reached() -> None:
    trees = {
        page: re.findall(r"^```\{toctree\}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL) for page, text in PAGES.items()
    }
    reached = {"index.md"}
    for page, entries in trees.items():
        folder = Path(page).parent
        reached |= {
            (folder / f"{line}.md").as_posix() for line in "\n".join(entries).splitlines() if line[:1] not in (":", "")
        }
    assert reached == set(PAGES)
