"""Reload while editing: change a shader of glsl/ in your editor, and the next frame uses it.

If a shader does not compile, its error is printed and the last good program stays in use. Stop with Ctrl-C.
Usage: python examples/06_reload.py [frames]
"""

import sys
import time
from pathlib import Path

import aolab

Path("out").mkdir(exist_ok=True)
lab = aolab.Lab(size=(640, 360), watch=True)
scene = aolab.load("boxes")
frames = int(sys.argv[1]) if len(sys.argv) > 1 else 10_000
for number in range(frames):
    try:
        frame = lab.render(scene, "ssao")
        frame.save("out/reload.png")  # an image viewer that reloads changed files shows each frame
        print(f"\rframe {number}: {frame.frame_ms:.0f} ms", end="")
    except aolab.ShaderError as error:
        print(f"\n{error}")
        time.sleep(1)
    if number + 1 < frames:
        time.sleep(0.2)
print()
