"""Depth of a real model against pyrender's: another rasteriser's opinion of cameras, transforms and triangles.

pyrender runs in a process of its own: its `OffscreenRenderer.delete()` ends EGL for the whole process.
"""

import importlib.util

import numpy as np
import pytest

import aolab
from aolab import Camera

pytestmark = pytest.mark.slow

SIZE = 160, 120
FINER = (
    9  # pyrender gives one of four subsamples, up to 3/8 pixel off; of 9×9 pixels, the middle one is nearly the centre
)
PYRENDER = """
import os
os.environ["PYOPENGL_PLATFORM"] = "egl"
for limit in ("MESA_GL_VERSION_OVERRIDE", "MESA_GLSL_VERSION_OVERRIDE"):
    os.environ.pop(limit, None)  # pyrender needs OpenGL 4.1; the limit is for our own context
import warnings
import numpy as np
with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    import pyrender, trimesh

model = trimesh.load_scene({model!r}, process=False)
scene = pyrender.Scene.from_trimesh_scene(model)
camera = pyrender.PerspectiveCamera(np.radians({fov}), {near}, {far}, aspectRatio={width} / {height})
scene.add(camera, pose=np.array({pose}))
renderer = pyrender.OffscreenRenderer({width} * {finer}, {height} * {finer})
depth = renderer.render(scene, flags=pyrender.RenderFlags.DEPTH_ONLY)
depth = depth[1] if isinstance(depth, tuple) else depth
np.save("depth.npy", depth[{finer} // 2 :: {finer}, {finer} // 2 :: {finer}])
"""


@pytest.mark.parametrize("name", ["bunny.ply", "CesiumMilkTruck.glb"])
def test_depth_agrees_with_pyrenders(lab, models, python, tmp_path, name):
    if importlib.util.find_spec("pyrender") is None:
        pytest.skip("pyrender is not installed: pip install scikit-robot-pyrender")
    scene = aolab.load(models / name)
    framing = Camera.framing(scene.bounds, direction=(0.6, 0.4, 1.0))
    camera = Camera(framing.eye, framing.target, fov=35, near=0.2 * scene.radius, far=8 * scene.radius)
    pose = np.linalg.inv(camera.view_from_world).tolist()
    settings = {"model": str(models / name), "pose": pose, "finer": FINER, "width": SIZE[0], "height": SIZE[1]}
    done = python(PYRENDER.format(**settings, fov=camera.fov, near=camera.near, far=camera.far))
    assert done.returncode == 0, done.stderr
    theirs = np.load(tmp_path / "depth.npy")

    ours = -lab.render(scene, "none", camera=camera, size=SIZE)["viewZ"]
    covered = np.isfinite(ours)
    assert covered.mean() > 0.1
    assert (covered != (theirs > 0)).mean() < 0.002  # some pixels of the silhouette
    both = covered & (theirs > 0)
    error = np.abs(ours - theirs)[both] / scene.radius
    assert np.median(error) < 1e-3  # slopes, over the 1/24 pixel that is left
    assert (error > 1e-2).mean() < 0.005  # a pixel is 1e-2 wide: only where one surface is before another
