"""Hello: render a scene with a method, print a number, save the picture."""

from pathlib import Path

import aolab

Path("out").mkdir(exist_ok=True)
frame = aolab.render("boxes", "ssao", size=(640, 360), radius=0.8)
print(f"mean visibility {frame['visibility'][frame.mask].mean():.3f}, on {frame.info['renderer']}")
frame.save("out/hello.png")
