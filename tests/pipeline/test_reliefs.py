"""Normal maps, height maps and the occluder kind `height`, against real geometry and rays."""

import numpy as np
import pytest
import small_scenes
from small_scenes import of, quad

import aolab
from aolab import SSAO, Camera, HeightMap, Instance, Material, Mesh, ParameterError, Scene, SceneError, Texture
from aolab.gl import texture as gl_texture
from aolab.maths.tangents import mikktspace
from aolab.modules.occluders import Height
from aolab.papers.pixels import world_positions

ABOVE = Camera(eye=(0.2, 4.0, 1.5), target=(0, 0, 0), fov=30)
CONVERGED = {"directions": 32, "steps": 16, "accumulate": 4, "filter": "none", "bias": 0.0}


def normal_map(*rows: tuple[tuple[float, float, float], ...]) -> Texture:
    """A texture of given unit normals, tangent space; top row first."""
    values = np.round((np.array(rows) + 1) / 2 * 255).astype(np.uint8)
    return Texture(np.dstack([values, np.full(values.shape[:2], 255, np.uint8)]), nearest=True, mipmaps=False)


def floor(material: Material, matrix: np.ndarray | None = None) -> Scene:
    """The square from -1 to 1 in x and z; u grows with x, v with -z."""
    mesh = quad((-1, 0, 1), (2, 0, 0), (0, 0, -2), material)
    return Scene((Instance(mesh, np.eye(4) if matrix is None else matrix),), (), small_scenes.SKY, ABOVE)


TILTED = np.array((0.6, 0.0, 0.8))


# --- normal maps


def test_a_normal_map_turns_the_shading_normals_and_keeps_the_geometric_ones(lab):
    frame = lab.render(floor(Material(normal_texture=normal_map((tuple(TILTED),)))), "ssao")
    np.testing.assert_allclose(frame.world_normal()[frame.mask].mean(axis=0), (0.6, 0.8, 0.0), atol=6e-3)
    np.testing.assert_allclose(
        frame["geometricNormal"][frame.mask] @ ABOVE.view_from_world[:3, :3], [(0, 1, 0)] * frame.mask.sum(), atol=1e-3
    )


@pytest.mark.parametrize(
    ("matrix", "expected"),
    [
        (np.diag([1.0, 1, 1, 1]), (0.0, 0.8, -0.6)),  # green is up in the texture, which is -z
        (np.diag([-1.0, 1, 1, 1]), (0.0, 0.8, -0.6)),
        (np.diag([1.0, 1, -1, 1]), (0.0, 0.8, 0.6)),
        (np.diag([2.0, 3, 2, 1]), (0.0, 0.8, -0.6)),
    ],
    ids=["plain", "mirrored in x", "mirrored in z", "scaled"],
)
def test_green_points_to_growing_v_in_every_instance(lab, matrix, expected):
    frame = lab.render(floor(Material(normal_texture=normal_map(((0.0, 0.6, 0.8),))), matrix), "ssao")
    np.testing.assert_allclose(frame.world_normal()[frame.mask].mean(axis=0), expected, atol=6e-3)


def test_the_scale_multiplies_x_and_y(lab):
    frame = lab.render(floor(Material(normal_texture=normal_map((tuple(TILTED),)), normal_scale=0.5)), "ssao")
    expected = np.array((0.3, 0.8, 0.0)) / np.hypot(0.3, 0.8)
    np.testing.assert_allclose(frame.world_normal()[frame.mask].mean(axis=0), expected, atol=6e-3)


def test_given_tangents_are_used(lab):
    """Turned by 90 degrees: the map's x is then along -z."""
    mesh = quad((-1, 0, 1), (2, 0, 0), (0, 0, -2))
    tangents = np.tile((0.0, 0.0, -1.0, 1.0), (4, 1))
    material = Material(normal_texture=normal_map((tuple(TILTED),)))
    turned = Mesh(mesh.vertices, mesh.faces, mesh.normals, mesh.uv, material=material, tangents=tangents)
    frame = lab.render(of(turned, camera=ABOVE), "ssao")
    np.testing.assert_allclose(frame.world_normal()[frame.mask].mean(axis=0), (0, 0.8, -0.6), atol=6e-3)


def beside_a_wall(texture: Texture, height: float = 0.5) -> Scene:
    """The floor with a normal map, and a wall at x = 0.4."""
    scene = floor(Material(normal_texture=texture))
    wall = small_scenes.box((0.4, 0.0, -1.0), (0.6, height, 1.0))
    return scene.replace(instances=(*scene.instances, Instance(wall)))


