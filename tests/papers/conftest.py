"""Figures at low resolution, with the shaders as they are and with a shader that was broken on purpose."""

from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest

from aolab.papers.figure import Figure
from aolab.papers.reproduce import figures
from aolab.pipeline.api import shared_lab

THROUGH = "fract(0.618 * float(i) + 0.37 * float(receiver.set)) < 0.3"
FORM_FACTOR = "rising * facing / (squaredDistance * clamped)"
SENDER = "texture(sender, occluder.uv).rgb"
LOBE = "max(shDot(shBasis(viewToLight), windowed), 0.0)"
ADD = "addDirection(moments, viewDir, plain ? 1.0 - blocked : blocked);"

# a shader's file, a text in it, and the text that takes its place; each breaks a method in one way
EDITS = {
    "30 % of blocked directions open": (
        ("lib/march.glsl", "    return blocked;", f"    return blocked && !({THROUGH});"),
        ("lib/march.glsl", "    return nearest;", f"    return {THROUGH} ? OPEN : nearest;"),
    ),
    "half the reach": (("lib/march.glsl", "/ float(steps);", "/ float(2 * steps);"),),
    "thin surfaces": (("occluders/depth.glsl", "- 0.5 * thickness) < 0.5", "- 0.05 * thickness) < 0.05"),),
    "solids without a back": (("lib/solids.glsl", "isBackground(solid.y);", "true;"),),
    "no further views": (("occluders/views.glsl", "k < views; ++k", "k < views - 4; ++k"),),
    "no limit to the segment": (("ssdo.lights.frag", "min(reach, distanceOf(", "max(reach, distanceOf("),),
    # senders
    "no cosines": (("lib/senders.glsl", FORM_FACTOR, "1.0 / clamped"),),
    "senders of twice the area": (("lib/senders.glsl", "return bleeding * PI", "return bleeding * 2.0 * PI"),),
    "senders of half the area": (("lib/senders.glsl", "return bleeding * PI", "return bleeding * 0.5 * PI"),),
    "back-facing senders": (("lib/senders.glsl", "facing > 0.0 && dot(", "dot("),),
    "grey senders": tuple(
        (f"occluders/{kind}.glsl", SENDER, f"vec3(dot({SENDER}, vec3(1.0 / 3.0)))") for kind in ("depth", "height")
    ),
    "coefficients of three senders": (("s3ho.senders.frag", "= shClampedCosine(", "= 3.0 * shClampedCosine("),),
    # the environment
    "one direction for all": (("ssdo.frag", "octahedralUv(worldFrame * kernel[i].xyz)", "vec2(0.5)"),),
    "the other side's light": (("ssdo.frag", "* kernel[i].xyz", "* (kernel[i].xyz * vec3(-1.0, -1.0, 1.0))"),),
    "green light for all colours": (("s3ho.ambient.glsl", "view_environment_sh[i]", "view_environment_sh[1]"),),
    # SSAO
    "occlusion of red alone": (("lighting/ambient.glsl", "* open", "* vec3(open, 1.0, 1.0)"),),
    "occlusion of strong light": (("lighting/ambient.glsl", "* open", "* mix(1.0, open, min(irradiance.b, 1.0))"),),
    # S3HO
    "two bands": (
        ("s3ho.transfer.glsl", "return withinBounds(", "return shWindow("),
        ("s3ho.transfer.glsl", "- blocked);", "- blocked, vec4(1.0, 1.0, 0.0, 0.0));"),
    ),
    "half the occlusion": (("s3ho.transfer.glsl", "- blocked)", "- 0.5 * blocked)"),),
    "a quarter of the samples": (("s3ho.moments.frag", ADD, f"if (i % 4 == 0) for (int k = 0; k < 4; ++k) {ADD}"),),
    "no lobes": (("s3ho.direct.glsl", LOBE, "max(dot(normal, viewToLight), 0.0)"),),
    # ambient transfer
    "half the distances": (("ambient_transfer.frag", "/ float(steps));", "/ float(2 * steps));"),),
    "linear in place of the square root": (("measures/sqrt.glsl", "return share * share;", "return share;"),),
    "a short exponential": (("measures/exponential.glsl", "/ sigma; }", "/ (3.0 * sigma); }"),),
    "one set for all pixels": (
        ("lib/sampling.glsl", "return 4 * (2 * (low.x ^ low.y) + low.y) + ", "return 0; low.x += "),
    ),
    "no neighbours in the filter": (("pipeline/box4.frag", "LEAST_ALIKE = 0.7", "LEAST_ALIKE = 2.0"),),
    "no limit to depth": (("ambient_transfer.frag", "silhouette_elimination ?", "silhouette_elimination && false ?"),),
    "black senders": (
        ("ambient_transfer.frag", "blocked ? occluderRadiance(first)", "blocked ? 0.0 * occluderRadiance(first)"),
    ),
    "white senders": (
        (
            "ambient_transfer.frag",
            "blocked ? occluderRadiance(first)",
            "blocked ? vec3(1.0) + 0.0 * occluderRadiance(first)",
        ),
    ),
    "no relief": (("occluders/height.glsl", "< obstacle;", "< -1e9 * (1.0 + abs(obstacle));"),),
    # SSBN
    "cones around the normal": (("ssbn.ambient.glsl", "> 1e-12 ? bent", "> 1e-12 ? worldNormal"),),
    # HAO
    "no voxels": (("lib/voxel_grid.glsl", ">> uint(voxel.z & 31)) & 1u) == 1u", ">> uint(voxel.z & 31)) & 1u) > 1u"),),
    "half of the slices": (
        ("pipeline/voxelize.frag", "bits[i][k] = bitsBetween(", "bits[i][k] = 0x55555555u & bitsBetween("),
    ),
    "voxels of twelve slices": (
        ("pipeline/voxelize.frag", "last = int(floor(range.y))", "last = int(floor(range.y)) + 12"),
    ),
    "the receiver's own voxels": (("occluders/voxels.glsl", "return !own && ", "return "),),
    "voxels of the picture alone": (
        ("occluders/voxels.glsl", "return !own && ", "vec2 uv; return !own && isSeen(occluder, uv) && "),
        ("occluders/voxels.glsl", "// Is the view-space point", "bool isSeen(Occluder occluder, out vec2 uv);\n//"),
    ),
    "a cone three times as wide": (
        ("hao.frag", "jittered(kernel[i].xyz, noise.z)", "normalize(kernel[i].xyz * vec3(3.0, 3.0, 1.0))"),
    ),
    "no falloff": (("lib/wendland.glsl", "return rest", "return share < 1.0 ? 1.0 : rest"),),
    "one ray for all": (("hao.frag", "jittered(kernel[i].xyz", "jittered(kernel[0].xyz"),),
    "a filter without neighbours": (
        ("pipeline/wendland.frag", "wendland(abs(float(i))", "wendland(64.0 * abs(float(i))"),
    ),
    "noise of the screen": (("hao.frag", "floor(worldPos / (NOISE_CELL * radius))", "vec3(gl_FragCoord.xy, 0.0)"),),
    # shadow maps and virtual lights
    "no gap": (("lib/fill.glsl", "FILL_THICKNESS * reach", "0.0 * reach"),),
    "only the near half of the gap": (("lib/segment.glsl", "/ float(samples))", "/ float(8 * samples))"),),
    "no slope in the gap": (("lib/shadow_tiles.glsl", "sqrt(1.0 - cosine * cosine) / cosine", "0.02"),),
    "lights from one side": (
        ("virtual_lights.frag", "toLight = place.xyz;", "toLight = normalize(vec3(1.0, 0.5, 0.0));"),
    ),
    "virtual lights that send to all sides": (
        ("virtual_lights.frag", "max(-dot(normal.xyz, toLight), 0.0)", "1.0"),
        ("virtual_lights.frag", "light *= tileShadow(i, worldPos);", ""),
    ),
    "no near field": (("near_field.frag", "sum += radiance", "sum += 0.0 * radiance"),),
    "all of the near field": (("near_field.frag", "max(1.0 - bound / geometry, 0.0)", "1.0"),),
    "half of the near field": (("near_field.frag", "PI / float(directions)", "0.3 * PI / float(directions)"),),
    # reflective shadow maps and the rotated kernel
    "a map without the lamp's cone": (("rsm.map.frag", "* arriving * section", "* arriving * arriving * section"),),
    "the depth of a ray": (("rsm.map.frag", "rsm_depth = -viewPos.z", "rsm_depth = length(viewPos)"),),
    "pixel lights that send to all sides": (
        ("lib/pixel_lights.glsl", "max(dot(light.normal, there), 0.0)", "sqrt(squared)"),
    ),
    "pixel lights of half the flux": (("lib/pixel_lights.glsl", "count / PI * cosines", "0.5 * count / PI * cosines"),),
    "a sixteenth of the occlusion": (("rotated_ssao.frag", "strength * occlusion", "strength / 16.0 * occlusion"),),
    "the mean of 2×2 pixels": (("pipeline/box4.frag", "i <= 2;", "i <= 0;"),),
    "a tenth of the reach": (("rotated_ssao.frag", "float reachPx = radius", "float reachPx = 0.1 * radius"),),
    "one angle for all pixels": (("lib/line.glsl", "2.0 * PI * float(set) / 16.0", "0.1"),),
}

