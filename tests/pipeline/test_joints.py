"""The joints for methods to come, each used by a small module, occluder kind or filter of the test's own."""

import gc
import weakref
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
import pytest
import small_scenes

import aolab
from aolab import Camera, DirectionalLight, Environment, Material, Module, Pass, parameter
from aolab.maths.transforms import look_along, orthographic
from aolab.modules.estimate import Estimate
from aolab.modules.filters import Filter
from aolab.modules.filters.base import over_sources
from aolab.modules.occluders import Depth, OccluderKind, Product
from aolab.modules.passes import DIRECT, GeometryPass, reflect
from aolab.scene.scene import Scene
from aolab.scene.view import Projection, View

SIZE = (64, 48)
DARK = Environment.constant(0.0)

# --- a pass that draws geometry, into integers: voxels

GRID = 32
SLICES = 128  # bits of RGBA32UI


def from_above(scene: Scene, view: View) -> Projection:
    """Straight down on the scene's bounding sphere."""
    centre, radius = scene.bounds.mean(axis=0), scene.radius
    eye = centre + np.array((0, radius, 0))
    return Projection(look_along(eye, np.array((0, -1, 0))), orthographic(radius, radius, 0, 2 * radius), (GRID, GRID))


class Voxels(Module):
    """`visibility` is 1 where the voxel of the surface point is set, and 0 elsewhere; `lift` moves the point up."""

    lift: float = parameter(0.0, "Height over the surface at which the voxel is read.", ge=0, le=10, unit="scene units")
    depth: float = parameter(1.0, "Height of the grid.", gt=0, unit="scene units")
    middle: float = parameter(0.0, "Height of the grid's centre.", unit="scene units")

    def estimate(self) -> Estimate:
        draw = """
        uniform mat4 clip_from_view;
        uniform float depth;
        in vec3 viewPos;
        out uvec4 voxels;
        void main() {
            uint slice = uint(clamp(-viewPos.z / depth, 0.0, 0.999) * 128.0);
            voxels = uvec4(0u);
            voxels[slice / 32u] = 1u << (slice % 32u);
        }
        """
        read = """
        #include "lib/space.glsl"
        uniform usampler2D voxels;
        uniform sampler2D viewZ;
        uniform mat4 world_from_view;
        uniform vec4 ray_from_pixel;
        uniform float depth;
        uniform float lift;
        uniform float middle;
        out float visibility;
        void main() {
            float surfaceZ = texelFetch(viewZ, ivec2(gl_FragCoord.xy), 0).r;
            visibility = 0.0;
            if (isBackground(surfaceZ)) return;
            vec3 worldPos = (world_from_view * vec4(viewPosAt(gl_FragCoord.xy, surfaceZ, ray_from_pixel), 1.0)).xyz;
            vec3 inGrid = (worldPos + vec3(0.0, lift - middle, 0.0)) / depth + 0.5;
            uint slice = uint(clamp(1.0 - inGrid.y, 0.0, 0.999) * 128.0);
            uvec4 bits = texture(voxels, inGrid.zx);
            visibility = float((bits[slice / 32u] >> (slice % 32u)) & 1u);
        }
        """
        voxels = GeometryPass("voxels", draw, {"voxels": "RGBA32UI"}, seen_from=from_above, combine="or")
        return Estimate([Pass("read voxels", read, self.outputs)], self.outputs, once=[voxels])


@pytest.fixture(scope="module")
def towers() -> Scene:
    """Two tables, a plate on posts each: two surfaces one above the other, of which a depth map would know one."""
    plates = [small_scenes.box((x - 0.9, y, -0.9), (x + 0.9, y + 0.05, 0.9)) for x, y in ((-1, 1.2), (1, 0.6))]
    return small_scenes.of(small_scenes.floor(2), *plates, camera=Camera((0.5, 5, 4), (0, 0.5, 0), fov=45))


