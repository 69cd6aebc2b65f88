"""The demo: the atrium with every module, lit and as visibility, on one contact sheet; and the time of each pass."""

import sys
from pathlib import Path

import aolab
from aolab.modules import MODULES
from aolab.pictures.sheet import gray

SIZE = (640, 360)

output = Path(sys.argv[1] if len(sys.argv) > 1 else "out/demo.png")
output.parent.mkdir(parents=True, exist_ok=True)

lab = aolab.Lab(SIZE)
scene = aolab.load("atrium")
pictures = []
for name in MODULES:
    lab.render(scene, name).complete()  # the first frame compiles and uploads, the second is timed
    frame = lab.render(scene, name).complete()
    print(f"{name}: {frame.frame_ms:.0f} ms on {frame.info['renderer']}")
    for step, milliseconds in frame.timings.items():
        print(f"  {step:20} {milliseconds:7.1f} ms")
    pictures.append((f"{name}: lit", frame.image))
    pictures.append((f"{name}: visibility", gray(frame["visibility"])))

aolab.contact_sheet(pictures).save(output)
print(output.resolve())
