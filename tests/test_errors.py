"""The end of a message about an unknown name: the nearest known name, and all known names."""

import pytest

from aolab.errors import suggestion

KNOWN = ["ssao", "ssdo", "s3ho", "none"]


@pytest.mark.parametrize(
    ("name", "nearest"),
    [("sao", "ssao"), ("ssoa", "ssao"), ("SSAO", "ssao"), ("sdso", "ssdo"), ("S3H0", "s3ho"), ("non", "none")],
)
def test_the_nearest_name_is_suggested(name, nearest):
    assert suggestion(name, KNOWN) == f"; did you mean '{nearest}'? (known: none, s3ho, ssao, ssdo)"


@pytest.mark.parametrize("name", ["", "gtao_plus", "x"])
def test_no_name_is_suggested_where_none_is_near(name):
    assert suggestion(name, KNOWN) == "; known: none, s3ho, ssao, ssdo"
    assert suggestion(name, []) == "; known: none"
