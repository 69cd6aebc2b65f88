"""Tables of text: aligned columns, numbers on the right, missing numbers as a sign."""

import pytest

from aolab.table import table


def test_text_is_on_the_left_and_numbers_are_on_the_right():
    found = table({"": "", "rmse": ".3f", "pixels": "d"}, [("  ssao", 0.12345, 7), ("ssdo", -1.0, 1234567)])
    assert found.splitlines() == [
        "          rmse   pixels",
        "  ssao   0.123        7",
        "ssdo    -1.000  1234567",
    ]


def test_missing_numbers_and_words_among_numbers():
    found = table({"a": "", "b": ".1f"}, [("x", None), ("y", float("nan")), ("z", "none")])
    assert [line.split() for line in found.splitlines()] == [["a", "b"], ["x", "-"], ["y", "-"], ["z", "none"]]
    assert not any(line.endswith(" ") for line in found.splitlines())


def test_without_rows_the_heads_remain():
    assert table({"a": "", "b": "d"}, []) == "a  b"


def test_a_row_of_another_length_is_a_fault():
    with pytest.raises(ValueError, match="zip"):
        table({"a": "", "b": "d"}, [("x",)])
