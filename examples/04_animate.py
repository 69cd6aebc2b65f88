"""Animate: time is a parameter of the scene. The lab keeps meshes and programs from frame to frame."""

from pathlib import Path

from PIL import Image

import aolab

LOOP, FRAMES = 4.0, 24  # seconds, pictures

Path("out").mkdir(exist_ok=True)
lab = aolab.Lab(size=(320, 180))
frames = [lab.render(aolab.load("toasters", time=LOOP * i / FRAMES), "ssao") for i in range(FRAMES)]
images = [Image.fromarray(frame.image) for frame in frames]
images[0].save("out/toasters.gif", save_all=True, append_images=images[1:], duration=int(1000 * LOOP / FRAMES), loop=0)
print(f"{FRAMES} frames, {sum(frame.frame_ms for frame in frames) / FRAMES:.0f} ms each: out/toasters.gif")