SMALL = {
    ("ssdo", "fig1"): {"repeats": 1},
    ("ssdo", "fig3"): {"size": (96, 54)},
    ("ssdo", "fig4"): {"frames": 22, "rays": 64},
    ("ssdo", "fig6"): {"size": (240, 135)},
    ("ssdo", "fig7"): {"size": (112, 63), "rays": 64},
    ("ssdo", "fig9"): {"size": (240, 135)},
    ("ssdo", "fig10"): {"size": (160, 90), "rays": 64},
    ("ssdo", "fig11"): {"size": (160, 90), "rays": 64},
    ("ssdo", "fig12"): {"size": (160, 90), "rays": 64, "lights": 128},
    ("rsm", "fig1"): {"size": (128, 128)},
    ("rsm", "fig5"): {"size": (96, 72), "rays": 64},
    ("rsm", "fig7"): {"size": (160, 120), "rays": 32},
    ("rsm", "fig9"): {"size": (160, 120), "frames": 32},
    ("ssdo", "fig13"): {"rays": 128},
    ("ssdo", "table1"): {"size": (160, 120), "repeats": 1},
    ("hao", "fig4"): {"rays": 64},
    ("hao", "fig5"): {"seeds": 3},
    ("hao", "fig6"): {"size": (96, 72), "repeats": 1},
    ("hao", "fig7"): {"size": (160, 120), "rays": 32, "repeats": 1},
    ("hao", "fig8"): {"rays": 32},
    ("hao", "fig9"): {"rays": 64},
    ("ambient_transfer", "fig1"): {"size": (96, 54), "accumulate": 4},
    ("ambient_transfer", "fig5"): {"size": (128, 72), "seeds": 4},
    ("ambient_transfer", "fig7"): {"size": (160, 90), "rays": 64},
    ("ambient_transfer", "fig8"): {"size": (128, 72), "rays": 64},
    ("ambient_transfer", "fig9"): {"size": (240, 135), "rays": 64},
    ("s3ho", "fig1"): {"size": (240, 135), "rays": 64},
    ("s3ho", "fig6"): {"size": (96, 54), "rays": 64},
    ("s3ho", "fig7"): {"rays": 512, "seeds": 3},
    ("s3ho", "fig8"): {"size": (96, 54), "rays": 128, "seeds": 3, "frames": 8},
    ("s3ho", "fig9"): {"size": (80, 45), "seeds": 3},
    ("s3ho", "table1"): {"size": (96, 54), "repeats": 1},
}