@pytest.mark.parametrize("settings", [{}, {"scale": 0.5}, {"accumulate": 2}], ids=str)
def test_a_geometry_pass_sets_the_bits_of_all_surfaces_one_above_the_other(lab, towers, settings):
    """Every surface that is seen is in the grid, the floor below a plate as well, and the air between them is not."""
    depth = 2 * towers.radius
    module = Voxels(depth=depth, middle=towers.bounds[:, 1].mean(), filter="none")
    voxel = 2 * towers.radius / SLICES
    seen = lab.render(towers, module, size=SIZE, **settings)
    inside = edges_left_out(seen.mask)
    assert (seen["visibility"][inside] > 0.99).mean() > 0.85  # a plate's side falls between the grid's columns
    lifted = lab.render(towers, module.replace(lift=4 * voxel), size=SIZE, **settings)
    assert (lifted["visibility"][inside] < 0.01).mean() > 0.85
    assert "voxels" in seen.timings


def edges_left_out(mask: np.ndarray) -> np.ndarray:
    """The pixels whose neighbours are all in the mask."""
    padded = np.pad(mask, 1)
    return np.logical_and.reduce(
        [np.roll(padded, shift, axis=(0, 1))[1:-1, 1:-1] for shift in ((0, 1), (1, 0), (0, -1))]
    )


# --- lighting with a light's G-buffer before it, samples and a filter: a reflective shadow map


class Glow(Module):
    """Ambient light from samples of what the first light sees: the mean of their albedo."""

    def lighting(self) -> Sequence[Pass | Estimate]:
        draw = """
        uniform sampler2D base_texture;
        uniform vec4 base_color;
        in vec2 uv;
        out vec4 flux;
        void main() { flux = base_color * texture(base_texture, uv); }
        """
        gather = """
        uniform sampler2D flux;
        uniform vec2 spot[8];
        uniform vec3 light_color[1];
        out vec4 glow;
        void main() {
            glow = vec4(0.0);
            for (int i = 0; i < 8; ++i) glow += texture(flux, fract(spot[i] + gl_FragCoord.xy * 0.37)) / 8.0;
            glow.rgb *= light_color[0];
        }
        """
        glow = {"glow": "RGBA16F"}
        return [
            GeometryPass("light's view", draw, {"flux": "RGBA16F"}, seen_from=from_above),
            DIRECT,
            Estimate([Pass("gather", gather, glow)], glow),
            reflect("glow", "ambient"),
        ]

    shader = "none.frag"

    def samples(self, seed: int) -> dict[str, bytes]:
        return {"spot": np.random.default_rng(seed).random((8, 2), np.float32).tobytes()}


def test_lighting_takes_samples_of_a_lights_view_and_is_averaged_and_filtered(lab):
    """Half of the floor is red, half green: the mean of all samples is half of each."""
    left, right = (
        small_scenes.quad((x, 0, 2), (2, 0, 0), (0, 0, -4), Material(color))
        for x, color in ((-2, (1.0, 0.0, 0.0)), (0, (0.0, 1.0, 0.0)))
    )
    sun = DirectionalLight((0, -1, 0), (1.0, 1.0, 1.0))
    scene = small_scenes.of(left, right, camera=Camera((0, 4, 0), (0, 0, 0), up=(0, 0, -1)), lights=(sun,), sky=DARK)
    view = {"size": SIZE, "filter": "none"}
    one, other = (lab.render(scene, Glow, seed=seed, **view) for seed in (0, 1))
    assert not np.array_equal(one["glow"], other["glow"])
    assert {"light's view", "gather"} <= set(one.timings)
    many = lab.render(scene, Glow, accumulate=32, **view)
    spread = [frame["glow"][..., 0].std() for frame in (one, many)]
    assert spread[1] < 0.5 * spread[0]
    covered = 4 / (2 * scene.radius) ** 2 * 4  # of the light's square view
    np.testing.assert_allclose(many["glow"].mean(axis=(0, 1))[:2], covered / 2, rtol=0.1)
    filtered = lab.render(scene, Glow, size=SIZE)
    assert filtered["glow"].std() < filtered["glow_raw"].std()
    expected = filtered["albedo"] / np.pi * filtered["glow"][..., :3]
    np.testing.assert_allclose(filtered["ambient"], expected, atol=1e-3)


