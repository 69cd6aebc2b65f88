"""Pictures from files: every kind is read as documented; every bad file is refused by name."""

import io
import os
import struct
import zlib

import numpy as np
import OpenEXR
import pytest
from PIL import Image

from aolab.errors import FileError, ParameterError
from aolab.input import Budget
from aolab.pictures.images import linear_from_srgb, read_image, read_radiance

RNG = np.random.default_rng(11)


def encoded(image: Image.Image, kind: str = "PNG", **options) -> bytes:
    file = io.BytesIO()
    image.save(file, kind, **options)
    return file.getvalue()


def png_claiming(width: int, height: int) -> bytes:
    """A tiny PNG whose header claims a large size."""

    def chunk(kind: bytes, body: bytes) -> bytes:
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(b"\0")) + chunk(b"IEND", b"")


# --- pictures of 8 bits


def test_rgba_is_unchanged_from_path_and_bytes(tmp_path):
    pixels = RNG.integers(0, 256, (5, 7, 4), np.uint8)
    path = tmp_path / "a.png"
    path.write_bytes(encoded(Image.fromarray(pixels)))
    for source in (path, str(path), path.read_bytes()):
        found = read_image(source, "a")
        assert found.dtype == np.uint8
        np.testing.assert_array_equal(found, pixels)


@pytest.mark.parametrize(
    ("image", "kind", "expected"),
    [
        (Image.new("RGB", (3, 2), (10, 20, 30)), "PNG", (10, 20, 30, 255)),
        (Image.new("L", (3, 2), 77), "PNG", (77, 77, 77, 255)),
        (Image.new("LA", (3, 2), (77, 5)), "PNG", (77, 77, 77, 5)),
        (Image.new("1", (3, 2), 1), "PNG", (255, 255, 255, 255)),
        (Image.new("RGB", (3, 2), (10, 20, 30)).quantize(4), "PNG", (10, 20, 30, 255)),
        (Image.new("CMYK", (3, 2), (0, 255, 255, 0)), "TIFF", (255, 0, 0, 255)),
        (Image.new("I;16", (3, 2), 65535), "PNG", (255, 255, 255, 255)),
        (Image.new("I;16", (3, 2), 257 * 100), "PNG", (100, 100, 100, 255)),
        (Image.new("RGB", (3, 2), (10, 20, 30)), "BMP", (10, 20, 30, 255)),
        (Image.new("RGB", (3, 2), (10, 20, 30)), "TGA", (10, 20, 30, 255)),
    ],
    ids=lambda value: getattr(value, "mode", None),
)
def test_every_mode_becomes_rgba(image, kind, expected):
    found = read_image(encoded(image, kind), "a")
    assert found.shape == (2, 3, 4)
    np.testing.assert_array_equal(found, np.broadcast_to(np.array(expected, np.uint8), (2, 3, 4)))


def test_palette_transparency_becomes_alpha():
    image = Image.new("P", (2, 1), 0)
    image.putpalette([10, 20, 30, 40, 50, 60])
    image.putpixel((1, 0), 1)
    found = read_image(encoded(image, transparency=1), "a")
    np.testing.assert_array_equal(found[0], [(10, 20, 30, 255), (40, 50, 60, 0)])


def test_a_red_cmyk_jpeg_stays_red():
    found = read_image(encoded(Image.new("CMYK", (16, 16), (0, 255, 255, 0)), "JPEG"), "a")
    np.testing.assert_allclose(found[8, 8], (255, 0, 0, 255), atol=6)  # JPEG loses a little


def test_exif_rotation_is_ignored():
    exif = Image.Exif()
    exif[0x0112] = 6  # orientation: rotate by 90°
    assert read_image(encoded(Image.new("RGB", (8, 4)), "JPEG", exif=exif), "a").shape == (4, 8, 4)


@pytest.mark.parametrize("kind", ["PNG", "JPEG"])
@pytest.mark.parametrize("part", [0.02, 0.5, 0.9])
def test_truncated_pictures_are_refused_by_name(kind, part):
    data = encoded(Image.fromarray(RNG.integers(0, 256, (64, 64, 3), np.uint8)), kind)
    with pytest.raises(FileError, match="image 'bark' is corrupt"):
        read_image(data[: int(part * len(data))], "bark")


