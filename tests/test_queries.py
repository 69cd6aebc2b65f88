"""`KEY=VALUE` and `NAME?KEY=VALUE&KEY=VALUE`."""

import pytest

from aolab import ParameterError
from aolab.queries import pair, query


def test_a_pair():
    assert pair("radius=0.5") == ("radius", "0.5")
    assert pair(" distance-clamp = a=b ") == ("distance_clamp", "a=b")


@pytest.mark.parametrize("text", ["radius", "=1", " =1", ""])
def test_half_a_pair_is_refused(text):
    with pytest.raises(ParameterError, match=f"'{text}' is not key=value"):
        pair(text)


def test_a_query():
    assert query("ssao") == ("ssao", {})
    assert query(" ssao?directions=32&view-scale=0.5 ") == ("ssao", {"directions": "32", "view_scale": "0.5"})
    assert query("text?line=a%20b%26c") == ("text", {"line": "a b&c"})


@pytest.mark.parametrize(
    ("text", "message"),
    [("a?b", "'b' is not key=value; write NAME"), ("a?b=1&", "'' is not"), ("a?b=1&b=2", "'b' is given twice")],
)
def test_a_wrong_query_is_refused(text, message):
    with pytest.raises(ParameterError, match=message):
        query(text)