def test_relighting_draws_the_lights_view_again(lab, boxes):
    frame = lab.render(boxes, Glow, size=SIZE)
    brighter = lab.relight(frame, lights=(DirectionalLight((0, -1, 0), (2.0, 2.0, 2.0)),))
    dim = lab.relight(frame, lights=(DirectionalLight((0, -1, 0), (1.0, 1.0, 1.0)),))
    assert "light's view" in brighter.timings
    assert "none" not in " ".join(brighter.timings)
    np.testing.assert_allclose(brighter["glow"][..., :3], 2 * dim["glow"][..., :3], atol=1e-2)


# --- a filter of one's own


class Offset(Filter):
    """Adds a number, so that it shows where the filter ran, and how often."""

    name = "offset"
    upsampling = "pipeline/upsample.frag"
    amount: float = parameter(0.125, "The number.", ge=0, le=1)

    def passes(self, formats: Mapping[str, str]) -> list[Pass]:
        text = """
        #include "lib/sources.glsl"
        uniform float amount;
        uniform sampler2D viewZ;
        void main() {
            float size = float(textureSize(viewZ, 0).x) / 1024.0;
            writeResults(sourcesAt(ivec2(gl_FragCoord.xy)) + amount * mat4(1.0) * 0.0
                         + mat4(vec4(amount + size), vec4(0.0), vec4(0.0), vec4(0.0)));
        }
        """
        return [over_sources("offset", text, formats)]


class OffsetAtFullSize(Offset):
    """The same, after the upsampling, which takes the nearest small pixel."""

    at_full_size = True
    upsampling = """
    #include "lib/sources.glsl"
    uniform sampler2D smallViewZ;
    uniform sampler2D viewZ;
    void main() {
        vec2 share = vec2(textureSize(smallViewZ, 0)) / vec2(textureSize(viewZ, 0));
        writeResults(sourcesAt(ivec2(gl_FragCoord.xy * share)));
    }
    """


@pytest.mark.parametrize(("own", "width"), [(Offset, 32), (OffsetAtFullSize, 64)])
def test_a_filter_of_ones_own_runs_at_the_size_that_it_wants(lab, plane, own, width):
    """On a plane of visibility 1 the result is 1 + the filter's parameter + the width at which it ran."""
    frame = lab.render(plane, "none", filter=own(amount=0.25), scale=0.5, size=SIZE)
    np.testing.assert_allclose(frame["visibility"][frame.mask], 1.25 + width / 1024, atol=2e-3)
    np.testing.assert_array_equal(frame["visibility_raw"].shape, (24, 32))
    assert frame.info["parameters"]["filter"] == "offset"
    assert frame.info["parameters"]["amount"] == 0.25


@pytest.mark.filterwarnings("ignore:.*reaches from")  # it is a probe
def test_an_estimate_may_bring_its_filter(lab, plane):
    class Own(Module):
        shader = "none.frag"

        def estimate(self) -> Estimate:
            return Estimate(self.passes(), self.outputs, filter=Offset(amount=0.5))

    frame = lab.render(plane, Own, size=SIZE)
    np.testing.assert_allclose(frame["visibility"][frame.mask], 1.5 + 64 / 1024, atol=2e-3)


# --- an occluder kind of one's own