def test_the_choice_of_normals_is_the_estimates_and_the_references(lab):
    """A hemisphere that is tilted by 37 degrees towards a wall sees more of the wall than the vertices' own.

    Its directions below the floor are mirrored at the floor, which therefore blocks none of them.
    """
    scene = beside_a_wall(normal_map((tuple(TILTED),)))
    size, near = (48, 36), np.s_[14:22, 24:27]
    settings = {"radius": 0.5, "falloff": 0.0, "thickness": 10.0, "size": size, "directions": 32, "steps": 16}
    found, truth = {}, {}
    for normals in ("shading", "geometric"):
        frame = lab.render(scene, "ssao", normals=normals, filter="none", accumulate=4, **settings)
        away = lab.render(floor(scene.instances[0].mesh.material), "ssao", normals=normals, **settings)
        assert (away["visibility"][away.mask] == 1).all()
        found[normals] = frame["visibility"][near].mean()
        rays = aolab.reference(scene, size=size, rays=128, radius=0.5, normals=normals, buffers="visibility")
        truth[normals] = rays["visibility"][near].mean()
        np.testing.assert_allclose(frame.world_normal()[near].mean(axis=(0, 1)), (0.6, 0.8, 0.0), atol=6e-3)
    assert truth["shading"] < truth["geometric"] - 0.1
    for normals in truth:
        assert found[normals] == pytest.approx(truth[normals], abs=0.03)


def test_scenes_without_maps_draw_and_read_nothing_more(lab, boxes):
    frame = lab.render(boxes, "ssao", normals="geometric")
    assert "geometricNormal" not in frame.buffers
    np.testing.assert_array_equal(frame["visibility"], lab.render(boxes, "ssao")["visibility"])


def test_a_filter_works_on_one_surface_whatever_the_normals(lab):
    """Neighbours whose normals differ by a map alone are of one surface: the mean of 4×4 pixels."""
    bumps = normal_map(((0.6, 0.0, 0.8), (-0.6, 0.0, 0.8)), ((0.0, 0.6, 0.8), (0.0, -0.6, 0.8)))
    scene = beside_a_wall(bumps, height=1.5)
    for scale in (1.0, 0.5):
        frame = lab.render(scene, "ssao", radius=2.0, thickness=10.0, size=(64, 48), scale=scale)
        inside = np.s_[18:30, 30:36] if scale == 1 else np.s_[9:15, 15:18]
        raw, filtered = frame["visibility_raw"][inside], frame["visibility"][18:30, 30:36]
        assert np.abs(np.diff(filtered, axis=0)).mean() < 0.6 * np.abs(np.diff(raw, axis=0)).mean()


@pytest.mark.filterwarnings("error")
def test_maps_without_uv_are_named():
    mesh = small_scenes.box((0, 0, 0), (1, 1, 1))
    for material in (
        Material(normal_texture=normal_map((tuple(TILTED),))),
        Material(height=HeightMap(np.zeros((2, 2)))),
    ):
        with pytest.warns(aolab.Notice, match="mesh 'box': a normal map or a height map but no uv; drawn without"):
            made = Mesh(mesh.vertices, mesh.faces, material=material, name="box")
        assert not made.material.bends_normals


# --- tangents


def sphere() -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """A grid on a sphere, u around it and v up; its seam has vertices of both ends."""
    u, v = np.meshgrid(np.linspace(0, 1, 17), np.linspace(0.1, 0.9, 9))
    azimuth, polar = 2 * np.pi * u, np.pi * (1 - v)
    points = np.stack([np.sin(polar) * np.cos(azimuth), np.cos(polar), -np.sin(polar) * np.sin(azimuth)], axis=-1)
    index = np.arange(u.size).reshape(u.shape)
    a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]
    faces = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
    return points.reshape(-1, 3), faces, points.reshape(-1, 3), np.stack([u, v], axis=-1).reshape(-1, 2)


@pytest.mark.parametrize("mirrored", [False, True])
def test_tangents_follow_u_on_the_surface(mirrored):
    vertices, faces, normals, uv = sphere()
    if mirrored:
        uv = uv * (-1, 1)
    points, _, source, tangents = mikktspace(vertices, faces, normals, uv)
    assert len(points) == len(vertices)
    along = np.cross((0, 1, 0), points) * (-1 if mirrored else 1)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    inner = uv[source, 0] % 1 != 0
    assert ((tangents[:, :3] * along).sum(axis=1)[inner] > 0.998).all()
    assert ((tangents[:, :3] * along).sum(axis=1) > 0.97).all()  # the seam averages one side only
    np.testing.assert_allclose((tangents[:, :3] * normals[source]).sum(axis=1), 0, atol=1e-6)
    np.testing.assert_array_equal(tangents[:, 3], -1 if mirrored else 1)


