"""Ambient transfer against the identities of the paper, exact answers, and the rays that compute the same integrals."""

import numpy as np
import pytest
import small_scenes
from small_scenes import box, of, quad, world_positions

import aolab
from aolab import AmbientTransfer, Camera, DirectionalLight, Environment, Frame, Material, ParameterError, Scene
from aolab.modules.measures import MEASURES, Exponential, Measure
from aolab.papers.pixels import view_of
from aolab.truth.hemisphere import frames
from aolab.truth.world import World

CONVERGED = {"directions": 32, "steps": 8, "accumulate": 8, "filter": "none", "bias": 0.0}


def corner(albedo: tuple[float, float, float], floor: tuple[float, float, float] = (0.5, 0.5, 0.5)) -> Scene:
    """A floor in front of a wall; the camera sees both whole near the crease."""
    return of(
        quad((0, 0, 20), (20, 0, 0), (0, 0, -40), Material(floor), "floor"),
        quad((0, 0, 20), (0, 0, -40), (0, 20, 0), Material(albedo), "wall"),
        camera=Camera(eye=(4, 3, 0), target=(0.5, 0.3, 0), fov=60),
    )


def on_the_floor(frame: Frame, scene: Scene, nearest: float, farthest: float) -> np.ndarray:
    """(H, W) bool: pixels of the floor whose distance to the wall is between two lengths."""
    assert scene.camera is not None
    x, y, z = np.moveaxis(world_positions(frame, scene.camera), -1, 0)
    with np.errstate(invalid="ignore"):
        return (np.abs(y) < 1e-3) & (x > nearest) & (x < farthest) & (np.abs(z) < 1)


# --- identities


@pytest.mark.parametrize("measure", MEASURES)
@pytest.mark.parametrize("filter", ["none", "box4", "bilateral"])
def test_white_surroundings_give_one_exactly(lab, measure, filter):
    frame = lab.render(corner((1, 1, 1), (1, 1, 1)), AmbientTransfer, radius=1.0, measure=measure, filter=filter)
    open = frame["obscurance"] > 0
    assert frame["obscurance"][frame.mask].min() < 0.9
    assert (frame["transfer"][frame.mask & open] == 1).all()
    assert (frame["transfer"][frame.mask & ~open] == 0).all(), "0/0 is 0"


@pytest.mark.parametrize("measure", MEASURES)
def test_black_surroundings_give_the_obscurance_exactly(lab, measure):
    frame = lab.render(corner((0, 0, 0), (0, 0, 0)), AmbientTransfer, radius=1.0, measure=measure)
    np.testing.assert_array_equal(frame["transfer"], np.repeat(frame["obscurance"][..., None], 3, axis=2))
    assert frame["indirect"].max() == 0


def test_a_reddish_surface_has_reddish_creases_that_are_lighter_than_obscurance(lab):
    """The albedo of the paper's figure 9."""
    scene = corner((0.6, 0.3, 0.3), (0.6, 0.3, 0.3))
    frame = lab.render(scene, AmbientTransfer, radius=2.0, size=(96, 72))
    crease = on_the_floor(frame, scene, 0.0, 0.3)
    red, green, blue = frame["transfer"][crease].mean(axis=0)
    assert green == pytest.approx(blue)
    assert red > 1.06 * green > 1.06 * 1.06 * frame["obscurance"][crease].mean()


def test_numerator_and_denominator_are_filtered_apart(lab):
    scene = corner((0.8, 0.2, 0.2))
    raw, plain = (lab.render(scene, AmbientTransfer, radius=1.0, filter=filter) for filter in ("box4", "none"))
    np.testing.assert_array_equal(raw["transfer_raw"], plain["transfer"])
    crease = raw.mask & (raw["obscurance"] < 0.8)
    numerator, denominator = raw.channels("transfer_terms")[..., 3:], raw["transfer_terms"][..., :3]
    np.testing.assert_allclose(raw["transfer"][crease], (numerator / denominator)[crease], rtol=1e-6)


def test_the_light_is_that_of_the_transfer(lab):
    """Under a constant sky L: a W L, of which a O L comes straight from the sky."""
    scene = corner((0.6, 0.3, 0.3), (0.6, 0.3, 0.3)).replace(environment=Environment.constant((2.0, 1.0, 0.5)))
    frame = lab.render(scene, AmbientTransfer, radius=1.0)
    sky = np.float32((2.0, 1.0, 0.5))
    np.testing.assert_allclose(frame["ambient"], frame["albedo"] * sky * frame["obscurance"][..., None], atol=2e-3)
    both = frame["ambient"] + frame["indirect"]
    np.testing.assert_allclose(both[frame.mask], (frame["albedo"] * sky * frame["transfer"])[frame.mask], atol=2e-3)
    assert frame["radiance"][frame.mask].std() > 0