class Below(OccluderKind):
    """All that lies lower than `height` is solid; with `left_only`, in the left half of the picture only."""

    name = "below"
    uniforms = ("solid_color",)
    height: float = parameter(0.0, "The solid's upper side.", unit="scene units")
    left_only: bool = parameter(False, "For receivers in the left half of the picture only.")
    shader = """
    #include "occluders/surfaces.glsl"
    const bool left_only;
    uniform float height;
    uniform sampler2D solid_color;
    struct Occluder { vec3 viewPos; };
    bool isBlocked(Receiver receiver, vec3 samplePos, float thickness, out Occluder occluder) {
        occluder.viewPos = samplePos;
        bool below = (world_from_view * vec4(samplePos, 1.0)).y + world_origin.y < height;
        return below && !(left_only && receiver.uv.x > 0.5);
    }
    vec3 occluderNormal(Occluder occluder) { return mat3(view_from_world) * vec3(0.0, 1.0, 0.0); }
    vec3 occluderRadiance(Occluder occluder) { return texelFetch(solid_color, ivec2(0), 0).rgb; }
    """

    def draw(self, drawing, view, surfaces, sends):
        text = "out vec4 solid_color;\nvoid main() { solid_color = vec4(0.25, 0.5, 0.75, 1.0); }\n"
        drawn = drawing.run(Pass("solid", text, {"solid_color": "RGBA16F"}), [], (1, 1))
        return replace(super().draw(drawing, view, surfaces, sends), bindings=self.bindings(drawn))


CONVERGED = {"directions": 64, "steps": 16, "filter": "none", "radius": 1.0, "falloff": 0.0}


def test_a_kind_of_ones_own_is_asked_by_every_method(lab):
    """In the middle of an endless solid nothing is open; over it, the hemisphere; and the metadata are flat."""
    scene = small_scenes.plane(Camera((0, 3, 0.1), (0, 0, 0)))
    for module in ("ssao", "ssdo", "s3ho", "ssbn"):
        settings = {name: value for name, value in CONVERGED.items() if name != "steps"}
        closed = lab.render(scene, module, occluders=Below(height=5.0), size=SIZE, **settings)
        assert (closed["visibility"][closed.mask] < 0.01).all(), module
        open = lab.render(scene, module, occluders=Below(height=-1.0), size=SIZE, **settings)
        assert (open["visibility"][open.mask] > 0.99).all(), module
    assert closed.info["parameters"]["occluders"] == "below"
    assert closed.info["parameters"]["height"] == 5.0
    assert "solid" in closed.timings


def test_a_kind_reads_its_receiver(lab):
    scene = small_scenes.plane(Camera((0, 3, 0.1), (0, 0, 0)))
    frame = lab.render(scene, "ssao", occluders=Below(height=5.0, left_only=True), size=SIZE, **CONVERGED)
    left, right = frame["visibility"][:, :32], frame["visibility"][:, 32:]
    assert (left == 0).all()
    assert (right == 1).all()


def test_a_kind_of_ones_own_sends_light(lab):
    scene = small_scenes.plane(Camera((0, 3, 0.1), (0, 0, 0)), material=Material((0.5, 0.5, 0.5)))
    frame = lab.render(scene, "ssdo", bounces=1, senders="rays", occluders=Below(height=5.0), size=SIZE, **CONVERGED)
    assert frame["indirect"].shape == (48, 64, 3)


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
def test_the_visibilities_of_two_kinds_are_multiplied(lab, boxes, order):
    """Of one direction, visibility is 0 or 1: open for both kinds, or closed."""
    one = {"directions": 1, "steps": 8, "filter": "none", "radius": 0.8, "size": SIZE}
    kinds = Below(height=0.3), Depth()
    for seed in range(3):
        first, second = (lab.render(boxes, "ssao", occluders=kind, seed=seed, **one)["visibility"] for kind in kinds)
        product = Product(first=kinds[order[0]], second=kinds[order[1]])
        frame = lab.render(boxes, "ssao", occluders=product, seed=seed, **one)
        np.testing.assert_array_equal(frame["visibility"], first * second)
        assert 0.05 < np.nanmean(frame["visibility"]) < min(np.nanmean(first), np.nanmean(second))
    assert frame.info["parameters"]["occluders"] == "product"
    assert {frame.info["parameters"][name] for name in ("first", "second")} == {"below", "depth"}


# --- buffers of surfaces on demand


def reading(name: str, swizzle: str) -> type[Module]:
    """A module that shows a buffer of the surfaces."""
    text = f"""
    uniform sampler2D {name};
    out vec4 shown;
    out float visibility;
    void main() {{ shown = texelFetch({name}, ivec2(gl_FragCoord.xy), 0).{swizzle}; visibility = 1.0; }}
    """
    return type("Reading", (Module,), {"shader": text, "outputs": {"visibility": "R16F", "shown": "RGBA32F"}})