def test_a_vertex_between_two_sides_of_a_texture_is_split():
    """Two triangles share an edge; the second shows the texture mirrored."""
    vertices = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], float)
    faces = np.array([(0, 1, 2), (1, 3, 2)])
    uv = np.array([(0, 0), (1, 0), (0, 1), (0.2, 0.2)], float)
    points, split, source, tangents = mikktspace(vertices, faces, np.tile((0.0, 0, 1), (4, 1)), uv)
    assert len(points) == 6
    np.testing.assert_array_equal(source[split], faces)
    assert (tangents[split[0], 3] == 1).all()
    assert (tangents[split[1], 3] == -1).all()


def test_a_triangle_without_uv_area_takes_its_neighbours_tangents():
    vertices = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], float)
    faces = np.array([(0, 1, 2), (1, 3, 2)])
    uv = np.array([(0, 0), (0, 1), (-1, 0), (0, 1)], float)
    _, split, _, tangents = mikktspace(vertices, faces, np.tile((0.0, 0, 1), (4, 1)), uv)
    np.testing.assert_allclose(tangents[split[0], :3], [(0, -1, 0)] * 3, atol=1e-6)
    assert np.isfinite(tangents).all()
    np.testing.assert_allclose(np.linalg.norm(tangents[:, :3], axis=1), 1, atol=1e-6)


# --- height maps


def ramp(rise: float) -> HeightMap:
    """A plane that rises by `rise` from u = 0 to u = 1."""
    return HeightMap(np.tile(rise * (np.arange(64) + 0.5) / 64, (64, 1)), wrap=("clamp", "clamp"))


def test_a_height_map_bends_the_normals_by_its_slope(lab):
    frame = lab.render(floor(Material(height=ramp(1.0))), "ssao", size=(48, 36))
    slope = np.array((-0.5, 1.0, 0.0)) / np.hypot(0.5, 1)  # a rise of 1 over 2
    np.testing.assert_allclose(frame.world_normal()[12:24, 16:32].mean(axis=(0, 1)), slope, atol=5e-3)
    turned = floor(Material(height=ramp(1.0)), np.diag([3.0, 3, 3, 1]))
    frame = lab.render(turned, "ssao", size=(48, 36))
    np.testing.assert_allclose(frame.world_normal()[12:24, 16:32].mean(axis=(0, 1)), slope, atol=5e-3)


def test_a_slope_without_bumps_is_open(lab):
    """The normals of the relief are perpendicular to it: nothing of a plane rises over its own hemisphere."""
    scene = floor(Material(height=ramp(1.0)))
    frame = lab.render(scene, "ssao", occluders="height", depth_too=False, radius=0.3, size=(48, 36), filter="none")
    assert (frame["visibility"][12:24, 16:32] == 1).all()


@pytest.mark.parametrize("depth_too", [False, True])
def test_a_flat_height_map_is_exactly_open_from_every_side(lab, depth_too):
    material = Material(height=HeightMap(np.full((4, 4), 0.3)))
    for eye in ((0.2, 4.0, 1.5), (0.2, -4.0, 1.5), (0.0, 0.1, 3.0)):
        scene = floor(material).replace(camera=Camera(eye, (0, 0, 0), fov=30))
        frame = lab.render(scene, "ssao", occluders="height", depth_too=depth_too, radius=0.3, bias=0.0, filter="none")
        assert (frame["visibility"][frame.mask] == 1).all()


PIT, WIDE = 0.25, 0.5  # depth and half width of a square pit


def pit(carved: bool) -> Scene:
    """A floor with a square pit in its middle: as a height map, or as geometry."""
    camera = Camera(eye=(0, 6.0, 0), target=(0, 0, 0), up=(0, 0, -1), ortho=2.2)  # no parallax
    if not carved:
        texel = (np.arange(128) + 0.5) / 64 - 1
        inside = (np.abs(texel)[:, None] < WIDE) & (np.abs(texel) < WIDE)
        return floor(Material((0.7, 0.7, 0.7), height=HeightMap(np.where(inside, -PIT, 0.0)))).replace(camera=camera)
    w, d = WIDE, PIT
    gray = Material((0.7, 0.7, 0.7))
    meshes = [quad((-w, -d, w), (2 * w, 0, 0), (0, 0, -2 * w), gray)]
    for turn in range(4):
        c, s = np.round(np.cos(turn * np.pi / 2)), np.round(np.sin(turn * np.pi / 2))
        matrix = np.array([(c, 0, s), (0, 1, 0), (-s, 0, c)])
        meshes.append(quad(matrix @ (-w, -d, w), matrix @ (0, d, 0), matrix @ (2 * w, 0, 0), gray))
        meshes.append(quad(matrix @ (-1.0, 0, 1.0), matrix @ (1.0 + w, 0, 0), matrix @ (0, 0, -(1 - w)), gray))
    return of(*meshes, camera=camera)


