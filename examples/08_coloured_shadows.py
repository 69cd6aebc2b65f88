"""Coloured shadows: boxes between a pink and a turquoise light, with SSAO, SSDO and S3HO."""

from pathlib import Path

import aolab

Path("out").mkdir(exist_ok=True)
lab = aolab.Lab(size=(320, 240))
boxes = aolab.load("boxes").replace(lights=())  # the two soft lights of the environment remain
frames = {name: lab.render(boxes, name, radius=1.5) for name in ("ssao", "ssdo", "s3ho")}
pictures = [(name, aolab.shown(2 * frame["ambient"])) for name, frame in frames.items()]
aolab.contact_sheet(pictures, columns=3).save("out/coloured_shadows.png")
