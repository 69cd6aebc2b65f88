"""`aolab reproduce`: a picture and its numbers for each figure; unknown figures are refused before the work."""

import json
import sys

import pytest
from PIL import Image

from aolab import FileError, ParameterError
from aolab.papers import PAPERS
from aolab.papers.reproduce import figures, reproduce
from aolab.shell import cli

SMALL = (160, 90)


def written(folder, name):
    with Image.open(folder / f"{name}.png") as picture:
        size = picture.size
    return size, json.loads((folder / f"{name}.json").read_text(encoding="utf-8"))


@pytest.mark.slow
def test_a_figure_is_a_picture_and_its_numbers(gl, tmp_path):
    folder = tmp_path / "made" / "if need be"
    drawn = dict(reproduce("ssdo", "fig14", folder, SMALL))
    size, content = written(folder, "fig14")
    assert drawn == {"fig14": content}
    assert size[0] > 2 * SMALL[0]
    assert size[1] > 2 * SMALL[1]
    assert content["claim"].startswith("A smaller radius")
    assert content["holds"] is all(need["met"] for need in content["needs"])
    assert content["verdict"].startswith("holds" if content["holds"] else "DOES NOT HOLD")
    assert len(content["numbers"]["radius"]) == 4
    assert {path.name for path in folder.iterdir()} == {"fig14.png", "fig14.json"}


def test_without_a_figure_it_is_all_of_them():
    assert list(figures("ssdo")) == [
        "fig1",
        "fig3",
        "fig4",
        "fig6",
        "fig7",
        "fig9",
        "fig10",
        "fig11",
        "fig12",
        "fig13",
        "fig14",
        "table1",
    ]
    assert list(figures("ssdo", "fig7")) == ["fig7"]
    assert list(figures("s3ho")) == ["fig1", "fig3", "fig5", "fig6", "fig7", "fig8", "fig9", "table1"]


def test_an_unknown_paper_or_figure_names_the_nearest():
    with pytest.raises(ParameterError, match=r"no paper 'ssd'; did you mean 'ssdo'\?"):
        figures("ssd")
    with pytest.raises(ParameterError, match=r"paper 'ssdo' has no 'fig77' here; did you mean 'fig7'\?"):
        figures("ssdo", "fig77")


def test_files_that_cannot_be_written_are_refused_before_the_work(tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(FileError, match=r"cannot make the folder .*file"):
        next(reproduce("ssdo", "fig3", tmp_path / "file"))
    (tmp_path / "fig3.json").mkdir()
    with pytest.raises(FileError, match=r"fig3\.json: it is a folder"):
        next(reproduce("ssdo", "fig3", tmp_path))


def test_too_small_a_picture_is_refused(tmp_path):
    with pytest.raises(ParameterError, match="size = 95x54 is too small for a figure: at least 96x54"):
        next(reproduce("ssdo", "fig3", tmp_path / "none", (95, 54)))
    assert not (tmp_path / "none").exists()


def shell(monkeypatch, *arguments) -> object:
    monkeypatch.setattr(sys, "argv", ["aolab", "reproduce", *map(str, arguments)])
    with pytest.raises(SystemExit) as ended:
        cli.main()
    return ended.value.code or 0


@pytest.mark.slow
def test_the_shell_prints_claim_and_verdict(gl, monkeypatch, capsys, tmp_path):
    assert shell(monkeypatch, "ssdo", "fig14", "--size", "160x90", "-o", tmp_path) == 0
    printed = capsys.readouterr().out
    assert printed.startswith(f"{tmp_path}/fig14.png: A smaller radius")
    assert printed.rstrip().endswith(written(tmp_path, "fig14")[1]["verdict"])
    assert shell(monkeypatch, "ssdo", "fig14", "--size", "160x90", "-o", tmp_path, "--json") == 0
    assert json.loads(capsys.readouterr().out) == [written(tmp_path, "fig14")[1]]


def test_the_shells_help_names_every_paper(monkeypatch, capsys):
    assert shell(monkeypatch, "--help") == 0
    assert ", ".join(PAPERS) in " ".join(capsys.readouterr().out.split())


def test_the_shell_refuses_in_one_line(monkeypatch, capsys, tmp_path):
    assert shell(monkeypatch, "ssdo", "fig15", "-o", tmp_path) == 2
    assert capsys.readouterr().err.startswith("aolab: paper 'ssdo' has no 'fig15' here; did you mean 'fig1")
    assert list(tmp_path.iterdir()) == []