def drawn(paper: str, name: str) -> Figure:
    return figures(paper, name)[name](**{"size": (160, 90), **SMALL.get((paper, name), {})})


@pytest.fixture(scope="session")
def references(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A cache of references that all figures share: a broken shader does not change the truth."""
    return tmp_path_factory.mktemp("references")


@pytest.fixture(scope="session")
def draw(gl: object, references: Path) -> Callable[[str, str], Figure]:
    """`draw("ssdo", "fig3")`, once for all tests."""

    def once(paper: str, name: str) -> Figure:
        with pytest.MonkeyPatch.context() as patch:
            patch.setenv("AOLAB_CACHE", str(references))
            return drawn(paper, name)

    return cache(once)


@pytest.fixture
def broken(shaders: Path, references: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[str, str, str], Figure]:
    """`broken("ssdo", "fig3", "no cosines")`: the figure with edited shaders. Each edit has to find its text."""
    monkeypatch.setenv("AOLAB_CACHE", str(references))

    def draw_with(paper: str, name: str, edit: str) -> Figure:
        whole = {file: (shaders / file).read_text() for file, _, _ in EDITS[edit]}
        for file, old, new in EDITS[edit]:
            text = (shaders / file).read_text()
            assert old in text, f"{file} does not contain {old!r} any more"
            (shaders / file).write_text(text.replace(old, new))
        shared_lab.cache_clear()  # the next one compiles the edited shaders
        try:
            return drawn(paper, name)
        finally:
            shared_lab.cache_clear()
            for file, text in whole.items():
                (shaders / file).write_text(text)

    return draw_with
