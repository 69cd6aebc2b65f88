"""Files that are written: refused before the work where they cannot be, replaced as a whole where they can."""

import json
import os
import stat
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from aolab import FileError
from aolab.output import check_writable, replacing
from aolab.pictures.metadata import read_png, save_png

posix = pytest.mark.skipif(os.name != "posix", reason="devices, pipes, links and signals of POSIX")
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


def test_the_message_names_the_obstacle(tmp_path, monkeypatch):
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


def test_a_picture_contains_how_it_was_made(tmp_path):
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
    if os.name == "posix":
        os.mkfifo(tmp_path / "pipe.png")
        with pytest.raises(FileError, match=r"pipe\.png is a named pipe"):
            read_png(tmp_path / "pipe.png")
    path.write_bytes(b"not a picture")
    with pytest.raises(FileError, match=r"a\.png is no readable PNG"):
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


# --- links, devices, and files that a killed process left


@posix
def test_a_link_is_followed(tmp_path):
    (tmp_path / "elsewhere").mkdir()
    for link, target in (("a.txt", "elsewhere/b.txt"), ("dangling.txt", "elsewhere/new.txt")):
        (tmp_path / link).symlink_to(tmp_path / target)
    (tmp_path / "elsewhere/b.txt").write_text("old")
    for link in ("a.txt", "dangling.txt"):
        with replacing(tmp_path / link) as file:
            file.write(b"new")
        assert (tmp_path / link).is_symlink()
    assert entries(tmp_path / "elsewhere") == ["b.txt", "new.txt"]
    assert (tmp_path / "elsewhere/b.txt").read_text() == (tmp_path / "elsewhere/new.txt").read_text() == "new"
    (tmp_path / "lost").symlink_to(tmp_path / "missing/a.txt")
    with pytest.raises(FileError, match=r"lost: it links to a file in .*missing, which does not exist"):
        check_writable(tmp_path / "lost")


@posix
def test_a_device_and_a_pipe_are_written_to(tmp_path, full_device):
    (tmp_path / "link").symlink_to(full_device)
    for path in (full_device, tmp_path / "link"):
        with pytest.raises(FileError, match=rf"cannot write {path}: No space left on device"), replacing(path) as file:
            file.write(b"lost")
    assert stat.S_ISCHR(os.lstat(full_device).st_mode)
    assert (tmp_path / "link").is_symlink()
    os.mkfifo(tmp_path / "pipe")
    reader = os.open(tmp_path / "pipe", os.O_RDONLY | os.O_NONBLOCK)
    with replacing(tmp_path / "pipe") as file:
        file.write(b"through")
    assert os.read(reader, 100) == b"through"
    os.close(reader)
    assert stat.S_ISFIFO((tmp_path / "pipe").stat().st_mode)


@posix
def test_a_buffer_goes_through_to_a_device(lab, boxes, full_device):
    with pytest.raises(FileError, match=r"cannot write .*full: No space left on device"):
        lab.render(boxes, "ssao").save_buffers(full_device)


KILLED = """
import os, signal
from aolab.output import replacing
with replacing("a.txt") as file:
    file.write(b"half")
    file.flush()
    {ending}
"""


@posix
def test_the_file_of_a_killed_process_is_removed_next_time(python, tmp_path):
    (tmp_path / "a.txt").write_text("old")
    assert python(KILLED.format(ending="os.kill(os.getpid(), signal.SIGKILL)")).returncode == -9
    assert len(entries(tmp_path)) == 2
    with replacing(tmp_path / "b.txt"):
        pass
    assert entries(tmp_path) == ["a.txt", "b.txt"]
    assert (tmp_path / "a.txt").read_text() == "old"


@posix
def test_the_file_of_a_living_process_stays(tmp_path):
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[1])}
    writing = KILLED.format(ending="print('now', flush=True); input()")
    command = [sys.executable, "-c", writing]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    with subprocess.Popen(command, cwd=tmp_path, env=environment, **pipes) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "now\n"
        with replacing(tmp_path / "b.txt"):
            pass
        process.communicate("\n")
    assert process.returncode == 0
    assert entries(tmp_path) == ["a.txt", "b.txt"]
    assert (tmp_path / "a.txt").read_text() == "half"


def test_a_name_that_no_file_can_have_is_refused(tmp_path):
    with pytest.raises(FileError, match=r"cannot write x{40}\.\.\.: the name has more than 255 bytes"):
        check_writable(tmp_path / ("x" * 300))
    with pytest.raises(FileError, match="cannot write"):
        check_writable(f"{tmp_path}/a\0b")
    long = tmp_path / ("é" * 125 + ".txt")  # 254 bytes: the temporary file's name is no longer
    with replacing(long) as file:
        file.write(b"x")
    assert long.read_text() == "x"
