"""Error: a method less the truth, as a picture and as numbers, by region of the image."""

from pathlib import Path

import aolab

Path("out").mkdir(exist_ok=True)
frame = aolab.render("skyscrapers", "ssao", size=(320, 180), radius=3.0)
truth = aolab.reference("skyscrapers", like=frame, rays=64, buffers="visibility")
comparison = aolab.compare(frame, truth, flip=False)
print(comparison)
comparison.picture("visibility").save("out/error.png")