def test_corrupt_png_is_refused_by_name():
    data = bytearray(encoded(Image.fromarray(RNG.integers(0, 256, (64, 64, 3), np.uint8))))
    data[200:400] = bytes(200)
    with pytest.raises(FileError, match="image 'bark' is corrupt"):
        read_image(bytes(data), "bark")


def test_a_file_that_is_not_a_picture_is_refused_with_the_known_kinds():
    with pytest.raises(FileError, match="image 'notes' is corrupt or none of PNG, JPEG"):
        read_image(b"dear diary", "notes")


def test_a_missing_picture_is_named(tmp_path):
    with pytest.raises(FileError, match=r"no file .*bark\.png"):
        read_image(tmp_path / "bark.png", "bark")


def test_floating_point_tiff_is_refused_with_the_formats_that_may_have_floats():
    image = Image.fromarray(np.ones((2, 2), np.float32))
    with pytest.raises(FileError, match=r"floating-point numbers; only \.exr and \.hdr files"):
        read_image(encoded(image, "TIFF"), "a")


@pytest.mark.parametrize(("width", "height"), [(12000, 12000), (40000, 40000), (10**6, 10**6)])
def test_a_decompression_bomb_is_refused_before_decoding(width, height):
    """Below and above Pillow's own limits, the error is a FileError with count and limit."""
    with pytest.raises(FileError, match=rf"image 'bomb' is refused: .*{width * height} .*limit.* 134217728"):
        read_image(png_claiming(width, height), "bomb")


def test_the_limit_is_a_parameter():
    data = encoded(Image.new("RGB", (10, 10)))
    assert read_image(data, "a", max_pixels=100).shape == (10, 10, 4)
    with pytest.raises(FileError, match="10×10 = 100 pixels, the limit is 99"):
        read_image(data, "a", max_pixels=99)


def test_srgb_decodes_by_its_standard():
    found = linear_from_srgb(np.array([[0, 10, 11, 128, 255]], np.uint8))
    assert found.dtype == np.float32
    # IEC 61966-2-1; 10 is the last code of the linear part
    np.testing.assert_allclose(found, [[0, 10 / 255 / 12.92, 0.00334654, 0.21586050, 1]], rtol=2e-6)


# --- OpenEXR


def write_exr(path, channels, **header):
    with OpenEXR.File({"type": OpenEXR.scanlineimage, **header}, channels) as file:
        file.write(str(path))
    return path


@pytest.mark.parametrize("dtype", [np.float16, np.float32])
@pytest.mark.parametrize("compression", [OpenEXR.NO_COMPRESSION, OpenEXR.ZIP_COMPRESSION, OpenEXR.PIZ_COMPRESSION])
def test_exr_round_trip(tmp_path, dtype, compression):
    pixels = (RNG.random((6, 9, 3)) * 1000).astype(dtype)
    found = read_radiance(write_exr(tmp_path / "a.exr", {"RGB": pixels}, compression=compression))
    assert found.dtype == np.float32
    np.testing.assert_array_equal(found, pixels.astype(np.float32))


def test_exr_alpha_is_left_out_and_grey_is_repeated(tmp_path):
    pixels = RNG.random((3, 5, 4)).astype(np.float32)
    np.testing.assert_array_equal(read_radiance(write_exr(tmp_path / "a.exr", {"RGBA": pixels})), pixels[..., :3])
    grey = read_radiance(write_exr(tmp_path / "y.exr", {"Y": np.ascontiguousarray(pixels[..., 0])}))
    np.testing.assert_array_equal(grey, np.repeat(pixels[..., :1], 3, axis=2))


def test_infinite_numbers_of_an_exr_are_kept(tmp_path):
    pixels = np.full((1, 2, 3), np.inf, np.float32)
    assert np.isinf(read_radiance(write_exr(tmp_path / "a.exr", {"RGB": pixels}))).all()


def test_exr_without_the_needed_channels_is_refused_with_its_channels(tmp_path):
    plane = np.ones((2, 2), np.float32)
    path = write_exr(tmp_path / "depth.exr", {"Z": plane, "R": plane})
    with pytest.raises(FileError, match=r"depth\.exr' has the channels R, Z; it needs R, G, B or a single Y"):
        read_radiance(path)