@pytest.mark.slow
@pytest.mark.parametrize("module", ["ssao", "ambient_transfer", "s3ho", "ssdo", "ssbn"])
def test_a_pit_in_the_map_occludes_as_a_pit_of_geometry(lab, module):
    # a ray that meets a wall just below its rim is in the solid for a short way: many steps
    settings = {**CONVERGED, "steps": 32, "radius": 0.4, "size": (64, 64), "normals": "geometric"}
    for depth_too in (False, True):
        frame = lab.render(pit(carved=False), module, occluders="height", depth_too=depth_too, **settings)
        question = frame.info["question"] | {"normals": "shading"}
        truth = aolab.reference(
            pit(carved=True), size=(64, 64), like=aolab.Question(**question), rays=128, buffers="visibility"
        )
        y = world_positions(truth)[..., 1]
        x, z = (world_positions(frame)[..., axis] for axis in (0, 2))
        bottom = truth.mask & (y < -0.9 * PIT) & (np.abs(x) < 0.9 * WIDE) & (np.abs(z) < 0.9 * WIDE)
        assert bottom.sum() > 200
        assert truth["visibility"][bottom].min() < 0.85
        error = (frame["visibility"] - truth["visibility"])[bottom]
        assert abs(error.mean()) < 0.02, depth_too
        assert np.sqrt((error**2).mean()) < 0.05, depth_too


@pytest.mark.slow
def test_the_relief_of_the_scene_agrees_with_its_carved_twin(lab):
    """The map's obscurance lies nearer to that of the rays over real geometry than the depth buffer's does."""
    front = Camera((0, 1.125, 5), (0, 1.125, 0), ortho=2.0)  # without parallax between the wall and its carving
    settings: dict = {"size": (160, 90), "radius": 0.25, "camera": front, **CONVERGED}
    flat, carved = (aolab.load("relief", carved=carved) for carved in (False, True))
    by_map, by_depth = (
        lab.render(flat, "ambient_transfer", occluders=kind, **settings) for kind in ("height", "depth")
    )
    truth = aolab.reference(carved, like=by_map, rays=128, buffers=("obscurance", "transfer"))
    wall = (np.abs(world_positions(by_map)[..., 2]) < 1e-3) & (np.abs(world_positions(truth)[..., 2] - 0.045) < 0.05)
    for name in ("obscurance", "transfer"):
        ours, plain = (((frame[name] - truth[name])[wall] ** 2).mean() for frame in (by_map, by_depth))
        assert ours < 0.3 * plain, name
    assert np.corrcoef(by_map["obscurance"][wall], truth["obscurance"][wall])[0, 1] > 0.9


def test_the_depth_buffer_joins_in(lab):
    """The product of both: a box on the relief's floor counts only with it."""
    relief = floor(Material(height=HeightMap(np.zeros((2, 2)))))
    scene = relief.replace(instances=(*relief.instances, Instance(small_scenes.box((-0.3, 0, -0.3), (0.3, 0.6, 0.3)))))
    alone, both, depth = (
        lab.render(scene, "ssao", radius=0.3, **kind)
        for kind in ({"occluders": "height", "depth_too": False}, {"occluders": "height"}, {})
    )
    assert (alone["visibility"][alone.mask] == 1).all()
    np.testing.assert_array_equal(both["visibility"], depth["visibility"])
    assert both["visibility"][both.mask].min() < 0.8


def test_several_maps_lie_in_one_texture(lab):
    """Each mesh finds its own, of another size and another wrap."""
    maps = [ramp(1.0), HeightMap(np.zeros((3, 5)), wrap=("mirror", "repeat")), HeightMap(np.eye(7) * 0.2)]
    meshes = [
        quad((x, 0, 1), (1, 0, 0), (0, 0, -2), Material(height=one))
        for x, one in zip((-1.5, -0.5, 0.5), maps, strict=True)
    ]
    frame = lab.render(of(*meshes, camera=ABOVE), "ssao", size=(64, 48), occluders="height", radius=0.2)
    x = world_positions(frame)[..., 0]
    normal = frame.world_normal()
    assert normal[frame.mask & (x > -1.4) & (x < -0.6)][:, 0].max() < -0.6
    np.testing.assert_allclose(normal[frame.mask & (x > -0.4) & (x < 0.4)][:, 1], 1, atol=1e-3)


