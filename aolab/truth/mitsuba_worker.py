"""Renders the description that `mitsuba_scene.describe` made: `python -P mitsuba_worker.py FOLDER`.

A program of its own, so that a crash of Mitsuba ends this process alone. It reads scene.json and arrays.npz,
where lengths are already Mitsuba's, and writes images.npz: (H, W, 3) float32 by name, linear, top row first.
"""

import json
import sys
from pathlib import Path
from typing import Any

import mitsuba as mi
import numpy as np

Arrays = dict[str, np.ndarray]
VERTEX_COLOR = "vertex_color"
SURFACES = -1  # the emitter of an image: the emission of all surfaces


def main(folder: Path) -> None:
    mi.set_variant("scalar_rgb")  # its LLVM variants can abort the process with the LLVM of Debian 12
    scene = json.loads((folder / "scene.json").read_text())
    with np.load(folder / "arrays.npz") as file:
        arrays = {name: file[name] for name in file.files}
    dark, glowing = (
        {name: _shape(name, material, arrays, glows) for name, material in scene["shapes"].items()}
        for glows in (False, True)
    )
    emitters = [_emitter(description, arrays) for description in scene["emitters"]]
    sensor = _sensor(scene["camera"], *scene["size"])
    images = {}
    for seed, (name, image) in enumerate(scene["images"].items(), start=scene["seed"]):
        of_surfaces = image["emitter"] == SURFACES
        content = glowing if of_surfaces else {**dark, "emitter": emitters[image["emitter"]]}
        world = mi.load_dict({"type": "scene", **content})
        integrator = mi.load_dict({
            "type": scene["integrator"],
            "max_depth": image["max_depth"],
            "hide_emitters": not (of_surfaces or image["background"]),
        })  # fmt: skip
        rendered = mi.render(world, sensor=sensor, integrator=integrator, seed=seed % 2**32, spp=scene["samples"])
        images[name] = np.array(rendered, np.float32)
    np.savez(folder / "images.npz", **images)


def _sensor(camera: dict[str, Any], width: int, height: int) -> Any:
    pose = {name: camera.pop(name) for name in ("origin", "target", "up")}
    film = {
        "type": "hdrfilm",
        "width": width,
        "height": height,
        "pixel_format": "rgb",
        "component_format": "float32",
        "rfilter": {"type": "box"},  # a pixel is the mean over its own area alone
    }
    to_world = mi.ScalarTransform4f().look_at(**pose)
    if "half_width" in camera:  # parallel rays: the picture is two units wide before this transform
        half = camera.pop("half_width")
        lens = {"type": "orthographic", "to_world": to_world @ mi.ScalarTransform4f().scale((half, half, 1))}
    else:
        lens = {"type": "perspective", "to_world": to_world, "fov_axis": "y"}
    # measured on `boxes` at 256 samples: a fifth of the noise of independent samples, in 1.8 times the time
    return mi.load_dict({**lens, **camera, "film": film, "sampler": {"type": "multijitter"}})


def _shape(name: str, material: dict[str, Any], arrays: Arrays, glows: bool) -> Any:
    vertices, faces, normals = (arrays[f"{name}.{part}"] for part in ("vertices", "faces", "normals"))
    uv, colors = arrays.get(f"{name}.uv"), arrays.get(f"{name}.colors")
    properties = mi.Properties()
    properties["bsdf"] = _bsdf(material, arrays)
    radiance = arrays.get(f"{name}.radiance")
    if glows and radiance is not None:
        even = radiance.shape[:2] == (1, 1)
        value = {"type": "rgb", "value": radiance[0, 0].tolist()} if even else _bitmap(radiance, "bilinear", "repeat")
        properties["emitter"] = mi.load_dict({"type": "area", "radiance": value})
    mesh = mi.Mesh(name, len(vertices), len(faces), properties, True, uv is not None)
    parameters = mi.traverse(mesh)
    parameters["vertex_positions"] = vertices.ravel()
    parameters["faces"] = faces.ravel()
    if uv is not None:
        parameters["vertex_texcoords"] = uv.ravel()
    parameters.update()
    parameters["vertex_normals"] = normals.ravel()  # by themselves: older Mitsubas make their own with new positions
    parameters.update()
    if colors is not None:
        mesh.add_attribute(VERTEX_COLOR, 3, colors.ravel().tolist())
    return mesh


def _bsdf(material: dict[str, Any], arrays: Arrays) -> Any:
    reflectance = material["reflectance"]
    if reflectance == VERTEX_COLOR:
        reflectance = {"type": "mesh_attribute", "name": VERTEX_COLOR}
    elif isinstance(reflectance, str):
        reflectance = _bitmap(arrays[reflectance], material["filter"], material["wrap"])
    else:
        reflectance = {"type": "rgb", "value": reflectance}
    bsdf = {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": reflectance}}
    if material["opacity"] is not None:
        bsdf = {
            "type": "mask",
            "opacity": _bitmap(arrays[material["opacity"]], material["holes"], material["wrap"]),
            "bsdf": bsdf,
        }
    return mi.load_dict(bsdf)


def _emitter(description: dict[str, Any], arrays: Arrays) -> Any:
    emitter = dict(description)
    for name in ("radiance", "irradiance", "intensity"):
        if name in emitter:
            emitter[name] = {"type": "rgb", "value": emitter[name]}
    if emitter["type"] == "envmap":
        emitter["bitmap"] = mi.Bitmap(arrays[emitter.pop("image")])
        emitter["to_world"] = mi.ScalarTransform4f().rotate([0, 1, 0], 180)  # Mitsuba's centre column looks down +z
    if emitter["type"] == "spot":
        origin, direction = np.array(emitter.pop("origin")), np.array(emitter.pop("direction"))
        up = np.eye(3)[np.abs(direction).argmin()]  # any: the cone is round
        emitter["to_world"] = mi.ScalarTransform4f().look_at(
            origin=origin.tolist(), target=(origin + direction).tolist(), up=up.tolist()
        )
        emitter["texture"] = _bitmap(arrays[emitter["texture"]], "bilinear", "clamp")
    return mi.load_dict(emitter)


def _bitmap(image: np.ndarray, filter_type: str, wrap_mode: str) -> dict[str, Any]:
    """`image` (H, W, 1 or 3) float32, linear."""
    bitmap = mi.Bitmap(np.ascontiguousarray(image))
    return {"type": "bitmap", "bitmap": bitmap, "raw": True, "filter_type": filter_type, "wrap_mode": wrap_mode}


if __name__ == "__main__":
    main(Path(sys.argv[1]))