@pytest.mark.parametrize("part", [0.0, 0.01, 0.3, 0.9])
def test_truncated_exr_is_refused_by_name(tmp_path, part):
    path = write_exr(tmp_path / "dawn.exr", {"RGB": RNG.random((32, 64, 3)).astype(np.float32)})
    data = path.read_bytes()
    path.write_bytes(data[: int(part * len(data))])
    with pytest.raises(FileError, match=r"dawn\.exr' is not a readable OpenEXR picture"):
        read_radiance(path)


def test_enormous_exr_is_refused_before_decoding(tmp_path):
    path = write_exr(tmp_path / "bomb.exr", {"RGB": np.ones((4, 4, 3), np.float32)})
    data, small = path.read_bytes(), struct.pack("<4i", 0, 0, 3, 3)
    assert data.count(small) == 2  # data and display window
    path.write_bytes(data.replace(small, struct.pack("<4i", 0, 0, 199999, 199999)))
    with pytest.raises(
        FileError, match=r"bomb\.exr' is refused: 200000×200000 = 40000000000 pixels, the limit is 134217728"
    ):
        read_radiance(path)


def test_cropped_exr_is_refused(tmp_path):
    window = (np.array([0, 0], np.int32), np.array([9, 9], np.int32))
    path = write_exr(tmp_path / "crop.exr", {"RGB": np.ones((4, 4, 3), np.float32)}, displayWindow=window)
    with pytest.raises(FileError, match=r"crop\.exr': its data window .* is not its display window"):
        read_radiance(path)


# --- Radiance


HEADER = b"#?RADIANCE\n# a comment\nFORMAT=32-bit_rle_rgbe\n\n"