def test_without_ambient_light_there_is_none(lab):
    scene = corner((1, 1, 1)).replace(environment=Environment.constant(0.0), lights=(DirectionalLight((-1, -1, 0)),))
    for source in ("albedo", "radiance"):
        frame = lab.render(scene, AmbientTransfer, radius=1.0, albedo_source=source)
        assert np.isfinite(frame["radiance"]).all()
        assert frame["ambient"].max() == frame["indirect"].max() == 0


# --- the source of the colour


def test_without_lamps_the_radiance_is_the_albedo(lab):
    scene = corner((0.6, 0.3, 0.3))
    frames = [lab.render(scene, AmbientTransfer, radius=1.0, albedo_source=source) for source in ("albedo", "radiance")]
    np.testing.assert_allclose(frames[0]["transfer"], frames[1]["transfer"], atol=2e-3)


def test_a_lamp_on_the_wall_lights_the_crease(lab):
    red_lamp = DirectionalLight((-1, 0, 0), (1.5, 0.0, 0.0))
    scene = corner((0.5, 0.5, 0.5)).replace(lights=(red_lamp,))
    albedo, radiance = (
        lab.render(scene, AmbientTransfer, radius=2.0, albedo_source=source) for source in ("albedo", "radiance")
    )
    crease = on_the_floor(albedo, scene, 0.0, 0.3)
    gain = (radiance["transfer"] / albedo["transfer"])[crease].mean(axis=0)
    assert gain[0] > 1.05
    np.testing.assert_allclose(gain[1:], 1, atol=2e-3)
    dark = lab.relight(radiance, lights=())
    np.testing.assert_allclose(dark["transfer"], albedo["transfer"], atol=2e-3)


def test_hidden_surfaces_bring_their_albedo(lab):
    """The back of a slab, which only peeled layers know, is red."""
    scene = of(
        box((-4, -4, -1), (4, 4, 0), Material((0.5, 0.5, 0.5))),
        box((-1, -1, 0.3), (1, 1, 0.5), Material((0.9, 0.0, 0.0))),
        camera=Camera((0.0, 0.0, 6.0), (0, 0, 0)),
    )
    frame = lab.render(
        scene, AmbientTransfer, occluders="layers", radius=0.6, measure="classical", steps=4, directions=16
    )
    beside = frame.mask & (frame["viewNormal"][..., 2] > 0.99) & (frame["viewZ"] < -5.9) & (frame["obscurance"] < 0.9)
    assert beside.sum() > 10
    red, green, _ = frame["transfer"][beside].mean(axis=0)
    assert red > green + 0.01


# --- silhouettes


def test_a_far_foreground_throws_no_halo(lab):
    """`R > z - z* > 0`, section 4.3; near surfaces still count."""
    scene = of(
        box((-20, -20, -1), (20, 20, 0)), box((-0.4, -19, 4), (0.4, 19, 4.2)), camera=Camera((0, 0, 10), (0, 0, 0))
    )
    for measure in MEASURES:
        free, halo = (
            lab.render(scene, AmbientTransfer, radius=1.0, measure=measure, silhouette_elimination=switch)
            for switch in (True, False)
        )
        behind = free["viewZ"] < -9
        assert (free["obscurance"][behind] == 1).all()
        assert halo["obscurance"][behind].min() < 0.95


@pytest.mark.parametrize("orthographic", [False, True])
def test_without_elimination_nothing_in_front_is_too_far(lab, orthographic):
    camera = Camera((0, 0, 10), (0, 0, 0), **({"ortho": 6.0} if orthographic else {}))
    scene = of(box((-20, -20, -1), (20, 20, 0)), box((-0.4, -19, 9), (0.4, 19, 9.2)), camera=camera)
    frame = lab.render(scene, AmbientTransfer, radius=1.0, silhouette_elimination=False, measure="classical")
    behind = frame["viewZ"] < -9
    assert frame["obscurance"][behind].min() < 0.9


# --- exact answers and rays


