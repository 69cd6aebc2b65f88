"""Depth of a real model against pyrender's: another rasteriser's opinion of cameras, transforms and triangles.

pyrender runs in a process of its own: its `OffscreenRenderer.delete()` ends EGL for the whole process.
"""

import importlib.util

import numpy as np
import pytest

import aolab
from aolab import Camera

SIZE = 160, 120
PYRENDER = """
import os
os.environ["PYOPENGL_PLATFORM"] = "egl"
import warnings
import numpy as np
with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    import pyrender, trimesh

model = trimesh.load_scene({model!r}, process=False)
scene = pyrender.Scene.from_trimesh_scene(model)
camera = pyrender.PerspectiveCamera(yfov=np.radians({fov}), aspectRatio={width} / {height}, znear={near}, zfar={far})
scene.add(camera, pose=np.array({pose}))
depth = pyrender.OffscreenRenderer({width}, {height}).render(scene, flags=pyrender.RenderFlags.DEPTH_ONLY)
np.save("depth.npy", depth[1] if isinstance(depth, tuple) else depth)
"""


@pytest.mark.parametrize("name", ["bunny.ply", "CesiumMilkTruck.glb"])
def test_depth_agrees_with_pyrenders(lab, models, python, tmp_path, name):
    if importlib.util.find_spec("pyrender") is None:
        pytest.skip("pyrender is not installed: pip install scikit-robot-pyrender")
    scene = aolab.load(models / name)
    framing = Camera.framing(scene.bounds, direction=(0.6, 0.4, 1.0))
    camera = Camera(framing.eye, framing.target, fov=35, near=0.2 * scene.radius, far=8 * scene.radius)
    pose = np.linalg.inv(camera.view_from_world).tolist()
    done = python(
        PYRENDER.format(
            model=str(models / name), fov=camera.fov, width=SIZE[0], height=SIZE[1], near=camera.near, far=camera.far, pose=pose
        )
    )
    assert done.returncode == 0, done.stderr
    theirs = np.load(tmp_path / "depth.npy")

    ours = -lab.render(scene, "none", camera=camera, size=SIZE)["viewZ"]
    covered = np.isfinite(ours)
    assert covered.mean() > 0.1
    assert (covered != (theirs > 0)).mean() < 0.002  # pixels on the silhouette, where the roundings differ
    both = covered & (theirs > 0)
    error = np.abs(ours - theirs)[both] / scene.radius
    assert np.median(error) < 1e-5
    assert (error > 1e-3).mean() < 0.002  # pixels between two surfaces, one before the other