@pytest.mark.parametrize("wrap", ["repeat", "mirror", "clamp"])
def test_heights_are_interpolated_and_wrapped_as_stated(gl, wrap):
    from aolab.gl.bindings import Bindings
    from aolab.gl.program import Programs
    from aolab.gl.texture import Pool
    from aolab.modules.passes import Pass
    from aolab.pipeline.pass_runner import PassRunner
    from aolab.pipeline.reliefs import ReliefStore
    from aolab.truth.world import bilinear

    heights = np.random.default_rng(1).random((4, 3)).astype("f4")
    one = HeightMap(heights, wrap=(wrap, wrap))
    made = ReliefStore().of(floor(Material(height=one)))
    at = np.random.default_rng(2).uniform(-1.5, 2.5, (64, 2))
    shader = """#include "lib/relief.glsl"
uniform sampler2D rows;
out vec4 value;
void main() { value = vec4(heightAt(0, texelFetch(rows, ivec2(gl_FragCoord.xy), 0).xy)); }
"""
    rows = gl_texture.make((64, 1), "RGBA32F", np.pad(at, ((0, 0), (0, 2))).astype("f4").tobytes())
    given = Bindings("the test", {"rows": rows, "relief_atlas": made.atlas}, made.uniforms, {"reliefs": 1})
    run = PassRunner(Programs(), Pool()).run(Pass("heights", shader, {"value": "RGBA32F"}), [given], (64, 1))
    inside = {"repeat": at % 1, "mirror": np.abs((at + 1) % 2 - 1), "clamp": at.clip(0, 1)}[wrap]
    pad = {"repeat": "wrap", "mirror": "symmetric", "clamp": "edge"}[wrap]
    padded = np.pad(heights, 1, pad)[..., None]
    u, v = (inside[:, 0] * 3 + 1) / 5, ((1 - inside[:, 1]) * 4 + 1) / 6
    expected = bilinear(padded, u.astype("f4"), v.astype("f4"), repeat_rows=False)[:, 0]
    np.testing.assert_allclose(gl_texture.read(run["value"])[0, :, 0], expected, atol=5e-3)


def test_a_scene_without_height_maps_is_named(lab, boxes):
    with pytest.warns(
        aolab.Notice, match="scene 'scene' has no height map: occluders='height' finds the camera's depth"
    ):
        both = lab.render(boxes, "ssao", occluders="height")
    np.testing.assert_array_equal(both["visibility"], lab.render(boxes, "ssao")["visibility"])
    with pytest.warns(aolab.Notice, match="finds nothing, and all is open; set Material.height"):
        alone = lab.render(boxes, "ssao", occluders=Height(depth_too=False))
    assert (alone["visibility"][alone.mask] == 1).all()


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: HeightMap(np.zeros((2, 2, 3)), "bumps"), r"height map 'bumps': heights have shape \(2, 2, 3\), not"),
        (lambda: HeightMap(np.zeros((0, 2)), "bumps"), r"heights have shape \(0, 2\), not \(H, W\)"),
        (lambda: HeightMap([[0.0, np.nan]], "bumps"), r"height map 'bumps': some of its heights are not finite"),
        (lambda: HeightMap([[0.0]], wrap=("tile", "tile")), r"wrap = \('tile', 'tile'\) is not two of repeat, mirror"),
        (lambda: Material(height=np.zeros((2, 2))), r"material '': height = array(.|\n)* is not a HeightMap"),
        (lambda: Material(normal_scale=np.inf), r"normal_scale = inf is not a finite number"),
    ],
)
def test_wrong_maps_are_refused(make, message):
    with pytest.raises(SceneError, match=message):
        make()


def test_a_map_may_have_another_size_than_the_color():
    picture = Texture(np.full((8, 8, 4), 255, np.uint8))
    scene = floor(Material(texture=picture, height=HeightMap(np.zeros((3, 17)))))
    assert scene.height_maps[0].heights.shape == (3, 17)


def test_unknown_normals_are_refused():
    with pytest.raises(ParameterError, match=r"ssao: normals = 'bent' is not valid: shading or geometric"):
        SSAO(normals="bent")  # pyright: ignore[reportArgumentType]
    with pytest.raises(ParameterError, match=r"normals = 'bent' is not one of: shading, geometric"):
        aolab.Question(normals="bent")  # pyright: ignore[reportArgumentType]
