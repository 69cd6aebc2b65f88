"""Files that are written: refused before the work where they cannot be, replaced as a whole where they can."""

import json
import os
import stat
import sys

import numpy as np
import pytest
from PIL import Image

from aolab import FileError
from aolab.output import check_writable, replacing
from aolab.pictures.metadata import read_png, save_png

PICTURE = np.zeros((2, 3, 3), np.uint8)


def entries(folder) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_a_file_is_replaced_when_complete(tmp_path):
    path = tmp_path / "a.txt"
    path.write_text("old")
    with replacing(path) as file:
        file.write(b"new")
        file.flush()
        assert path.read_text() == "old"
    assert path.read_text() == "new"
    assert entries(tmp_path) == ["a.txt"]


@pytest.mark.parametrize("error", [OSError(28, "No space left on device"), ValueError("broken"), KeyboardInterrupt()])
def test_the_old_file_survives_a_failure_and_nothing_is_left_behind(tmp_path, error):
    path = tmp_path / "a.txt"
    path.write_text("old")
    expected = FileError if isinstance(error, OSError) else type(error)

    def fail() -> None:
        with replacing(path) as file:
            file.write(b"half of the n")
            raise error

    with pytest.raises(expected) as caught:
        fail()
    if isinstance(error, OSError):
        assert str(caught.value) == f"cannot write {path}: No space left on device"
    assert path.read_text() == "old"
    assert entries(tmp_path) == ["a.txt"]


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX permissions")
def test_permissions_are_those_of_any_new_file(tmp_path):
    with replacing(tmp_path / "a"):
        pass
    (tmp_path / "b").touch()
    assert stat.S_IMODE((tmp_path / "a").stat().st_mode) == stat.S_IMODE((tmp_path / "b").stat().st_mode)


def test_what_is_in_the_way_is_named(tmp_path, monkeypatch):
    (tmp_path / "file").touch()
    (tmp_path / "folder").mkdir()
    for path, reason in (
        (tmp_path / "missing" / "a.png", "the folder .*missing does not exist"),
        (tmp_path / "file" / "a.png", "file is not a folder"),
        (tmp_path / "folder", "it is a folder"),
    ):
        with pytest.raises(FileError, match=rf"cannot write {path}: .*{reason}"):
            check_writable(path)
    monkeypatch.setattr(os, "access", lambda path, mode: False)  # root may write anywhere
    with pytest.raises(FileError, match=r"a\.png: no permission to write in "):
        check_writable(tmp_path / "a.png")


def test_a_picture_knows_how_it_was_made(tmp_path):
    info = {"module": "ssao", "parameters": {"radius": 0.1, "name": "Größe"}, "size": [3, 2]}
    save_png(tmp_path / "a.png", PICTURE, info)
    assert read_png(tmp_path / "a.png") == info
    with Image.open(tmp_path / "a.png") as image:
        np.testing.assert_array_equal(np.asarray(image), PICTURE)


def test_pictures_are_png(tmp_path):
    with pytest.raises(FileError, match=r"a\.jpg: images are written as \.png"):
        save_png(tmp_path / "a.jpg", PICTURE, {})


def test_a_frame_saves_itself_with_all_that_made_it(lab, boxes, tmp_path):
    frame = lab.render(boxes, "ssao", seed=4)
    frame.save(tmp_path / "a.png")
    assert read_png(tmp_path / "a.png") == json.loads(json.dumps(frame.info))
    with Image.open(tmp_path / "a.png") as image:
        np.testing.assert_array_equal(np.asarray(image), frame.image)


def test_pictures_of_others_are_refused_by_name(tmp_path):
    path = tmp_path / "a.png"
    with pytest.raises(FileError, match=r"no file .*a\.png"):
        read_png(path)
    path.write_bytes(b"not a picture")
    with pytest.raises(FileError, match=r"cannot read .*a\.png as PNG"):
        read_png(path)
    Image.fromarray(PICTURE).save(path)
    with pytest.raises(FileError, match=r"a\.png has no aolab metadata: it was not saved by aolab"):
        read_png(path)
    from PIL.PngImagePlugin import PngInfo

    text = PngInfo()
    text.add_text("aolab", "{half")
    Image.fromarray(PICTURE).save(path, pnginfo=text)
    with pytest.raises(FileError, match=r"a\.png: its aolab metadata is damaged"):
        read_png(path)
