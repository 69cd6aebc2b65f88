"""Buffers in files: .npz, and .exr with a layer for each buffer."""

import numpy as np
import OpenEXR
import pytest

from aolab import FileError
from aolab.pictures.buffer_files import save_buffers

RNG = np.random.default_rng(3)
BUFFERS = {
    "visibility": np.where(RNG.random((6, 8)) < 0.2, np.nan, RNG.random((6, 8))).astype(np.float32),
    "viewZ": np.full((6, 8), -np.inf, np.float32),
    "ambient": RNG.random((6, 8, 3)).astype(np.float32) * 1e4,
    "viewNormal": RNG.random((6, 8, 3)).astype(np.float32),
    "sh0": RNG.random((6, 8, 4)).astype(np.float32),
    "image": RNG.integers(0, 256, (6, 8, 3)).astype(np.uint8),
}
DIRECTIONS = {"viewNormal"}


def layers(path) -> list[dict[str, np.ndarray]]:
    """{channel: pixels} of each part."""
    parts = OpenEXR.File(str(path), separate_channels=True).parts
    return [{name: channel.pixels for name, channel in part.channels.items()} for part in parts]


@pytest.mark.parametrize("name", ["a.npz", "a"])
def test_npz_keeps_arrays(tmp_path, name):
    save_buffers(tmp_path / name, BUFFERS, DIRECTIONS)
    with np.load(tmp_path / name) as found:
        assert set(found) == set(BUFFERS)
        for key, values in BUFFERS.items():
            np.testing.assert_array_equal(found[key], values)
            assert found[key].dtype == values.dtype


def test_exr_has_a_layer_for_each_buffer(tmp_path):
    save_buffers(tmp_path / "a.exr", BUFFERS, DIRECTIONS)
    (found,) = layers(tmp_path / "a.exr")
    channels = {"visibility": "Y", "viewZ": "Y", "ambient": "RGB", "viewNormal": "XYZ", "sh0": "XYZW", "image": "RGB"}
    assert set(found) == {f"{name}.{one}" for name, all_ in channels.items() for one in all_}
    for name, values in BUFFERS.items():
        expected = values / np.float32(255) if values.dtype == np.uint8 else values
        seen = np.stack([found[f"{name}.{one}"] for one in channels[name]], axis=-1)
        np.testing.assert_array_equal(seen.reshape(values.shape), expected)


def test_a_buffer_of_another_size_is_a_part_of_its_own(tmp_path):
    small = {"ambient_raw": BUFFERS["ambient"][:3, :4]}
    save_buffers(tmp_path / "a.exr", {**small, **BUFFERS}, DIRECTIONS)
    parts = layers(tmp_path / "a.exr")
    assert sorted(len(part) for part in parts) == [3, 15]
    one = min(parts, key=len)
    assert set(one) == {f"ambient_raw.{channel}" for channel in "RGB"}
    np.testing.assert_array_equal(one["ambient_raw.G"], BUFFERS["ambient"][:3, :4, 1])


def test_other_suffixes_are_refused(tmp_path):
    with pytest.raises(FileError, match=r"cannot write .*a\.png: buffers are written as \.npz or \.exr"):
        save_buffers(tmp_path / "a.png", BUFFERS, DIRECTIONS)
    assert list(tmp_path.iterdir()) == []