def wall_obscurance(distance: np.ndarray, measure: Measure) -> np.ndarray:
    """O of a floor at `distance` from an endless wall: the mean of the exact AO over the distances of the samples.

    AO of reach ρ is 1 less the circular segment (arccos c - c √(1 - c²)) / π, c = distance / ρ: see test_ssao.py.
    """
    reach = measure.inverse((np.arange(2000) + 0.5) / 2000)
    c = np.clip(distance[..., None] / np.maximum(reach, 1e-9), 0, 1)
    return 1 - ((np.arccos(c) - c * np.sqrt(1 - c * c)) / np.pi).mean(axis=-1)


@pytest.mark.slow
@pytest.mark.parametrize("measure", [*MEASURES, "own"])
def test_a_floor_in_front_of_a_wall(lab, wall, measure):
    chosen = Smooth() if measure == "own" else MEASURES[measure]()
    settings = {**CONVERGED, "steps": 16, "radius": 1.0, "thickness": 10.0}
    frame = lab.render(wall, AmbientTransfer, size=(96, 72), measure=chosen, **settings)
    near = on_the_floor(frame, wall, 0.1, 1.2)
    x = world_positions(frame, wall.camera)[..., 0][near]
    error = frame["obscurance"][near] - wall_obscurance(x, chosen)
    assert near.sum() > 100
    assert abs(error.mean()) < 0.006
    assert np.sqrt((error**2).mean()) < 0.02


class Smooth(Measure):
    """A measure of one's own, in three lines."""

    name = "smooth"

    def openness(self, distance):
        return distance**2 * (3 - 2 * distance)


def seen_whole(frame: Frame, radius: float, rays: int = 64) -> np.ndarray:
    """(H, W) bool: pixels of which image space sees every surface that rays within the radius meet.

    A point is seen if it lies in the picture, less than 5 % of the radius behind the surface that is shown there.
    """
    assert frame.scene is not None
    view, world = view_of(frame), World(frame.scene)
    width, height = view.size
    view_from_world = view.camera.view_from_world
    normals = frame.world_normal()[frame.mask]
    origins = world_positions(frame, view.camera)[frame.mask] - world.centre + 0.01 * radius * normals
    seen = np.ones(len(origins), bool)
    for way in np.frombuffer(AmbientTransfer(directions=rays).samples(0)["kernel"], np.float32).reshape(-1, 4)[:, :3]:
        directions = np.einsum("k,knc->nc", way, frames(normals)).astype(np.float32)
        hits = world.first_hit(origins.astype(np.float32), directions, radius)
        met = np.flatnonzero(hits.triangle >= 0)
        points = origins[met] + directions[met] * hits.distance[met, None] + world.centre
        there = points @ view_from_world[:3, :3].T + view_from_world[:3, 3]
        at = there[:, :2] / -there[:, 2:] / view.camera.half_extent(view.size)
        column = ((1 + at[:, 0]) / 2 * width).astype(int).clip(0, width - 1)
        row = ((1 - at[:, 1]) / 2 * height).astype(int).clip(0, height - 1)
        in_picture = (np.abs(at) < 1).all(axis=1)
        seen[met] &= in_picture & (there[:, 2] > frame["viewZ"][row, column] - 0.05 * radius)
    whole = np.zeros_like(frame.mask)
    whole[frame.mask] = seen
    return whole


@pytest.mark.slow
@pytest.mark.parametrize("measure", ["classical", "linear", "sqrt", Exponential(sigma=8.0)], ids=str)
def test_the_cornell_box_agrees_with_rays_where_it_is_seen_whole(lab, measure):
    """Equations 5 and 6, converged: RMSE below 3 %."""
    settings = {**CONVERGED, "steps": 16, "radius": 0.8}
    frame = lab.render("cornell", AmbientTransfer, size=(120, 120), measure=measure, **settings)
    truth = aolab.reference(frame.scene, like=frame, rays=128, buffers=("obscurance", "transfer"))
    whole = seen_whole(frame, 0.8)
    assert whole.sum() > 0.6 * frame.mask.sum()
    for name in ("obscurance", "transfer"):
        assert truth[name][whole].min() < 0.8
        error = (frame[name] - truth[name])[whole]
        assert np.sqrt((error**2).mean()) < 0.03, name


# --- errors of the estimate


