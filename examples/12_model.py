"""A model file: `knot.glb`, which comes with aolab, under a sky with a sun."""

from pathlib import Path

import aolab

Path("out").mkdir(exist_ok=True)
sky = aolab.Environment.sky(sun_direction=(0.3, 1.0, 0.4))
scene = aolab.load("knot.glb").replace(environment=sky)
frame = aolab.render(scene, aolab.SSDO(radius=0.6, bounces=1, directions=32), size=(480, 360), exposure=0.7)
frame.save("out/model.png")
