"""GLSL text as functions: found, emptied, exchanged."""

import pytest

from aolab.course import shader as glsl
from aolab.errors import ParameterError

TEXT = """// float hidden(int a) { return 1.0; }
float one(const in vec3 a, out float b) {
    if (a.x > 0.0) { b = 1.0; }  // }
    else if (a.y > 0.0) { b = 2.0; }
    for (int i = 0; i < 3; ++i) { b += 1.0; }
    return b;
}

void main()
{
    float c = one(vec3(0.0), d);
}
float one(float a) { return a; }
"""


def test_functions_are_found_by_signature_and_not_in_comments():
    found = glsl.functions(TEXT)
    assert [one.signature for one in found] == ["one(vec3, out float)", "main()", "one(float)"]
    whole = [TEXT[one.start : one.end] for one in found]
    assert whole[0].startswith("float one(const")
    assert whole[0].endswith("return b;\n}")
    assert whole[2] == "float one(float a) { return a; }"


def test_a_name_of_two_functions_needs_its_signature():
    with pytest.raises(ParameterError, match=r"several functions are 'one': one\(vec3, out float\), one\(float\)"):
        glsl.function(TEXT, "one")
    assert TEXT[glsl.function(TEXT, "one(float)").start :].startswith("float one(float a)")
    with pytest.raises(ParameterError, match="the function 'mian' is missing; did you mean 'main"):
        glsl.function(TEXT, "mian")


def test_a_body_is_exchanged_and_the_rest_stays():
    made = glsl.with_body(TEXT, "main", "// TODO\nreturn;")
    assert "void main()\n{\n    // TODO\n    return;\n}\nfloat one(float a)" in made
    assert made.startswith(TEXT[: TEXT.index("void main")])


def test_functions_come_from_another_text():
    other = TEXT.replace("return a;", "return 2.0 * a;").replace("return b;", "return 3.0;")
    made = glsl.with_functions(TEXT, other, ["one(float)"])
    assert "return 2.0 * a;" in made
    assert "return b;" in made


def test_an_unclosed_brace_ends_with_the_text():
    (broken,) = glsl.functions("void main() { if (true) {")
    assert broken.end == len("void main() { if (true) {")


def test_comments_and_spaces_do_not_count():
    assert glsl.same_code("return  a;// x", "return a ;")
    assert not glsl.same_code("return a;", "return b;")


def test_an_edit_has_to_be_there_once():
    assert glsl.edited("a b", {"a": "c"}, "x") == "c b"
    with pytest.raises(ParameterError, match="x: the shader has 2 times, not once: a"):
        glsl.edited("a a", {"a": "c"}, "x")


def test_a_students_own_include_is_put_in_once(tmp_path):
    (tmp_path / "mine.glsl").write_text("float mine() { return 1.0; }")
    text = '#include "mine.glsl"\n#include "mine.glsl"\n#include "lib/space.glsl"\n'
    made = glsl.with_own_includes(text, tmp_path)
    assert made.count("float mine()") == 1
    assert '#include "lib/space.glsl"' in made
