"""The demo: one picture of what the lab is about, close-ups under coloured light, and every module with its times."""

import sys
from pathlib import Path

import numpy as np
from matplotlib import colormaps
from PIL import Image

import aolab
from aolab.modules import MODULES

SIZE, SMALL = (640, 360), (320, 180)
NEAR = slice(180, 330), slice(20, 340)  # rows and columns of the close-up


def city(lab: aolab.Lab) -> Image.Image:
    """Without occlusion, with it, the truth, and the signed difference of the last two."""
    scene = aolab.load("skyscrapers")
    plain = lab.render(scene, "none")
    frame = lab.render(scene, "ssdo", radius=3.0, bounces=1)
    truth = aolab.reference(scene, like=frame, rays=16, buffers="image")
    difference = (frame.image.astype(float) - truth.image).mean(axis=2) / 255
    red_blue = (255 * colormaps["RdBu_r"](0.5 + difference)[..., :3]).astype(np.uint8)
    pictures = [
        ("without ambient occlusion", plain.image),
        ("with SSDO: ambient light where the sky is open, and one bounce", frame.image),
        ("the truth, by rays", truth.image),
        ("SSDO less the truth: red is too bright, blue is too dark", red_blue),
    ]
    return aolab.contact_sheet(pictures)


def coloured_light(lab: aolab.Lab) -> Image.Image:
    """The floor beside a box, under a pink light on its left and a turquoise light on its right."""
    scene = aolab.load("boxes").replace(lights=())
    frames = {name.upper(): lab.render(scene, name, radius=1.5) for name in ("ssao", "ssdo", "s3ho")}
    frames["the truth, by rays"] = aolab.reference(scene, like=frames["SSDO"], rays=64, buffers="ambient")
    return aolab.contact_sheet(
        [(name, aolab.shown(2 * frame["ambient"])[NEAR]) for name, frame in frames.items()],
        columns=4,
        title="Between a pink and a turquoise light: SSAO darkens to grey, SSDO and S3HO keep the colour that arrives",
    )


def modules(lab: aolab.Lab) -> Image.Image:
    """The atrium with every module; prints the time of each pass."""
    scene, renderer = aolab.load("atrium"), ""
    pictures = []
    for name in MODULES:
        lab.render(scene, name, size=SMALL).complete()  # the first frame compiles and uploads, the second is timed
        frame = lab.render(scene, name, size=SMALL).complete()
        renderer = frame.info["renderer"]
        print(f"{name}: {frame.frame_ms:.0f} ms on {renderer}")
        for step, milliseconds in frame.timings.items():
            print(f"  {step:20} {milliseconds:7.1f} ms")
        pictures.append((f"{name}: {frame.frame_ms:.0f} ms", frame.image))
    return aolab.contact_sheet(pictures, columns=4, title=f"Every module, on {renderer}")


def below_each_other(sheets: list[Image.Image]) -> Image.Image:
    whole = Image.new("RGB", (max(one.width for one in sheets), sum(one.height for one in sheets)), "white")
    for number, one in enumerate(sheets):
        whole.paste(one, (0, sum(above.height for above in sheets[:number])))
    return whole


if __name__ == "__main__":
    output = Path(sys.argv[1] if len(sys.argv) > 1 else "out/demo.png")
    output.parent.mkdir(parents=True, exist_ok=True)
    lab = aolab.Lab(SIZE)
    below_each_other([city(lab), coloured_light(lab), modules(lab)]).save(output)
    print(output.resolve())