def test_texture_coordinates_and_tangents_are_drawn_where_a_pass_samples_them(lab):
    """A quad whose u grows to the right in the picture, and whose v grows up."""
    wall = small_scenes.quad((-2, -1, 0), (4, 0, 0), (0, 2, 0))
    scene = small_scenes.of(wall, camera=Camera((0, 0, 3), (0, 0, 0), fov=30))
    frame = lab.render(scene, reading("uv", "xyxy"), filter="none", size=SIZE)
    x, y, _ = np.moveaxis(small_scenes.world_positions(frame, scene.camera), -1, 0)
    np.testing.assert_allclose(frame["shown"][..., 0], (x + 2) / 4, atol=1e-4)
    np.testing.assert_allclose(frame["uv"][..., 1], (y + 1) / 2, atol=1e-4)
    frame = lab.render(scene, reading("tangent", "xyzw"), filter="none", size=SIZE)
    np.testing.assert_allclose(frame["shown"][..., :3] - (1, 0, 0), 0, atol=2e-3)
    half = lab.render(scene, reading("uv", "xyxy"), filter="none", scale=0.5, size=SIZE)
    assert half["shown_raw"].shape == (24, 32, 4)
    np.testing.assert_allclose(half["shown_raw"][..., 0], frame_uv(half, scene.camera), atol=0.02)
    assert not {"uv", "tangent", "motion", "emission"} & set(lab.render(scene, "ssao", size=SIZE).buffers)


def test_emission_is_the_materials_times_its_texture(lab):
    """The left half of a wall glows: the texture is black on the right."""
    pixels = np.full((8, 16, 4), 255, np.uint8)
    pixels[:, 8:, :3] = 0
    glowing = Material((0.5, 0.5, 0.5), emission=(3.0, 2.0, 100000.0), emission_texture=aolab.Texture(pixels))
    lamp = small_scenes.quad((-2, -1, 0), (4, 0, 0), (0, 2, 0), glowing)
    dark = small_scenes.quad((-9, -9, -1), (18, 0, 0), (0, 18, 0))
    scene = small_scenes.of(dark, lamp, camera=Camera((0, 0, 6), (0, 0, 0), fov=40))
    frame = lab.render(scene, reading("emission", "xyzw"), filter="none", size=SIZE)
    x, _, z = np.moveaxis(small_scenes.world_positions(frame, scene.camera), -1, 0)
    on_lamp = z > -0.5
    glows, black = (on_lamp & (low < x) & (x < high) for low, high in ((-1.8, -0.3), (0.3, 1.8)))  # off the seams
    assert glows.sum() > 100
    np.testing.assert_allclose(frame["emission"][glows], np.tile((3.0, 2.0, 1e5), (glows.sum(), 1)))
    assert (frame["emission"][black] == 0).all()
    assert (frame["emission"][~on_lamp] == 0).all()
    np.testing.assert_array_equal(frame["shown"][..., :3], frame["emission"])


def frame_uv(frame: aolab.Frame, camera: Camera) -> np.ndarray:
    """u at the centres of the half-size pixels."""
    x = small_scenes.world_positions(frame, camera)[..., 0]
    return ((x + 2) / 4).reshape(24, 2, 32, 2).mean(axis=(1, 3))


# --- the last frame

