"""The claims of S3HO's figures, held by their numbers at low resolution; times are told, and not asserted."""

from collections.abc import Callable
from functools import cache

import pytest

from aolab.papers import s3ho
from aolab.papers.figure import Figure

SIZE = (160, 90)
LESS = {
    "fig7": {"rays": 128, "seeds": 4},
    "fig8": {"size": (240, 135), "rays": 256, "seeds": 4},
    "fig9": {"seeds": 3},
    "table1": {"size": (96, 54), "repeats": 1},
}


@pytest.fixture(scope="module")
def draw(gl) -> Callable[[str], Figure]:
    """`draw("fig3")`, once for all tests that ask for it."""
    return cache(lambda name: s3ho.FIGURES[name](**{"size": SIZE, **LESS.get(name, {})}))


def test_the_table_names_every_figure_that_the_module_can_show():
    assert list(s3ho.FIGURES) == ["fig1", "fig3", "fig5", "fig6", "fig7", "fig8", "fig9", "table1"]


# --- figure 1


def test_fig1_ssao_is_a_grey_factor_that_knows_no_light(draw):
    numbers = draw("fig1").numbers
    assert 0.2 < numbers["darkened"] < 0.8
    assert numbers["darkened_with_nothing_near"] == 0
    assert numbers["brightest_factor"] <= 1.001
    assert numbers["difference_between_colours"] < 0.005  # half floats
    assert numbers["change_under_a_turned_sky"] < 0.005
    assert draw("fig1").holds


# --- figure 3


def test_fig3_what_is_occluded_from_the_blue_side_is_orange_and_the_other_way_round(draw):
    first, second = draw("fig3").numbers["red_over_blue"].values()
    assert first["open"] == pytest.approx(second["open"], rel=0.01) == pytest.approx(1, abs=0.01)
    assert first["occluded"] > 2
    assert second["occluded"] < 1 / 2
    assert draw("fig3").holds


# --- figure 5


def test_fig5_swapping_the_lamps_mirrors_the_picture(draw):
    change = draw("fig5").numbers["change_of_radiance"]
    assert change["mirrored"] < 0.01 * change["swapping"]
    assert change["mirrored"] < 0.05 * change["occlusion"]
    assert draw("fig5").holds


def test_fig5_the_shadows_take_the_colour_of_the_lamp_on_their_side(draw):
    ratio = draw("fig5").numbers["red_over_green"]
    assert min(ratio["pink left"]["p1"], ratio["pink right"]["p2"]) > 1.5 * ratio["pink left, open"]["p1"] > 2
    assert max(ratio["pink left"]["p2"], ratio["pink right"]["p1"]) < ratio["pink left, open"]["p2"] / 1.5 < 1 / 2
    assert ratio["pink left"] == pytest.approx(
        {"p1": ratio["pink right"]["p2"], "p2": ratio["pink right"]["p1"]}, rel=0.1
    )


# --- figure 6


def test_fig6_shadows_away_from_the_sun_are_darker_and_bluer_than_ssaos(draw):
    away = draw("fig6").numbers["away from the sun"]
    assert away["pixels"] > 100
    assert away["luminance"] < 0.7
    assert away["blue_over_red"]["S3HO"] > 1.5 * away["blue_over_red"]["SSAO"]


def test_fig6_shadows_towards_the_sun_are_lighter_and_yellower(draw):
    towards = draw("fig6").numbers["towards the sun"]
    assert towards["pixels"] > 100
    assert towards["luminance"] > 1.25
    assert towards["blue_over_red"]["S3HO"] < towards["blue_over_red"]["SSAO"]
    assert draw("fig6").holds


# --- figures 7 and 8


@pytest.mark.parametrize("kind", ["raw", "raw_in_shadows", "filtered"])
def test_fig7_s3ho_has_a_fraction_of_ssdos_noise(draw, kind):
    noise = {name: kinds[kind] for name, kinds in draw("fig7").numbers["noise"].items()}
    assert noise["S3HO"] < 0.5 * noise["SSDO"]
    assert noise["SSDO"] < noise["SSDO, sharp map"]


def test_fig7_s3ho_and_ssdo_have_the_rays_colours_in_shadows(draw):
    error = draw("fig7").numbers["colour_error_in_shadows"]
    assert max(error["S3HO"], error["SSDO"]) < 0.7 * error["SSAO"]
    assert draw("fig7").holds


@pytest.mark.parametrize("name", ["SSBN", "SSBN, uniform"])
def test_fig8_ssbn_gives_both_sides_of_a_corner_too_nearly_one_colour(draw, name):
    numbers = draw("fig8").numbers
    apart = numbers["colour_between_the_sides"]
    assert apart[name] < 0.9 * apart["rays"]
    assert apart[name] < 0.8 * apart["S3HO"]
    assert numbers["colour_error_in_corners"][name] > 1.2 * numbers["colour_error_in_corners"]["S3HO"]


def test_fig8_with_few_directions_s3ho_is_smooth_and_keeps_its_colours(draw):
    few = draw("fig8").numbers["with_8_directions"]
    assert few["S3HO"]["filtered_noise"] < 0.5 * few["SSDO"]["filtered_noise"]
    assert few["S3HO"]["change_of_colour"] < 0.5 * few["SSDO"]["change_of_colour"]
    assert draw("fig8").holds


# --- figure 9


def test_fig9_with_the_sun_in_the_environment_s3ho_has_a_fraction_of_ssdos_noise(draw):
    noise = {name: kinds["ambient_and_bounce"] for name, kinds in draw("fig9").numbers["noise"]["sun and sky"].items()}
    assert noise["S3HO"] < 0.25 * noise["SSDO"]
    assert noise["SSDO"] < noise["SSDO, sharp map"]
    assert draw("fig9").holds


def test_fig9_under_an_even_sky_s3ho_has_as_much_noise_as_ssdo(draw):
    """As the docstring says: there the noise is the bounce's, and not the environment's."""
    noise = draw("fig9").numbers["noise"]["sky"]
    for kind in ("ambient_and_bounce", "bounce"):
        assert noise["S3HO"][kind] == pytest.approx(noise["SSDO"][kind], rel=0.25)


# --- table 1: only that it is measured


def test_table1_stands_beside_the_papers(draw):
    figure = draw("table1")
    rows = figure.numbers["rows"]
    methods = ["SSAO", "S3HO", "SSDO", "SSBN", "S3HO + bounce"]
    assert [(row["directions"], row["method"]) for row in rows] == [(n, name) for n in (8, 16, 32) for name in methods]
    for row in rows:
        (ssao,) = (one for one in rows if one["method"] == "SSAO" and one["directions"] == row["directions"])
        assert row["ratio"] == pytest.approx(row["pass"] / ssao["pass"])
        assert row["frame_ratio"] == pytest.approx(row["frame"] / ssao["frame"])
        assert row["frame"] > row["pass"] > 0
    assert list(figure.numbers["in_order"]) == [8, 16, 32]
    assert figure.numbers["renderer"]


def test_table1s_printed_ratios(draw):
    rows = draw("table1").numbers["rows"]
    printed = {name: [row["paper_ratio"] for row in rows if row["method"] == name] for name in ("S3HO", "SSDO", "SSBN")}
    assert printed["S3HO"] == pytest.approx([1.072, 1.060, 1.057], abs=1e-3)
    assert printed["SSDO"] == pytest.approx([1.464, 1.526, 1.548], abs=1e-3)
    assert printed["SSBN"] == pytest.approx([1.0, 1.023, 1.027], abs=1e-3)
    assert rows[-1]["paper_ratio"] == pytest.approx(59 / 26.3)
