"""One pixel: the points that SSAO tested for it, over the image and in space. Orange points are blocked."""

from pathlib import Path

import aolab

Path("out").mkdir(exist_ok=True)
frame = aolab.render("colonnade", "ssao", size=(400, 225), radius=1.0)
seen = aolab.microscope(frame, (215, 205))
print(seen)
seen.picture().save("out/pixel.png")