HISTORY = """
#include "lib/space.glsl"
const bool has_last;
uniform sampler2D viewZ;
uniform sampler2D last_visibility;
uniform sampler2D last_viewZ;
uniform sampler2D motion;
uniform mat4 last_from_view;
uniform vec4 last_pixel_from_ray;
uniform vec4 ray_from_pixel;
out float visibility;
out vec4 found;
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    visibility = 0.125;
    found = vec4(0.0);
    float surfaceZ = texelFetch(viewZ, pixel, 0).r;
    if (!has_last || isBackground(surfaceZ)) return;
    vec3 lastPos = (last_from_view * vec4(viewPosAt(gl_FragCoord.xy, surfaceZ, ray_from_pixel), 1.0)).xyz;
    vec2 lastPixel = pixelAt(lastPos, last_pixel_from_ray);
    ivec2 nearest = clamp(ivec2(lastPixel), ivec2(0), textureSize(last_viewZ, 0) - 1);
    visibility = texelFetch(last_visibility, nearest, 0).r + 0.125;
    vec2 moved = gl_FragCoord.xy - lastPixel;
    found = vec4(lastPos.z, texelFetch(last_viewZ, nearest, 0).r, moved - texelFetch(motion, pixel, 0).xy);
}
"""


class History(Module):
    """Counts the frames since the first one."""

    shader = HISTORY
    outputs = {"visibility": "R16F", "found": "RGBA32F"}  # noqa: RUF012


def test_a_module_reads_the_last_frames_estimate_and_view(lab):
    """A camera moves along a plane: the surface is found again in the last frame, at its depth there."""
    cameras = [Camera((0.2 * i, 3, 3), (0.2 * i, 0, 0)) for i in range(4)]
    last, first = None, None
    for number, camera in enumerate(cameras, start=1):
        last = lab.render(small_scenes.plane(), History, camera=camera, last=last, filter="none", size=SIZE)
        first = first or weakref.ref(last.kept)
        assert (last["visibility"][last.mask] == number * 0.125).mean() > 0.95  # where the edge was in the last picture
        assert ("last_visibility" in last.buffers) is False
    found = last["found"][:, 12:-12]
    seen = last.mask[:, 12:-12]
    np.testing.assert_allclose(found[seen][:, 0], found[seen][:, 1], rtol=0.02)  # half a pixel of a plane seen aslant
    np.testing.assert_allclose(found[seen][:, 2:], 0, atol=1e-3)
    gc.collect()
    assert first() is None, "frames must not keep their last frames, or an animation would keep all"


def test_without_a_last_frame_the_history_begins(lab, plane):
    frame = lab.render(plane, History, filter="none", size=SIZE)
    assert (frame["visibility"][frame.mask] == 0.125).all()
    assert (lab.render(plane, History, filter="none", size=SIZE, last=frame)["motion"] == 0).all()
    truth = aolab.reference(plane, size=SIZE, rays=2, buffers="visibility", cache=False)
    with pytest.raises(aolab.ParameterError, match=r"last: a frame of reference was not rendered by a lab"):
        lab.render(plane, History, last=truth)


# --- occluders are drawn for passes that include them


def test_no_occluders_are_drawn_for_a_module_whose_shaders_do_not_include_them(lab, boxes):
    plain = lab.render(boxes, "none").complete().timings.keys()
    for kind in ("layers", "views"):
        assert lab.render(boxes, "none", occluders=kind).complete().timings.keys() == plain


# --- beyond the edge of a texture


@pytest.mark.parametrize(("outside", "expected"), [({"mine": -2.0}, -2.0), ({}, 0.25)], ids=["declared", "nearest"])
@pytest.mark.filterwarnings("ignore:.*reaches from")  # it is a probe
def test_the_maker_of_a_texture_declares_what_is_read_beyond_its_edge(lab, plane, outside, expected):
    """A depth map of one's own, read one picture's width off to the right: nobody lists its name."""

    class Off(Module):
        def passes(self) -> list[Pass]:
            write = "out float mine;\nvoid main() { mine = 0.25; }\n"
            read = """
            uniform sampler2D mine;
            uniform vec2 texel_size;
            out float visibility;
            void main() { visibility = texture(mine, gl_FragCoord.xy * texel_size + vec2(1.0, 0.0)).r; }
            """
            return [Pass("write", write, {"mine": "R32F"}, outside=outside), Pass("read", read, {"visibility": "R32F"})]

    for _ in range(2):  # textures come from a pool: the second time, the first one's
        frame = lab.render(plane, Off, filter="none", size=SIZE)
        assert (frame["visibility"][frame.mask] == expected).all()
