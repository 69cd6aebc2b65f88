"""Mistakes in shaders of one's own: each example of docs/errors_in_shaders.md gives the message that the page shows."""

import re
import warnings
from pathlib import Path

import pytest

import aolab
from aolab.gl import context
from aolab.gl.report import told
from aolab.gl.source import assemble
from aolab.modules.marched import Marched

PAGE = (Path(__file__).parents[2] / "docs" / "errors_in_shaders.md").read_text(encoding="utf-8")
CASE = re.compile(
    r"^## (?P<title>.+?)\n(?:(?!^## ).)*?^```(?P<kind>glsl|python)\n(?P<code>.*?)^```\n+```text\n(?P<message>.*?)^```$",
    re.MULTILINE | re.DOTALL,
)
CASES = {match["title"]: (match["kind"], match["code"], match["message"]) for match in CASE.finditer(PAGE)}
MAIN = "void main() {\n    visibility = %s;\n}\n"
OUT = "out float visibility;\n"


def message_of(kind: str, code: str) -> str:
    """The error, or the notice, of the module `Mine` of a code block: a whole class, or a shader of a `Marched`."""
    names: dict[str, object] = {"__name__": "student"}
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            if kind == "python":
                exec("import aolab\n" + code, names)
            else:
                names["Mine"] = type("Mine", (Marched,), {"shader": code, "name": "mine", "__module__": "student"})
            mine = names["Mine"]
            assert isinstance(mine, type)
            aolab.render("boxes", mine, size=(64, 36))
        except aolab.Error as error:
            return str(error)
    return "\n".join(str(notice.message) for notice in caught)


def comparable(message: str) -> list[str]:
    """The lines of a message, without the driver's own words, the number of files, and the last digits of numbers."""
    lines = [line.partition(" error: ")[0] for line in message.strip().splitlines()]
    lines = [re.sub(r"and \d+ more", "and more", line) for line in lines]
    return [re.sub(r"\b\d+\.\d+", lambda number: f"{float(number[0]):.1f}", line) for line in lines]


@pytest.mark.parametrize("title", CASES)
def test_the_pages_example_gives_the_pages_message(gl, title):
    if "llvmpipe" not in context.renderer():
        pytest.skip("the page has the messages of Mesa")
    kind, code, message = CASES[title]
    assert comparable(message_of(kind, code)) == comparable(message)


def test_the_page_has_all_its_examples():
    assert len(CASES) >= 17
    assert len(CASES) == PAGE.count("```text\n")


# --- one message a mistake, in every driver's words

SOURCE = assemble(f"{OUT}{MAIN % 'depth + isBackground(depth)'}")
OFFERED = {"viewZ": "uniform sampler2D viewZ;"}
DEPTH = {
    "Mesa": "0:4(12): error: `depth' undeclared\n0:4(40): error: operands to arithmetic operators must be numeric",
    "Apple and AMD": "ERROR: 0:4: 'depth' : undeclared identifier\nERROR: 0:4: Use of undeclared identifier 'depth'",
    "NVIDIA": '0(4) : error C1503: undefined variable "depth"\n0(4) : error C1503: undefined variable "depth"',
}


@pytest.mark.parametrize("driver", DEPTH)
def test_an_undeclared_name_is_told_once_with_the_packages_name(driver):
    message = told(DEPTH[driver], SOURCE, OFFERED)
    assert message.count("depth") == 3  # the message, and the line with its two
    assert message.splitlines()[2] == "    → did you mean 'viewZ'? Its line: uniform sampler2D viewZ;"


@pytest.mark.parametrize(
    ("name", "remedy"),
    [
        ("radius", "the module has no parameter 'radius'; in its class: radius: Radius  (of aolab.modules.base)"),
        ("interleavedSet", 'it is defined in lib/sampling.glsl: #include "lib/sampling.glsl"'),
        ("isBlocked", 'it is defined in occluders.glsl: #include "occluders.glsl"'),
        ("viewPosat", "did you mean 'viewPosAt'? Its line: #include \"lib/space.glsl\""),
        ("visibilty", "did you mean 'visibility'?"),
        ("viewZ", "declare it: uniform sampler2D viewZ;"),
    ],
)
def test_an_undeclared_name_has_its_remedy(name, remedy):
    assert told(f"0:4(12): error: `{name}' undeclared", SOURCE, OFFERED).splitlines()[2] == f"    → {remedy}"


def test_a_name_like_no_other_has_no_remedy():
    assert len(told("0:4(12): error: `qqqq' undeclared", SOURCE, OFFERED).splitlines()) == 2


def test_warnings_stand_alone_or_not_at_all():
    warning = "0:3(2): warning: `x' used uninitialized"
    assert "uninitialized" in told(warning, SOURCE, {})
    assert "uninitialized" not in told(f"{warning}\n0:4(1): error: `y' undeclared", SOURCE, {})


# --- notices

BASE = {"title": "Mine", "name": "mine"}


def rendered(shader: str, **facts: object) -> aolab.Frame:
    """A frame of a module with this shader."""
    mine = type("Mine", (Marched,), {**BASE, "shader": shader, "__module__": "student", **facts})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", aolab.Notice)
        return aolab.render("boxes", mine, size=(64, 36), filter="none")


def test_a_module_that_is_right_has_no_notice():
    open_share = "open += isWayBlocked(receiver, i) ? 0.0 : 1.0;"
    shader = f"""
#include "lib/march.glsl"
{OUT}
void main() {{
    Receiver receiver;
    visibility = 1.0;
    if (!receiverHere(receiver)) return;
    float open = 0.0;
    for (int i = 0; i < directions; ++i) {open_share}
    visibility = open / float(directions);
}}
"""
    assert rendered(shader).notes == []
    exchanged = shader.replace("? 0.0 : 1.0", "? 1.0 : 0.0")
    assert "open and blocked exchanged" in rendered(exchanged).notes[0]


def test_a_shader_file_for_a_known_module_is_checked(tmp_path):
    file = tmp_path / "mine.frag"
    file.write_text(f"{OUT}{MAIN % '0.0'}")
    with pytest.warns(aolab.Notice, match=r"'visibility' has one value, 0, in all"):
        aolab.render("boxes", f"{file}:ssao", size=(32, 18))


def test_a_built_in_shader_is_checked_once_it_was_edited(gl, shaders):
    lab = aolab.Lab((32, 18), watch=True)
    assert lab.render("boxes", "ssao").notes == []
    path = shaders / "ssao.frag"
    path.write_text(path.read_text().replace("visibility = pow(", "visibility = 2.0 + pow("))
    with pytest.warns(aolab.Notice, match=r"'visibility' reaches from 2\.\d+ to 3"):
        lab.render("boxes", "ssao")


def test_text_without_a_line_break_is_a_shader_too():
    assert rendered("out float visibility; void main() { visibility = 0.5; }")["visibility"].min() == 0.5
