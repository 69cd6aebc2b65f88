"""SSDO's lights on the screen are an estimate: it converges, it is filtered, and the light itself stays as it is."""

import numpy as np
import pytest
import small_scenes

import aolab
from aolab import Camera, DirectionalLight, Environment, PointLight
from aolab.maths.sampling import influence, ways

SIZE = (96, 72)
SETTINGS = {"radius": 1.0, "light_steps": 2, "bias": 0.005, "thickness": 1.0, "size": SIZE}
pytestmark = pytest.mark.filterwarnings("ignore:.* meshes are not closed:aolab.errors.Notice")


@pytest.fixture(scope="module")
def scene() -> aolab.Scene:
    """A block on a floor, in a sun without a shadow map: the shadow is all that the screen gives."""
    return small_scenes.of(
        small_scenes.floor(4),
        small_scenes.box((-0.5, 0, -0.5), (0.5, 0.6, 0.5)),
        camera=Camera((1.5, 3, 3), (0, 0, 0), fov=40),
        lights=(DirectionalLight((0.8, -1, 0.2), (3.0, 3.0, 3.0), shadow=False),),
        sky=Environment.constant(0.0),
    )


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(np.square(values, dtype=np.float64))))


def test_more_sample_sets_come_closer_to_many(lab, scene):
    """With few steps a point is blocked or not by chance; the mean of K sets errs by 1/√K of one set's error."""
    many = lab.render(scene, "ssdo", filter="none", accumulate=256, seed=1000, **SETTINGS)["direct"]
    error = {
        count: np.mean(
            [
                rms(
                    lab.render(scene, "ssdo", filter="none", accumulate=count, seed=100 * run, **SETTINGS)["direct"]
                    - many
                )
                for run in range(3)
            ]
        )
        for count in (1, 16)
    }
    assert error[1] > 0.01
    assert error[16] < 0.4 * error[1]


def test_another_seed_is_another_sample_set(lab, scene):
    one, other, again = (lab.render(scene, "ssdo", seed=seed, **SETTINGS)["light_share"] for seed in (0, 1, 0))
    assert not np.array_equal(one, other)
    np.testing.assert_array_equal(one, again)


def test_the_filter_smooths_the_share_and_not_the_light(lab, scene):
    """Where nothing blocks, the light is that without samples, to the bit; where something does, noise is less."""
    plain = lab.render(scene, "none", size=SIZE)["direct"]
    frame = lab.render(scene, "ssdo", **SETTINGS)
    open = (frame["light_share"] == 1).all(axis=-1)
    assert 0.5 < open.mean() < 0.99
    np.testing.assert_array_equal(frame["direct"][open], plain[open])
    np.testing.assert_allclose(frame["direct"], plain * frame["light_share"], atol=1e-3)
    converged = lab.render(scene, "ssdo", accumulate=64, **SETTINGS)
    noise = {name: rms((frame[name] - converged[name])[frame.mask]) for name in ("light_share_raw", "light_share")}
    assert noise["light_share"] < 0.6 * noise["light_share_raw"]


def test_the_share_fades_with_the_falloff(lab):
    """A lid over a floor, at 0.8 radii: all of the light is blocked without a falloff, and a part of it with one."""
    lid = small_scenes.box((-3, 0.8, -3), (3, 0.85, 3))
    under = small_scenes.of(
        small_scenes.floor(4), lid, camera=Camera((0, 0.4, 2.5), (0, 0.1, 0), fov=60),
        lights=(DirectionalLight((0, -1, 0), (3.0, 3.0, 3.0), shadow=False),), sky=Environment.constant(0.0),
    )  # fmt: skip
    settings = {"radius": 1.0, "light_steps": 64, "thickness": 10.0, "bias": 0.001, "filter": "none", "accumulate": 8}
    for falloff in (0.0, 1.0):
        frame = lab.render(under, "ssdo", occluders="layers", falloff=falloff, size=(240, 180), **settings)
        position = small_scenes.world_positions(frame, under.camera)
        floor = (np.abs(position[..., 1]) < 1e-3) & (position[..., 2] < 0.5) & (position[..., 2] > -1)
        assert floor.sum() > 100
        lift = 2 * 3.5 * np.tan(np.radians(30)) / 180  # a pixel's width at the far end of the way
        expected = 1 - influence(np.array((0.8 - lift) ** 2), falloff)
        assert frame["light_share"][floor][:, 0].mean() == pytest.approx(expected, abs=0.05)


def test_two_lights_share_by_what_they_give(lab, scene):
    """Where the block hides the red lamp and not the green one, red is gone and green is not."""
    lamps = tuple(PointLight((x, 1.5, 0), color, shadow=False) for x, color in ((-2, (9.0, 0, 0)), (2, (0, 9.0, 0))))
    frame = lab.render(scene.replace(lights=lamps), "ssdo", **{**SETTINGS, "light_steps": 32}, filter="none")
    share = frame["light_share"][frame.mask]
    assert ((share[:, 0] == 0) & (share[:, 1] == 1)).sum() > 20
    assert ((share[:, 0] == 1) & (share[:, 1] == 0)).sum() > 20


def test_a_way_is_as_long_as_the_falloff_has_it():
    """The share of ways longer than d is `influence`, over all sets and many seeds."""
    found = np.concatenate([ways(16, seed, 0.6) for seed in range(400)])
    for d in (0.5, 0.7, 0.9):
        assert (found[:, 0] > d).mean() == pytest.approx(float(influence(np.array(d**2), 0.6)), abs=0.01)
    assert ((found[:, 1] >= 0) & (found[:, 1] < 1)).all()
    assert (ways(16, 3, 0.0)[:, 0] == 1).all()
    one = np.sort(ways(16, 5)[:, 1])
    np.testing.assert_allclose(np.diff(one), 1 / 16, atol=1e-6)  # stratified over the sets
