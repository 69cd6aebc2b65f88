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


@pytest.mark.parametrize("module", ["none", "ssao", "s3ho", "ssbn"])
def test_the_light_is_that_of_a_drawn_albedo(lab, drawn, monkeypatch, module):
    other = drawn.render(colored(), module).complete()
    monkeypatch.undo()
    frame = lab.render(colored(), module, size=SIZE)
    assert "albedo" not in frame.kept.large
    np.testing.assert_allclose(frame.image.astype(float), other.image, atol=1)
    np.testing.assert_array_equal(frame["albedo"], other["albedo"])
    assert len(np.unique(frame["albedo"][frame.mask], axis=0)) == len(COLORS)
    for name in ("direct", "ambient", "radiance"):
        np.testing.assert_allclose(frame[name], other[name], rtol=1e-5, atol=1e-6, err_msg=name)


def test_the_albedo_is_drawn_for_passes_that_read_it(lab):
    for module, options in (("ssdo", {"bounces": 1}), ("ambient_transfer", {}), ("ssao", {"scale": 0.5})):
        frame = lab.render(colored(), module, size=SIZE, **options)
        assert "albedo" in frame.kept.large, module


def test_the_albedo_is_drawn_where_it_varies_over_a_mesh(lab):
    floor, box = small_scenes.floor(2), small_scenes.box((-1, 0, -1), (0, 1, 0))
    shades = np.linspace(0, 1, 4 * len(box.vertices), dtype=np.float32).reshape(-1, 4)
    tinted = Mesh(box.vertices, box.faces, box.normals, colors=shades, material=box.material)
    checks = aolab.Texture(np.array([[[255, 0, 0, 255], [0, 255, 0, 255]]], np.uint8))
    tiled = Mesh(floor.vertices, floor.faces, uv=floor.vertices[:, ::2], material=replace(WHITE, texture=checks))
    for scene in (small_scenes.of(floor, tinted), small_scenes.of(tiled, box)):
        frame = lab.render(scene, "ssao", size=SIZE)
        assert "albedo" in frame.kept.large
        assert len(np.unique(frame["albedo"][frame.mask], axis=0)) > 2


def test_a_relit_frame_keeps_its_palette(lab):
    frame = lab.render(colored(), "ssao", size=SIZE)
    dark = lab.relight(frame, lights=())
    np.testing.assert_array_equal(dark["albedo"], frame["albedo"])
    assert dark["direct"].max() == 0


def test_more_meshes_than_half_floats_count_have_no_palette(lab, monkeypatch):
    monkeypatch.setattr(palettes, "MOST", 2)
    assert "albedo" in lab.render(colored(), "ssao", size=SIZE).kept.large


def test_a_module_of_ones_own_reads_the_albedo(lab, tmp_path):
    path = tmp_path / "red.frag"
    path.write_text(
        "uniform sampler2D albedo;\nout float visibility;\n"
        "void main() { visibility = texelFetch(albedo, ivec2(gl_FragCoord.xy), 0).r; }\n"
    )

    class Mine(aolab.SSAO):
        shader = path

    frame = lab.render(colored(), Mine(filter="none"), size=SIZE)
    np.testing.assert_array_equal(frame["visibility"][frame.mask], frame["albedo"][..., 0][frame.mask])
