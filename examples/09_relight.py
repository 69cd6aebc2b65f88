"""Relight: the light turns around a scene. S3HO tests its directions once; each picture costs the lighting only."""

from pathlib import Path

from PIL import Image

import aolab

FRAMES = 24

Path("out").mkdir(exist_ok=True)
lab = aolab.Lab(size=(320, 240))
boxes = aolab.load("boxes").replace(lights=())
light = boxes.environment
assert light is not None, "the scene has an environment"
frame = lit = lab.render(boxes, "s3ho", radius=1.5)
images = []
for i in range(FRAMES):
    lit = lab.relight(frame, environment=light.rotated(360 * i / FRAMES), exposure=2.0)
    images.append(Image.fromarray(lit.image))
images[0].save("out/relight.gif", save_all=True, append_images=images[1:], duration=120, loop=0)
print("passes of a picture:", ", ".join(lit.timings))
