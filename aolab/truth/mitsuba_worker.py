"""Renders the scene that `aolab.truth.mitsuba` wrote into a folder: `python -P mitsuba_worker.py FOLDER`.

A program of its own, so that whatever Mitsuba does to its process is done to this one. It reads scene.json and
arrays.npz, where lengths are already Mitsuba's, and writes images.npz: one (H, W, 3) float32 an image, linear.
"""

import json
import sys
from pathlib import Path
from typing import Any

import mitsuba as mi  # the only module of ours that imports it
import numpy as np

Arrays = dict[str, np.ndarray]


def main(folder: Path) -> None:
    mi.set_variant("scalar_rgb")  # its LLVM variants can abort the process with the LLVM of Debian 12
    scene = json.loads((folder / "scene.json").read_text())
    with np.load(folder / "arrays.npz") as file:
        arrays = {name: file[name] for name in file.files}
    materials = [_material(description, arrays) for description in scene["materials"]]
    shapes = {f"shape{i}": _shape(f"shape{i}", arrays, materials) for i in range(scene["shapes"])}
    emitters = [_emitter(description, arrays) for description in scene["emitters"]]
    sensor = _sensor(**scene["camera"], **scene["film"])
    images = {}
    for seed, (name, image) in enumerate(scene["images"].items(), start=scene["seed"]):
        lit = {f"emitter{i}": emitters[i] for i in image["emitters"]}
        world = mi.load_dict({"type": "scene", **shapes, **lit, "sensor": sensor})
        integrator = mi.load_dict(image["integrator"])
        rendered = mi.render(world, integrator=integrator, seed=seed % 2**32, spp=scene["samples"])
        images[name] = np.array(rendered, np.float32)[..., :3]
    np.savez(folder / "images.npz", **images)


def _sensor(
    eye: list[float], target: list[float], up: list[float], fov: float, near: float, far: float, width: int, height: int
) -> Any:
    return mi.load_dict({
        "type": "perspective",
        "fov": fov,
        "fov_axis": "y",
        "near_clip": near,
        "far_clip": far,
        "to_world": mi.ScalarTransform4f().look_at(origin=eye, target=target, up=up),
        "film": {
            "type": "hdrfilm",
            "width": width,
            "height": height,
            "pixel_format": "rgb",
            "component_format": "float32",
            "rfilter": {"type": "box"},  # a pixel is the mean over its own area, nothing of its neighbours
        },
        "sampler": {"type": "independent"},
    })  # fmt: skip


def _shape(name: str, arrays: Arrays, materials: list[Any]) -> Any:
    vertices, faces = arrays[f"{name}.vertices"], arrays[f"{name}.faces"]
    properties = mi.Properties()
    properties["bsdf"] = materials[int(arrays[f"{name}.material"])]
    uv, colors = arrays.get(f"{name}.uv"), arrays.get(f"{name}.colors")
    mesh = mi.Mesh(
        name,
        len(vertices),
        len(faces),
        props=properties,
        has_vertex_normals=True,
        has_vertex_texcoords=uv is not None,
    )
    if colors is not None:
        mesh.add_attribute("vertex_color", 3, colors.ravel())
    parameters = mi.traverse(mesh)
    parameters["vertex_positions"] = vertices.ravel()
    parameters["faces"] = faces.ravel()
    if uv is not None:
        parameters["vertex_texcoords"] = uv.ravel()
    parameters["vertex_normals"] = arrays[f"{name}.normals"].ravel()
    parameters.update()
    return mesh


def _material(description: dict[str, Any], arrays: Arrays) -> Any:
    reflectance = description["reflectance"]
    if isinstance(reflectance, str):  # an image by name, or the vertices' colours
        vertex_color = {"type": "mesh_attribute", "name": "vertex_color"}
        reflectance = vertex_color if reflectance == "vertex_color" else _bitmap(arrays[reflectance], "bilinear")
    else:
        reflectance = {"type": "rgb", "value": reflectance}
    bsdf = {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": reflectance}}
    if description["opacity"]:
        bsdf = {"type": "mask", "opacity": _bitmap(arrays[description["opacity"]], "nearest"), "bsdf": bsdf}
    return mi.load_dict(bsdf)


def _emitter(description: dict[str, Any], arrays: Arrays) -> Any:
    kind = description["type"]
    emitter = {name: value for name, value in description.items() if name not in ("image", "target")}
    for name in ("radiance", "irradiance", "intensity"):
        if name in emitter:
            emitter[name] = {"type": "rgb", "value": emitter[name]}
    if kind == "envmap":
        emitter["bitmap"] = mi.Bitmap(arrays[description["image"]])
        emitter["to_world"] = mi.ScalarTransform4f().rotate([0, 1, 0], 180)  # its centre column looks down +z
    if kind == "spot":
        position, target = (np.asarray(emitter.pop("position")), np.asarray(description["target"]))
        up = np.eye(3)[np.abs(target - position).argmin()]
        emitter["to_world"] = mi.ScalarTransform4f().look_at(
            origin=position.tolist(), target=target.tolist(), up=up.tolist()
        )
        emitter["texture"] = _bitmap(arrays[description["image"]], "bilinear", "clamp")
    return mi.load_dict(emitter)


def _bitmap(image: np.ndarray, filter_type: str, wrap_mode: str = "repeat") -> dict[str, Any]:
    """A linear texture; `image` (H, W, 1 or 3) float32, top row first."""
    return {
        "type": "bitmap",
        "bitmap": mi.Bitmap(np.ascontiguousarray(image)),
        "raw": True,
        "filter_type": filter_type,
        "wrap_mode": wrap_mode,
    }


if __name__ == "__main__":
    main(Path(sys.argv[1]))
