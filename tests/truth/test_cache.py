"""References on disk: found again by content, made anew when damaged, whole after a kill."""

import os
import shutil
import subprocess
import sys

import numpy as np
import pytest

import aolab
from aolab.errors import Notice
from aolab.truth import cache, reference

from .rooms import quad, scene, wall_scene

SIZE = (32, 24)


def visibility(what=None, **arguments):
    return reference(what or wall_scene(), size=SIZE, **{"rays": 8, "buffers": "visibility", **arguments})["visibility"]


def entries(folder):
    return sorted(folder.glob("*.npz"))


def test_the_second_call_reads_what_the_first_one_wrote(cache_folder):
    first = visibility()
    (entry,) = entries(cache_folder)
    np.savez(entry, visibility=first / 2, standard_error=first)  # only somebody who reads it can see this
    np.testing.assert_array_equal(visibility(), first / 2)
    np.testing.assert_array_equal(visibility(cache=False), first)


def test_whatever_changes_the_result_changes_the_entry(cache_folder):
    mesh = quad((0, 0, 0), (1, 0, 0), (0, 1, 0))
    camera = aolab.Camera((0, 0, 5), (0, 0, 0))
    moved = [
        aolab.Scene((aolab.Instance(mesh, transform),), camera=camera)
        for transform in (np.eye(4), np.diag([2.0, 1, 1, 1]))
    ]
    textures = [aolab.Texture(np.full((1, 1, 4), value, np.uint8)) for value in (100, 200)]
    painted = [scene(quad((0, 0, 0), (1, 0, 0), (0, 1, 0), material=aolab.Material(texture=t))) for t in textures]
    calls = [
        {},
        {"seed": 1},
        {"rays": 4},
        {"radius": 1.0},
        {"radius": 1.0, "falloff": 0.5},
        {"engine": "numpy"},
        {"camera": aolab.Camera((1.6, 3, 0), (1.2, 0, 0), up=(0, 0, -1), fov=21)},
        {"what": wall_scene(floor_albedo=0.7)},
        {"what": wall_scene(environment=aolab.Environment.constant(0.5))},
        {"what": wall_scene(lights=(aolab.PointLight((1, 1, 1)),))},
        {"what": wall_scene(lights=(aolab.PointLight((1, 1, 2)),))},
        *({"what": one} for one in [*painted, *moved]),
    ]
    for number, arguments in enumerate(calls, start=1):
        what = arguments.pop("what", wall_scene())
        reference(what, size=SIZE, **{"rays": 8, "buffers": "visibility", **arguments})
        assert len(entries(cache_folder)) == number, f"call {number} found another's entry"
    visibility()
    assert len(entries(cache_folder)) == len(calls)


def test_one_buffer_of_a_stored_reference_is_read_and_a_further_one_is_added(cache_folder):
    room, names = wall_scene(environment=aolab.Environment.sky()), ("visibility", "ambient", "bent_normal", "indirect")
    whole = reference(room, size=SIZE, rays=8, buffers=names)
    assert not whole.info["cached"]
    for name in names:
        one = reference(room, size=SIZE, rays=8, buffers=name)
        assert one.info["cached"]
        np.testing.assert_array_equal(one[name], whole[name])
    more = reference(room, size=SIZE, rays=8, buffers=("ambient", "sh0"))
    assert not more.info["cached"]
    assert reference(room, size=SIZE, rays=8, buffers=("sh0", *names)).info["cached"]
    assert len(entries(cache_folder)) == 1


@pytest.mark.parametrize("name", ["visibility", "ambient", "indirect", "sh1", "transfer_multibounce"])
def test_a_buffer_is_the_same_whatever_else_is_computed(name):
    """Else a buffer that is added to a stored reference would not belong to it."""
    lamp = aolab.PointLight((1.0, 0.5, 0.3))
    room = wall_scene(environment=aolab.Environment.sky(sun_direction=(1, 1, 0)), lights=(lamp,))
    settings = {"size": SIZE, "rays": 8, "radius": 1.5, "falloff": 0.5, "cache": False}
    everything = reference(
        room, **settings, buffers=("sh1", "visibility", "ambient", "indirect", "transfer_multibounce")
    )
    alone = reference(room, **settings, buffers=name)
    np.testing.assert_allclose(alone[name], everything[name], rtol=1e-5, atol=1e-6)