def rgbe_pixels(height: int, width: int) -> np.ndarray:
    """(height, width, 4) uint8: normalised mantissas, and flat stretches so that runs occur."""
    pixels = RNG.integers(2, 256, (height, width, 4), np.uint8)
    pixels[..., 0] |= 128
    pixels[..., 3] = RNG.integers(120, 136, (height, 1))
    pixels[:, 3 : width // 2] = pixels[:, 3:4]
    return pixels


def radiance_of(pixels: np.ndarray) -> np.ndarray:
    return pixels[..., :3] * 2.0 ** (pixels[..., 3:].astype(float) - 136)


def new_runs(pixels: np.ndarray) -> bytes:
    """The writer of the new run-length encoding: runs of 4 and more, literals of at most 128."""
    data = bytearray()
    for row in pixels:
        data += bytes([2, 2, len(row) >> 8, len(row) & 255])
        for component in row.T:
            at = 0
            while at < len(component):
                run = 1
                while run < 127 and at + run < len(component) and component[at + run] == component[at]:
                    run += 1
                if run >= 4:
                    data += bytes([128 + run, component[at]])
                else:
                    data += bytes([1, component[at]]) if run == 1 else bytes([run, *component[at : at + run]])
                at += run
    return bytes(data)


def write_hdr(path, body: bytes, size: bytes, header: bytes = HEADER):
    path.write_bytes(header + size + b"\n" + body)
    return path


@pytest.mark.parametrize("width", [8, 40, 700])
def test_hdr_new_runs(tmp_path, width):
    pixels = rgbe_pixels(6, width)
    path = write_hdr(tmp_path / "a.hdr", new_runs(pixels), b"-Y 6 +X %d" % width)
    assert len(path.read_bytes()) < pixels.size + 100 or width == 8
    found = read_radiance(path)
    assert found.dtype == np.float32
    np.testing.assert_array_equal(found, radiance_of(pixels))


@pytest.mark.parametrize("width", [1, 7, 40])
def test_hdr_flat(tmp_path, width):
    pixels = rgbe_pixels(6, width)
    found = read_radiance(write_hdr(tmp_path / "a.hdr", pixels.tobytes(), b"-Y 6 +X %d" % width))
    np.testing.assert_array_equal(found, radiance_of(pixels))


def test_hdr_old_runs(tmp_path):
    """Two repetitions in a row are the low and the high byte of one count."""
    a, b = bytes([200, 100, 50, 130]), bytes([128, 129, 130, 128])
    body = a + bytes([1, 1, 1, 4]) + b + bytes([1, 1, 1, 3]) + bytes([1, 1, 1, 1]) + a
    found = read_radiance(write_hdr(tmp_path / "a.hdr", body, b"-Y 2 +X 133"))
    codes = np.frombuffer(a * 5 + b * (1 + 3 + 256) + a, np.uint8).reshape(2, 133, 4)
    np.testing.assert_array_equal(found, radiance_of(codes))


def test_hdr_pixels_of_known_value(tmp_path):
    body = bytes([128, 64, 0, 129, 255, 0, 0, 0])
    found = read_radiance(write_hdr(tmp_path / "a.hdr", body, b"-Y 1 +X 2"))
    np.testing.assert_array_equal(found, [[(1, 0.5, 0), (0, 0, 0)]])


def test_hdr_exposures_are_divided_out(tmp_path):
    header = b"#?RGBE\nEXPOSURE=2\nEXPOSURE= 4.0\nCOLORCORR=1 2 4\nFORMAT=32-bit_rle_rgbe\n\n"
    found = read_radiance(write_hdr(tmp_path / "a.hdr", bytes([128, 128, 128, 132]), b"-Y 1 +X 1", header))
    assert found.dtype == np.float32
    np.testing.assert_allclose(found, [[(1, 0.5, 0.25)]])


def test_the_largest_hdr_number_is_finite(tmp_path):
    found = read_radiance(write_hdr(tmp_path / "a.hdr", bytes([255, 1, 1, 255]), b"-Y 1 +X 1"))
    np.testing.assert_allclose(found[0, 0, 0], 255 * 2.0**119)


@pytest.mark.parametrize(
    ("header", "size", "body", "message"),
    [
        (b"hello\n\n", b"-Y 1 +X 1", bytes(4), "it has no Radiance header"),
        (b"#?RADIANCE\n", b"-Y 1 +X 1", b"", "it has no Radiance header"),
        (b"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n", b"-Y 1 +X 1", bytes(4), "FORMAT is '32-bit_rle_xyze'"),
        (b"#?RADIANCE\nEXPOSURE=0\n\n", b"-Y 1 +X 1", bytes(4), "exposure is "),
        (b"#?RADIANCE\nEXPOSURE=bright\n\n", b"-Y 1 +X 1", bytes(4), "bright"),
        (HEADER, b"+Y 1 +X 1", bytes(4), r"resolution line is '\+Y 1 \+X 1', not '-Y <height> \+X <width>'"),
        (HEADER, b"+X 1 -Y 1", bytes(4), r"resolution line is '\+X 1 -Y 1'"),
        (HEADER, b"-Y 2 +X 2", bytes([9]) * 12, "it ends after 3 of 4 pixels"),
        (HEADER, b"-Y 2 +X 2", b"", "it ends after 0 of 4 pixels"),
        (HEADER, b"-Y 2 +X 2", bytes([9, 9, 9, 9, 1, 1, 1, 9]), "runs are longer than 4 pixels"),
        (HEADER, b"-Y 2 +X 2", bytes([1, 1, 1, 4]), "it begins with a repetition"),
        (HEADER, b"-Y 2 +X 8", bytes([2, 2, 0, 8, 136, 5, 136]), "it ends in row 0 of 2"),
        (HEADER, b"-Y 2 +X 8", bytes([2, 2, 0, 8, *[136, 5] * 4]), "row 1 of 2 does not begin as a row of 8 pixels"),
        (HEADER, b"-Y 2 +X 8", bytes([2, 2, 0, 8, 137, 5]), "row 0 of 2 is longer than 8 pixels"),
        (HEADER, b"-Y 2 +X 8", bytes([2, 2, 0, 8, 0, 5]), "row 0 of 2 has an empty run"),
    ],
)
def test_bad_hdr_is_refused_by_name(tmp_path, header, size, body, message):
    path = write_hdr(tmp_path / "dusk.hdr", body, size, header)
    with pytest.raises(FileError, match=rf"dusk\.hdr' is not a readable Radiance picture: .*{message}"):
        read_radiance(path)


@pytest.mark.parametrize("size", [b"-Y 100000 +X 100000", b"-Y 0 +X 5"])
def test_hdr_of_impossible_size_is_refused_before_decoding(tmp_path, size):
    with pytest.raises(FileError, match=r"dusk\.hdr' is refused: .* pixels, the limit is 134217728"):
        read_radiance(write_hdr(tmp_path / "dusk.hdr", bytes(8), size))


@pytest.mark.parametrize("name", ["a.exr", "a.hdr"])
def test_missing_radiance_is_named(tmp_path, name):
    with pytest.raises(FileError, match=name):
        read_radiance(tmp_path / name)


def test_another_kind_of_radiance_is_refused_with_the_known_ones(tmp_path):
    with pytest.raises(FileError, match=r"'\.pfm' is not a radiance format; known: \.exr, \.hdr"):
        read_radiance(tmp_path / "a.pfm")


# --- before anything is read


def test_a_header_that_would_end_the_process_is_an_error(tmp_path):
    """OpenEXR 3.5.3 aborts in `InputFile` on a name or text that is not UTF-8."""
    plane = {name: np.ones((4, 8), np.float32) for name in "RGB"}
    whole = write_exr(tmp_path / "a.exr", plane, comments="a remark", note=["one", "two"]).read_bytes()
    for text, damaged in {
        b"displayWindow": b"displayWi\xeedow",
        b"a remark": b"a r\xe4mark",
        b"two": b"t\xffo",
    }.items():
        assert text in whole
        (tmp_path / "bad.exr").write_bytes(whole.replace(text, damaged))
        with pytest.raises(FileError, match=r"bad\.exr' is not a readable OpenEXR picture: .* is not UTF-8"):
            read_radiance(tmp_path / "bad.exr")


def test_the_first_part_of_several_is_read(tmp_path):
    parts = [
        OpenEXR.Part({"type": OpenEXR.scanlineimage}, {c: np.full((4, 8), v, np.float32) for c in "RGB"}, name)
        for name, v in (("near", 2), ("far", 3))
    ]
    with OpenEXR.File(parts) as file:
        file.write(str(tmp_path / "a.exr"))
    np.testing.assert_array_equal(read_radiance(tmp_path / "a.exr"), np.full((4, 8, 3), 2))


@pytest.mark.parametrize("suffix", ["png", "hdr", "exr"])
def test_a_pipe_is_refused_and_not_waited_for(tmp_path, suffix):
    os.mkfifo(tmp_path / f"a.{suffix}")
    read = (lambda path: read_image(path, path.name)) if suffix == "png" else read_radiance
    with pytest.raises(FileError, match=rf"a\.{suffix}' is a named pipe; give a regular file"):
        read(tmp_path / f"a.{suffix}")


def test_a_file_larger_than_the_memory_is_not_read(tmp_path):
    path = tmp_path / "a.hdr"
    path.touch()
    os.truncate(path, 20_000_000_000)  # sparse
    with pytest.raises(FileError, match=r"needs 20 GB of memory, and the limit is 2 GB; .*AOLAB_MEMORY=20GB"):
        read_radiance(path)


def test_a_picture_of_few_bytes_and_many_pixels(tmp_path, monkeypatch):
    """A run that repeats itself claims 16384 × 8192 pixels in 72 bytes."""
    path = tmp_path / "a.hdr"
    path.write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8192 +X 16384\n" + b"\x80\x80\x80\x80\1\1\1\xff" * 2)
    with pytest.raises(FileError, match=r"needs 2\.15 GB of memory beside the .*AOLAB_MEMORY=3GB"):
        read_radiance(path)
    monkeypatch.setenv("AOLAB_MEMORY", "3 GB")
    with pytest.raises(FileError, match="it ends after"):  # now it is decoded
        read_radiance(path)


def test_a_budget_adds_up_and_is_stated():
    budget = Budget("1KB")
    data = encoded(Image.new("RGBA", (10, 10)))
    read_image(data, "a", budget=budget)
    read_image(data, "b", budget=budget)
    with pytest.raises(FileError, match="image 'c' is refused: it needs 400 B of memory beside the 800 B in use, and"):
        read_image(data, "c", budget=budget)
    with pytest.raises(ParameterError, match=r"memory = .much. is no size; write bytes, .*4GB"):
        Budget("much")
