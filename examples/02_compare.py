"""Compare: three values of a parameter on one contact sheet."""

from pathlib import Path

import aolab
from aolab.pictures.sheet import gray

Path("out").mkdir(exist_ok=True)
lab = aolab.Lab(size=(480, 270))
scene = aolab.load("colonnade")
pictures = []
for radius in (0.2, 0.6, 1.8):
    frame = lab.render(scene, aolab.SSAO(radius=radius, directions=32, filter="bilateral"))
    pictures.append((f"radius {radius}: lit", frame.image))
    pictures.append((f"radius {radius}: visibility", gray(frame["visibility"])))
aolab.contact_sheet(pictures).save("out/compare.png")