def test_the_ratio_varies_less_with_shared_samples(lab):
    """Weighted importance sampling: numerator and denominator of the same samples, against those of different ones."""
    scene = corner((0.8, 0.6, 0.4), (0.8, 0.6, 0.4))
    frames = [
        lab.render(scene, AmbientTransfer, radius=1.0, directions=8, filter="none", seed=seed) for seed in range(24)
    ]
    crease = on_the_floor(frames[0], scene, 0.05, 0.8)
    terms = np.array([frame.channels("transfer_terms")[crease] for frame in frames])  # (seeds, pixels, 4)
    shared = terms[..., 3:] / terms[..., :3]
    apart = terms[..., 3:] / np.roll(terms, 1, axis=0)[..., :3]
    np.testing.assert_allclose(shared, np.array([frame["transfer"][crease] for frame in frames]), rtol=1e-5)
    assert shared.var(axis=0).mean() < 0.5 * apart.var(axis=0).mean()


@pytest.mark.parametrize("directions", [1, 4, 8])
def test_interleaving_lowers_the_error(lab, directions):
    """16 rotations and a box filter, against the same samples in every pixel (figure 5)."""
    scene = corner((0.8, 0.6, 0.4))
    settings = {"radius": 1.0, "steps": 1, "size": (96, 72)}
    exact = lab.render(scene, AmbientTransfer, **{**settings, "directions": 64}, accumulate=16, filter="none")
    crease = on_the_floor(exact, scene, 0.05, 0.9)

    def error(seed: int, **changes: object) -> float:
        frame = lab.render(scene, AmbientTransfer, **settings, directions=directions, seed=seed, **changes)
        return float(((frame["obscurance"] - exact["obscurance"])[crease] ** 2).mean())

    interleaved = sum(error(seed) for seed in range(6))
    raw = sum(error(seed, filter="none") for seed in range(6))
    assert interleaved < 0.6 * raw


# --- parameters


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"radius": 0.0}, r"ambient_transfer: radius = 0.0 is not valid: .*> 0"),
        ({"measure": "cubic"}, r"ambient_transfer: measure = 'cubic' is not valid"),
        ({"sigma": 2.0}, r"sigma = 2.0 is a parameter of measure='exponential'; here measure is 'sqrt'"),
        ({"measure": "exponential", "sigma": 0.0}, r"sigma = 0.0 is not valid: float, > 0, ≤ 100"),
        ({"albedo_source": "emission"}, r"albedo_source = 'emission' is not valid: albedo or radiance"),
        ({"falloff": 0.5}, r"ambient_transfer has no parameter 'falloff'"),
    ],
)
def test_wrong_values_are_refused(values, message):
    with pytest.raises(ParameterError, match=message):
        AmbientTransfer(**values)


def test_albedos_outside_0_to_1_are_refused():
    with pytest.raises(aolab.SceneError, match=r"base_color = .* is not three numbers in \[0, 1\]"):
        Material((1.2, 0.5, 0.5))


def test_the_question_has_the_measure():
    """The reference computes obscurance and transfer with the same measure."""
    question = AmbientTransfer(radius=0.5, measure="exponential", sigma=2.0).question()
    assert (question.measure, question.falloff, question.sigma, question.radius) == ("exponential",) * 2 + (2.0, 0.5)
    own = AmbientTransfer(radius=0.5, measure=Smooth()).question()
    assert own.measure[64] == pytest.approx(0.5)
    assert own.measure == own.falloff


def test_the_reference_takes_a_measure_of_ones_own(lab):
    scene = corner((0.6, 0.3, 0.3))
    frame = lab.render(scene, AmbientTransfer(radius=1.0, measure=Smooth()))
    like = aolab.reference(scene, like=frame, rays=8, buffers="obscurance")
    by_name = aolab.reference(scene, radius=1.0, falloff=1.0, size=frame.size, rays=8, buffers="visibility")
    np.testing.assert_allclose(like["obscurance"][frame.mask], by_name["visibility"][frame.mask], atol=1e-3)


def test_every_parameter_of_a_measure_has_an_effect(lab):
    scene = corner((0.6, 0.3, 0.3))
    frames = [lab.render(scene, AmbientTransfer, radius=1.0, measure="exponential", sigma=sigma) for sigma in (1, 3)]
    assert frames[0]["obscurance"].mean() < frames[1]["obscurance"].mean() - 0.01


def test_an_open_plane_stays_exactly_open_with_every_measure(lab):
    for camera in (Camera((0, 3, 6), (0, 0, 0)), Camera((0, 0.05, 6), (0, 0, 0)), Camera((3, 80, 2), (0, 0, 1))):
        for measure in MEASURES:
            scene = small_scenes.plane(camera)
            frame = lab.render(scene, AmbientTransfer, radius=2.0, measure=measure, filter="none", bias=0.0)
            assert (frame["obscurance"][frame.mask] == 1).all(), measure
            assert (frame["transfer"][frame.mask] == 1).all()
