"""Save buffers: every intermediate result by name, as NumPy arrays."""

from pathlib import Path

import numpy as np

import aolab

Path("out").mkdir(exist_ok=True)
frame = aolab.render("cornell", "ssao", size=(320, 240))
frame.save_buffers("out/cornell.npz")

with np.load("out/cornell.npz") as buffers:
    for name in sorted(buffers):
        print(f"{name:16} {buffers[name].shape!s:16} {buffers[name].dtype}")
