"""Voxels: the grid against an exact voxelisation, planes that must not block themselves, hidden occluders."""

import numpy as np
import pytest
from scipy.ndimage import binary_dilation
from small_scenes import OPEN, box, floor, of, quad, sphere

import aolab
from aolab import Camera
from aolab.errors import ParameterError
from aolab.gl import texture
from aolab.gl.program import Programs
from aolab.gl.texture import Pool
from aolab.modules.occluders.region import region_of
from aolab.modules.occluders.voxels import Voxels, check_size
from aolab.pipeline.geometry import Geometry
from aolab.pipeline.last_frame import NO_LAST
from aolab.pipeline.pass_runner import PassRunner
from aolab.pipeline.rasterizer import DepthTargets, Rasterizer
from aolab.scene.view import View, moved

pytestmark = pytest.mark.usefixtures("gl")
BALL = of(
    box((-1, 0, -1), (1, 1, 1)), sphere(0.6, (0.4, 1.6, 0.2), subdivisions=2), camera=Camera((0, 3, 6), (0, 1, 0))
)


def grid_of(scene: aolab.Scene, **parameters) -> tuple[np.ndarray, np.ndarray]:
    """(N, N, N) bool by x, y, z, and (4, 4), voxels from world space."""
    assert scene.camera is not None
    view = View(scene.camera, (32, 32), scene.bounds)
    drawing = Rasterizer(PassRunner(Programs(), Pool()), Geometry(), DepthTargets(), scene, NO_LAST)
    kind = Voxels(**parameters)
    bindings = kind.draw(drawing, view, {}, False).bindings
    words = texture.read(bindings.textures["voxelWords"])[::-1]  # first row at the bottom
    n, columns = kind.voxels, min(8, kind.voxels // 32)
    grid = np.zeros((n, n, n), bool)
    for index in range(n // 32):
        row, column = divmod(index, columns)
        tile = words[row * n : (row + 1) * n, column * n : (column + 1) * n]
        for bit in range(32):
            grid[:, :, 32 * index + bit] = (tile.T >> np.uint32(bit)) & 1
    voxel_from_view = np.frombuffer(bindings.uniforms["voxel_from_view"], np.float32).reshape(4, 4).T
    return grid, voxel_from_view @ scene.camera.view_from_world


def exact(scene: aolab.Scene, voxel_from_world: np.ndarray, n: int) -> np.ndarray:
    """The voxels that contain a point of the surface, by eight points for each voxel along every edge."""
    grid = np.zeros((n, n, n), bool)
    for instance in scene.instances:
        vertices = np.c_[instance.mesh.vertices, np.ones(len(instance.mesh.vertices))]
        placed = (vertices @ instance.world_from_local.T @ voxel_from_world.T)[:, :3]
        for a, b, c in placed[instance.mesh.faces]:
            steps = int(12 * max(np.linalg.norm(b - a), np.linalg.norm(c - a), np.linalg.norm(c - b))) + 2
            u, v = np.meshgrid(*[np.linspace(0, 1, steps)] * 2)
            inside = u + v <= 1
            points = a + u[inside][:, None] * (b - a) + v[inside][:, None] * (c - a)
            grid[tuple(np.floor(points).astype(int).T)] = True
    return grid


def around(grid: np.ndarray) -> np.ndarray:
    return binary_dilation(grid, np.ones((3, 3, 3)))


@pytest.mark.parametrize(
    ("parameters", "most_holes"),
    [
        ({}, 0.0),
        ({"voxel_turn": 0}, 0.0),
        ({"voxel_exact": False, "voxel_axes": 3}, 0.0),
        # one camera misses slivers that it sees edge-on, and prolongs steep triangles
        ({"voxel_exact": False}, 0.003),
    ],
    ids=str,
)
def test_the_grid_is_the_exact_voxelisation_within_a_voxel(parameters, most_holes):
    """Neither holes nor excess are larger than a voxel, however the triangles lie to the camera of the grid."""
    grid, voxel_from_world = grid_of(BALL, voxels=64, **parameters)
    right = exact(BALL, voxel_from_world, 64)
    assert (right & ~around(grid)).sum() / right.sum() <= most_holes
    assert (grid & ~around(right)).sum() / right.sum() <= most_holes


def test_every_voxel_that_a_triangle_touches_is_set():
    """Whatever lies between two sample points of `exact` is a sliver of the surface."""
    for turn in (0, 1):
        grid, voxel_from_world = grid_of(BALL, voxels=64, voxel_turn=turn)
        right = exact(BALL, voxel_from_world, 64)
        assert (right & ~grid).sum() <= 1e-3 * right.sum()  # points that lie in the side of two voxels
        assert (grid & ~right).sum() <= 0.03 * right.sum()


def test_the_papers_way_misses_edge_on_walls_unless_the_grid_is_turned_or_drawn_along_three_axes():
    """The paper's drawback, section 5: an axis-aligned wall leaves no fragment for an axis-aligned camera."""
    missing = {}
    for name, parameters in {
        "along": {"voxel_turn": 0},
        "turned": {"voxel_turn": 1},
        "three": {"voxel_turn": 0, "voxel_axes": 3},
    }.items():
        grid, voxel_from_world = grid_of(BALL, voxels=64, voxel_exact=False, **parameters)
        right = exact(BALL, voxel_from_world, 64)
        missing[name] = (right & ~around(grid)).sum() / right.sum()
    assert missing["along"] > 0.05
    assert missing["turned"] < 0.002
    assert missing["three"] == 0


def test_every_target_of_a_large_grid_is_drawn_and_packed():
    """512 slices are four targets and 16 words a column; a diagonal sheet crosses all of them."""
    scene = of(quad((-1, -1, -1), (2, 2, 0), (0, 0, 2)), camera=Camera((0, 3, 6), (0, 0, 0)))
    grid, voxel_from_world = grid_of(scene, voxels=512, voxel_turn=3)
    points = np.stack(np.meshgrid(np.linspace(-0.95, 0.95, 40), np.linspace(-0.95, 0.95, 40)), -1).reshape(-1, 2)
    world = np.c_[points[:, :1], points[:, :1], points[:, 1:], np.ones(len(points))]
    cells = np.floor((world @ voxel_from_world.T)[:, :3]).astype(int)
    for cell in cells:
        assert grid[tuple(slice(c - 1, c + 2) for c in cell)].any()
    assert len(np.unique(cells[:, 2] // 32)) > 4


@pytest.mark.parametrize("name", ["ssao", "hao", "ssdo", "s3ho", "ssbn"])
@pytest.mark.parametrize("parameters", [{"voxels": 64}, {"voxel_exact": False}, {"voxel_turn": 0}], ids=str)
def test_an_open_plane_does_not_block_itself(lab, name, parameters):
    """Also slanted in the grid, and in the world: the receiver's own voxels are left out."""
    slanted = quad((-4, -1, 4), (8, 1, 1), (0, 2, -8))
    for mesh in (floor(4.0), slanted):
        scene = of(mesh, camera=Camera((0, 3, 6), (0, 0, 0)))
        frame = lab.render(scene, name, occluders="voxels", radius=1.0, scale=1.0, size=(96, 72), **parameters)
        assert frame["visibility"][frame.mask].min() > 0.99


def test_hidden_and_off_screen_things_block(lab):
    """A slab in front hides a wall that darkens the floor; a wall beside the picture darkens it too."""
    hidden = box((-1.5, 0, -0.6), (1.5, 1.0, -0.5))
    front = box((-1.5, 0.3, 0.4), (1.5, 1.6, 0.5))
    away = Camera((0, 0.8, 5), (0, 0.2, 0), fov=35)
    scene = of(floor(3.0), hidden, front, camera=away)
    settings = {"radius": 0.8, "size": (120, 90), "filter": "none", "steps": 32, "directions": 32}
    truth = aolab.reference(scene, size=(120, 90), radius=0.8, falloff=0.3, rays=128, buffers=("visibility",))
    error = {
        kind: np.nanmean(
            np.abs(lab.render(scene, "ssao", occluders=kind, **settings)["visibility"] - truth["visibility"])
        )
        for kind in ("depth", "voxels")
    }
    assert error["voxels"] < 0.7 * error["depth"]


def test_a_hole_of_a_cut_out_is_no_voxel():
    pixels = np.full((4, 4, 4), 255, np.uint8)
    pixels[:, :2, 3] = 0
    leaf = aolab.Material((1.0, 1.0, 1.0), aolab.Texture(pixels, "leaf"), alpha_cutoff=0.5)
    camera = Camera((0, 3, 6), (0, 0, 0))
    whole, _ = grid_of(of(quad((-1, -1, 0), (2, 0, 0), (0, 2, 0)), camera=camera), voxels=64)
    cut, _ = grid_of(of(quad((-1, -1, 0), (2, 0, 0), (0, 2, 0), leaf), camera=camera), voxels=64)
    assert cut.sum() == pytest.approx(whole.sum() / 2, rel=0.1)
    assert not (cut & ~whole).any()


@pytest.mark.parametrize(
    ("parameters", "words"),
    [
        ({"voxels": 100}, "voxels = 100 is not a multiple of 32"),
        ({"voxels": 2048}, "voxels = 2048 is not valid: .*≤ 1024"),
        ({"voxel_region": ((0, 0, 0), (0, 0, 0))}, "voxel_region = .* has no extent"),
        ({"voxel_region": "lamp"}, r"voxel_region = 'lamp' is no object of scene 'scene'.*left, middle, right"),
    ],
)
def test_grids_that_cannot_be_made_are_refused(lab, boxes, parameters, words):
    with pytest.raises(ParameterError, match=words):
        lab.render(boxes, "ssao", occluders="voxels", **parameters)


def test_a_grid_beyond_the_driver_is_refused_with_the_largest_that_fits():
    """macOS and llvmpipe have 8 targets; OpenGL 3.3 guarantees 8, older tiers of drivers 4."""
    check_size(1024, 8)
    with pytest.raises(
        ParameterError, match=r"voxels = 1024 needs 8 targets of 128 slices; .* has 4: .* largest .* 512"
    ):
        check_size(1024, 4)


def test_a_region_without_meshes_is_noticed_and_open(lab, boxes):
    with pytest.warns(aolab.errors.Notice, match=r"voxel_region = .* holds no mesh"):
        frame = lab.render(boxes, "hao", voxel_region=((50, 50, 50), (60, 60, 60)))
    assert np.nanmin(frame["visibility"]) >= OPEN


def test_a_box_is_the_region_and_follows_an_object(lab):
    """Only occluders in the region count; the region of an object moves with it."""
    near, far = box((-2.0, 0, -0.5), (-1.0, 1.0, 0.5)), box((1.0, 0, -0.5), (2.0, 1.0, 0.5))
    scene = of(floor(4.0), near, far, camera=Camera((0, 4, 5), (0, 0, 0)))
    settings = {"radius": 0.5, "scale": 1.0, "size": (96, 72)}
    whole = lab.render(scene, "hao", **settings)["visibility"]
    left = lab.render(scene, "hao", voxel_region=((-3.0, -0.2, -1.5), (-0.4, 1.2, 1.5)), **settings)["visibility"]
    middle = whole.shape[1] // 2
    assert np.nanmin(left[:, middle:]) >= OPEN
    np.testing.assert_allclose(np.nanmean(left[:, :middle]), np.nanmean(whole[:, :middle]), atol=0.01)
    moving = [
        aolab.Scene(
            (
                aolab.Instance(floor(4.0)),
                aolab.Instance(box((-0.5, 0, -0.5), (0.5, 1, 0.5)), moved(np.array((x, 0, 0))), "hero"),
                aolab.Instance(far),
            ),
            camera=scene.camera,
        )
        for x in (-1.5, -1.0)
    ]
    for one in moving:
        low, high = region_of(one, "hero")
        seen = one.instances[1].bounds
        np.testing.assert_allclose(low, seen[0] - np.sqrt(3) / 2)
        np.testing.assert_allclose(high, seen[1] + np.sqrt(3) / 2)
        assert np.nanmin(lab.render(one, "hao", voxel_region="hero", **settings)["visibility"][:, :middle]) < 0.9


def test_a_still_scene_is_voxelised_once_and_a_changed_one_anew(lab, boxes):
    """Other cameras and modules use the same grid; a moved mesh does not."""
    lab.render(boxes, "hao")
    camera = Camera((0, 3, 4), (0, 0.5, 0))
    for again in (lab.render(boxes, "hao", camera=camera), lab.render(boxes, "ssao", occluders="voxels")):
        assert not [name for name in again.timings if "voxels" in name]
    first, *rest = boxes.instances
    other = boxes.replace(instances=(*rest, aolab.Instance(first.mesh, moved(np.array((0, 0.1, 0))))))
    assert {"voxels", "pack voxels"} <= set(lab.render(other, "hao").timings)
    assert "voxels" in lab.render(other, "hao", voxels=128).timings


def test_a_frame_keeps_its_grid_while_others_are_drawn(lab, boxes):
    """Relighting an old frame reads its own grid, not that of the scene that was drawn since."""
    settings = {"occluders": "voxels", "radius": 1.0}
    one = lab.render(boxes, "ssdo", **settings)
    before = one["ambient"].copy()
    lab.render(boxes.replace(instances=boxes.instances[:1]), "ssdo", **settings)
    np.testing.assert_array_equal(lab.relight(one)["ambient"], before)


def test_a_scene_far_from_the_origin_has_the_same_voxels(lab, boxes):
    """Shaders compute around the scene's own origin (`Scene.shader_origin`)."""
    offset = np.array((4e5, 100.0, -3e5))
    far = boxes.replace(
        instances=tuple(aolab.Instance(one.mesh, moved(offset) @ one.world_from_local) for one in boxes.instances),
        camera=Camera(tuple(np.add(boxes.camera.eye, offset)), tuple(np.add(boxes.camera.target, offset)), fov=45),
    )
    settings = {"occluders": "voxels", "radius": 1.0, "scale": 1.0}
    near_one, far_one = (lab.render(one, "ssao", **settings)["visibility"] for one in (boxes, far))
    assert np.nanmean(np.abs(near_one - far_one)) < 2e-3


def test_the_picture_of_the_grid_covers_the_surface_and_little_more(lab, boxes):
    """HAO 2009, Fig. 2: a finer grid is nearer to the silhouettes."""
    camera = Camera((0.5, 0.4, 5), (0, 1.2, 0), fov=45)
    excess = []
    for voxels in (64, 256):
        frame = lab.render(boxes, aolab.VoxelView(voxels=voxels), camera=camera, size=(96, 72))
        drawn = frame["voxel_grid"].min(axis=-1) < 1
        assert drawn[frame.mask].all()
        excess.append((drawn & ~frame.mask).sum())
    assert 0 < excess[1] < 0.5 * excess[0]
    above = frame["voxel_grid"][:3]
    assert (above == 1).all()  # sky


def test_the_picture_of_the_grid_needs_voxels(lab, boxes):
    with pytest.raises(ParameterError, match="occluders = 'depth' is not valid: voxels"):
        lab.render(boxes, aolab.VoxelView, occluders="depth")