def test_a_change_in_any_file_of_the_package_is_another_entry(tmp_path, monkeypatch, cache_folder):
    copy = tmp_path / "aolab"
    shutil.copytree(cache.PACKAGE, copy, ignore=shutil.ignore_patterns("__pycache__"))
    assert cache.code(copy) == cache.code(cache.PACKAGE)
    file = copy / "maths" / "harmonics.py"
    file.write_text(file.read_text() + "# changed")
    cache.code.cache_clear()
    assert cache.code(copy) != cache.code(cache.PACKAGE)
    visibility()
    monkeypatch.setattr(cache, "PACKAGE", copy)
    visibility()
    assert len(entries(cache_folder)) == 2


@pytest.mark.parametrize("damage", [lambda data: data[: len(data) // 2], lambda data: b"", lambda data: b"\0" + data])
def test_a_damaged_entry_is_made_anew(cache_folder, damage):
    first = visibility()
    (entry,) = entries(cache_folder)
    entry.write_bytes(damage(entry.read_bytes()))
    with pytest.warns(Notice, match=r"damaged and is made anew"):
        np.testing.assert_array_equal(visibility(), first)
    np.testing.assert_array_equal(visibility(), first)  # and this time without a word


def test_a_flipped_byte_is_noticed(cache_folder):
    first = visibility()
    (entry,) = entries(cache_folder)
    data = bytearray(entry.read_bytes())
    data[len(data) // 2] ^= 1
    entry.write_bytes(data)
    with pytest.warns(Notice, match="damaged"):
        np.testing.assert_array_equal(visibility(), first)


KILLED_WHILE_WRITING = """
import os, signal, sys

import numpy as np
from aolab.truth import cache

class Killer:
    def __array__(self, *args, **kwargs):
        print("writing", flush=True)
        os.kill(os.getpid(), signal.SIGKILL)

cache.store(sys.argv[1], {"whole": np.arange(3)})
cache.store(sys.argv[1], {"first": np.zeros(1_000_000), "second": Killer()})
"""


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGKILL")
def test_a_kill_in_the_middle_of_a_write_leaves_the_old_entry(cache_folder):
    child = subprocess.run(
        [sys.executable, "-c", KILLED_WHILE_WRITING, "entry"], capture_output=True, text=True, timeout=60
    )
    assert child.stdout == "writing\n"
    assert child.returncode != 0
    assert len(list(cache_folder.iterdir())) == 2  # the entry, and what was left half done
    np.testing.assert_array_equal(cache.load("entry", ["whole"])["whole"], np.arange(3))
    cache.store("entry", {"whole": np.arange(5)})
    np.testing.assert_array_equal(cache.load("entry", ["whole"])["whole"], np.arange(5))


def test_the_least_recently_used_go_first(cache_folder, monkeypatch):
    array = np.zeros(1000, np.float32)
    for age, name in enumerate(("new", "old", "oldest")):
        cache.store(name, {"a": array})
        path = cache_folder / f"{name}.npz"
        os.utime(path, (1e9 - age, 1e9 - age))
    assert cache.load("oldest", ["a"])  # used just now
    monkeypatch.setattr(cache, "BUDGET", 3.5 * path.stat().st_size)
    cache.store("newest", {"a": array})
    assert {file.stem for file in entries(cache_folder)} == {"new", "oldest", "newest"}


def test_a_cache_that_cannot_be_written_is_a_notice(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("AOLAB_CACHE", str(tmp_path / "file"))
    with pytest.warns(Notice, match=r"could not be cached.*set AOLAB_CACHE"):
        assert np.isfinite(visibility()).any()
