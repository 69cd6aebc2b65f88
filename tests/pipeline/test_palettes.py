"""The palette stands for the albedo of each pixel where each mesh has one: the same albedo and the same light."""

from dataclasses import replace

import numpy as np
import pytest
import small_scenes
from small_scenes import WHITE

import aolab
from aolab import DirectionalLight, Mesh, Scene
from aolab.pipeline import palettes

SIZE = (48, 36)
COLORS = {"red": (0.8, 0.1, 0.05), "green": (0.15, 0.7, 0.2), "grey": (0.7, 0.5, 0.3)}


def colored(**changes) -> Scene:
    """Boxes of different colours on a floor, under a lamp."""
    red, green, grey = (replace(WHITE, base_color=color) for color in COLORS.values())
    return small_scenes.of(
        small_scenes.floor(2, grey),
        small_scenes.box((-1, 0, -1), (0, 1, 0), red),
        small_scenes.box((0.3, 0, -0.4), (1.2, 0.6, 0.7), green),
        lights=(DirectionalLight((1, -2, -1), (2, 2, 2)),),
    ).replace(**changes)


@pytest.fixture
def drawn(monkeypatch):
    """A lab that draws the albedo of each pixel."""
    monkeypatch.setattr(palettes, "is_enough", lambda frame: False)
    return aolab.Lab(SIZE)


@pytest.mark.parametrize("scale", [1.0, 0.5])
@pytest.mark.parametrize("module", ["none", "ssao", "s3ho", "ssbn"])
def test_the_light_is_that_of_a_drawn_albedo(lab, drawn, monkeypatch, module, scale):
    other = drawn.render(colored(), module, scale=scale).complete()
    monkeypatch.undo()
    frame = lab.render(colored(), module, size=SIZE, scale=scale)
    assert "albedo" not in frame.kept.large
    np.testing.assert_allclose(frame.image.astype(float), other.image, atol=1)
    np.testing.assert_array_equal(frame["albedo"], other["albedo"])
    assert len(np.unique(frame["albedo"][frame.mask], axis=0)) == len(COLORS)
    for name in ("direct", "ambient", "radiance"):
        np.testing.assert_allclose(frame[name], other[name], rtol=1e-5, atol=1e-6, err_msg=name)


def test_the_albedo_is_drawn_for_passes_that_read_it(lab):
    for module, options in (("ssdo", {"bounces": 1}), ("ambient_transfer", {}), ("ssdo", {"bounces": 1, "scale": 0.5})):
        frame = lab.render(colored(), module, size=SIZE, **options)
        assert "albedo" in frame.kept.large, module


def patterned() -> Scene:
    """A tinted box and a tiled floor, which are the first and last of the meshes; between them, two of one colour."""
    floor, box = small_scenes.floor(2), small_scenes.box((-1, 0, -1), (0, 1, 0))
    shades = np.linspace(0, 1, 4 * len(box.vertices), dtype=np.float32).reshape(-1, 4)
    tinted = Mesh(box.vertices, box.faces, box.normals, colors=shades, material=box.material)
    checks = aolab.Texture(np.array([[[255, 0, 0, 255], [0, 255, 0, 255]]], np.uint8))
    tiled = Mesh(floor.vertices, floor.faces, uv=floor.vertices[:, ::2], material=replace(WHITE, texture=checks))
    red, green, _ = (replace(WHITE, base_color=color) for color in COLORS.values())
    plain = small_scenes.box((0.3, 0, -0.4), (1.2, 0.6, 0.7), red), small_scenes.box((0, 1, -1), (0.4, 1.4, 0), green)
    return small_scenes.of(tinted, *plain, tiled, lights=(DirectionalLight((1, -2, -1), (2, 2, 2)),))


def test_the_albedo_is_drawn_where_it_varies_over_a_mesh(lab, drawn, monkeypatch):
    other = drawn.render(patterned(), "ssao").complete()
    monkeypatch.undo()
    frame = lab.render(patterned(), "ssao", size=SIZE)
    assert "albedo" not in frame.kept.large
    assert not {"palette", "patterns"} & {*frame}
    # the drawn albedo is multiplied by an interpolated colour of 1, which is 1 up to rounding
    np.testing.assert_allclose(frame["albedo"], other["albedo"], rtol=2**-10)
    assert len(np.unique(frame["albedo"][frame.mask], axis=0)) > 20
    for name in ("viewZ", "viewNormal", "visibility"):
        np.testing.assert_array_equal(frame[name], other[name], err_msg=name)
    np.testing.assert_allclose(frame["radiance"], other["radiance"], rtol=2**-10, atol=1e-6)
    relit = lab.relight(frame, lights=())
    np.testing.assert_array_equal(relit["albedo"], frame["albedo"])


def test_where_all_meshes_have_patterns_there_is_no_palette(lab):
    tiled = patterned().meshes[-1]
    assert "albedo" in lab.render(small_scenes.of(tiled), "ssao", size=SIZE).kept.large


def test_of_surfaces_at_one_place_the_same_is_seen_with_and_without_a_palette(lab):
    """A plain sheet within a tiled floor: each module sees the same of the two."""
    tiled = patterned().meshes[-1]
    sheet = Mesh(tiled.vertices, tiled.faces, material=replace(WHITE, base_color=COLORS["green"]))
    for scene in (small_scenes.of(tiled, sheet), small_scenes.of(sheet, tiled)):
        with_palette = lab.render(scene, "ssao", size=SIZE)
        without = lab.render(scene, "ambient_transfer", size=SIZE)
        assert "palette" in with_palette.kept.large
        assert "palette" not in without.kept.large
        np.testing.assert_array_equal(with_palette["albedo"], without["albedo"])


def test_a_relit_frame_keeps_its_palette(lab):
    frame = lab.render(colored(), "ssao", size=SIZE)
    dark = lab.relight(frame, lights=())
    np.testing.assert_array_equal(dark["albedo"], frame["albedo"])
    assert dark["direct"].max() == 0


def test_more_meshes_than_half_floats_count_have_no_palette(lab, monkeypatch):
    monkeypatch.setattr(palettes, "MOST", 2)
    assert "albedo" in lab.render(colored(), "ssao", size=SIZE).kept.large


def test_a_module_of_ones_own_reads_the_albedo(lab):
    class Mine(aolab.SSAO):
        shader = """
        uniform sampler2D albedo;
        out float visibility;
        void main() { visibility = texelFetch(albedo, ivec2(gl_FragCoord.xy), 0).r; }
        """

    frame = lab.render(colored(), Mine(filter="none"), size=SIZE)
    np.testing.assert_array_equal(frame["visibility"][frame.mask], frame["albedo"][..., 0][frame.mask])
