"""Damaged files of 18 kinds, by seed. Run as a program, `fuzzed.py KIND FIRST LAST`, it loads them and prints faults.

A fault is an exception that is not aolab's, an error in Python's words, or one that no reader foresaw.
"""

import io
import json
import random
import re
import struct
import sys
import tempfile
import warnings
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

# words of Python programmers, and the last resort of `loading.files`
PYTHON = re.compile(
    r"Traceback|\w+Error\b|\w+Exception\b|object at 0x|NoneType|ndarray|numpy|pydantic|<class|not subscriptable|"
    r"could not convert|invalid literal|unpack|out of range for|out of bounds|broadcast|dtype|charset|codec can't|"
    r"unexpected keyword|positional argument|has no attribute|BytesIO|did not foresee"
)
NUMBERS = [b"0", b"-1", b"1e400", b"nan", b"99999999999999999999", b"2147483648", b"-7", b"0.5", b"x", b""]
VALUES: list[Any] = [None, -1, 0, 1, 3, 2**31, 2**70, 1e308, 0.5, "", "x", "../x", [], {}, [[]], True, "a" * 5000]


# --- whole files


def gltf() -> tuple[dict[str, Any], bytes]:
    """A file with all that is read: indices, a texture, a skin, morph targets, an animation, lights, cameras."""
    data = bytearray()
    header: dict[str, Any] = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0, 2, 3, 4]}],
        "bufferViews": [],
        "accessors": [],
    }

    def view(content: bytes) -> int:
        header["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": len(content)})
        data.extend(content + b"\0" * (-len(content) % 4))
        return len(header["bufferViews"]) - 1

    def accessor(values: Any, kind: str, component: int = 5126, **more: Any) -> int:
        dtype = {5121: "<u1", 5123: "<u2", 5126: "<f4"}[component]
        array = np.asarray(values, dtype)
        place = view(array.tobytes())
        header["accessors"].append(
            {"bufferView": place, "componentType": component, "count": len(array), "type": kind, **more}
        )
        return len(header["accessors"]) - 1

    stream = io.BytesIO()
    Image.new("RGBA", (4, 4), (9, 200, 30, 90)).save(stream, "PNG")
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0.5)]
    attributes = {
        "POSITION": accessor(corners, "VEC3"),
        "NORMAL": accessor([(0, 0, 1)] * 4, "VEC3"),
        "TEXCOORD_0": accessor([(0, 0), (1, 0), (0, 1), (1, 1)], "VEC2"),
        "COLOR_0": accessor([(255, 0, 0, 255)] * 4, "VEC4", 5121, normalized=True),
        "JOINTS_0": accessor([(0, 1, 0, 0)] * 4, "VEC4", 5121),
        "WEIGHTS_0": accessor([(0.5, 0.5, 0, 0)] * 4, "VEC4"),
    }
    places, values = view(np.array([1], np.uint16).tobytes()), view(np.ones(3, np.float32).tobytes())
    sparse = {
        "count": 1,
        "indices": {"bufferView": places, "componentType": 5123},
        "values": {"bufferView": values},
    }
    target = accessor([(0, 0, 0.1)] * 4, "VEC3", sparse=sparse)
    primitive = {
        "attributes": attributes,
        "indices": accessor([0, 1, 2, 1, 3, 2], "SCALAR", 5123),
        "material": 0,
        "mode": 4,
        "targets": [{"POSITION": target}],
    }
    strip = {"attributes": {"POSITION": attributes["POSITION"]}, "mode": 5, "material": 1}
    header["meshes"] = [{"primitives": [primitive], "weights": [0.5]}, {"name": "strip", "primitives": [strip]}]
    header["skins"] = [{"joints": [2, 3], "inverseBindMatrices": accessor([np.eye(4)] * 2, "MAT4")}]
    times = accessor([0, 1, 2], "SCALAR")
    header["animations"] = [{
        "channels": [{"sampler": 0, "target": {"node": 2, "path": "rotation"}},
                     {"sampler": 1, "target": {"node": 3, "path": "translation"}},
                     {"sampler": 2, "target": {"node": 0, "path": "weights"}}],
        "samplers": [{"input": times, "output": accessor([(0, 0, 0, 1)] * 3, "VEC4")},
                     {"input": times, "output": accessor([(0, 0, 0)] * 9, "VEC3"), "interpolation": "CUBICSPLINE"},
                     {"input": times, "output": accessor([0, 0.5, 1], "SCALAR")}],
    }]  # fmt: skip
    instancing = {"attributes": {"TRANSLATION": accessor([(0, 0, 0), (3, 0, 0)], "VEC3")}}
    header["nodes"] = [
        {"mesh": 0, "skin": 0, "weights": [0.25]},
        {"mesh": 1, "matrix": np.eye(4).reshape(-1).tolist()},
        {"translation": [0, 1, 0], "children": [1], "rotation": [0, 0, 0, 1], "scale": [1, 1, 1]},
        {"camera": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}},
        {"mesh": 1, "extensions": {"EXT_mesh_gpu_instancing": instancing}},
    ]
    header["cameras"] = [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1, "zfar": 10}}]
    header["materials"] = [
        {"alphaMode": "MASK", "alphaCutoff": 0.4, "pbrMetallicRoughness": {
            "baseColorFactor": [1, 0.5, 0.2, 1],
            "baseColorTexture": {"index": 0, "texCoord": 0, "extensions": {"KHR_texture_transform": {
                "offset": [0.1, 0.2], "rotation": 1, "scale": [2, 2]}}}}},
        {"emissiveFactor": [1, 1, 1], "doubleSided": True,
         "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 5}}},
    ]  # fmt: skip
    header["textures"] = [{"source": 0, "sampler": 0}]
    header["samplers"] = [{"wrapS": 33071, "wrapT": 33648, "magFilter": 9728, "minFilter": 9987}]
    header["images"] = [{"bufferView": view(stream.getvalue()), "mimeType": "image/png"}]
    header["extensionsUsed"] = ["KHR_lights_punctual", "KHR_texture_transform", "EXT_mesh_gpu_instancing",
                                "KHR_materials_emissive_strength"]  # fmt: skip
    spot = {"type": "spot", "intensity": 5, "color": [1, 1, 1], "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.5}}
    header["extensions"] = {"KHR_lights_punctual": {"lights": [spot]}}
    header["buffers"] = [{"byteLength": len(data)}]
    return header, bytes(data)


def glb(header: Any, data: bytes) -> bytes:
    text = json.dumps(header).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


OBJ = b"mtllib m.mtl\no thing\n" + b"".join(b"v %d %d 0 1 0.5 0\n" % (i % 3, i // 3) for i in range(9))
OBJ += (
    b"vt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\nusemtl a\nf 1/1/1 2/2/1 5/3/1 4/1/1\nusemtl b\nf -3//1 -2//1 -1//1\nf 1 2 3\n"
)
MTL = b"newmtl a\nKd 0.5 0.5 0.5\nmap_Kd -s 2 2 2 -clamp on t.png\nd 0.5\nnewmtl b\nKe 1 1 1\nmap_d t.png\nTr 0.2\n"
PLY = b"ply\nformat ascii 1.0\ncomment TextureFile t.png\nelement vertex 4\nproperty float x\nproperty float y\n"
PLY += b"property float z\nproperty float nx\nproperty float ny\nproperty float nz\nproperty uchar red\n"
PLY += (
    b"property uchar green\nproperty uchar blue\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n"
)
PLY += b"0 0 0 0 0 1 255 0 0\n1 0 0 0 0 1 0 255 0\n1 1 0 0 0 1 0 0 255\n0 1 0 0 0 1 9 9 9\n4 0 1 2 3\n3 0 1 2\n"
BINARY_PLY = b"ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty double y\n"
BINARY_PLY += b"property short z\nelement face 2\nproperty list uchar int vertex_indices\nproperty uchar red\n"
BINARY_PLY += b"element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
BINARY_PLY += b"".join(struct.pack("<fdh", x, y, 0) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1)))
BINARY_PLY += struct.pack("<B4iBB3iB", 4, 0, 1, 2, 3, 7, 3, 0, 1, 2, 9) + struct.pack("<i4i", 4, 0, 1, 2, 3)
STL = (
    b"solid a\n"
    + b"facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1e0 0\nendloop\nendfacet\n" * 3
)
STL += b"endsolid a\n"
BINARY_STL = b"binary".ljust(80) + struct.pack("<I", 3) + struct.pack("<12fH", *range(12), 0) * 3
OFF = b"COFF\n4 2 0\n0 0 0 1 0 0 1\n1 0 0 0 1 0 1\n1 1 0 0 0 1 1\n0 1 0 1 1 1 1\n4 0 1 2 3\n3 0 1 2 255 0 0\n"
CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
MODEL = f'<model xmlns="{CORE}"><resources><object id="1"><mesh><vertices>'
MODEL += "".join(f'<vertex x="{x}" y="{y}" z="0"/>' for x, y in ((0, 0), (1, 0), (0, 1)))
MODEL += '</vertices><triangles><triangle v1="0" v2="1" v3="2"/></triangles></mesh></object><object id="2">'
MODEL += '<components><component objectid="1" transform="1 0 0 0 1 0 0 0 1 5 0 0"/></components></object></resources>'
MODEL += '<build><item objectid="2"/></build></model>'
HDR = (
    b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\n\n-Y 4 +X 8\n"
    + (b"\2\2\0\x08" + (b"\x88\x80" + b"\x08" + bytes(range(8))) * 2) * 4
)


def picture(kind: str) -> bytes:
    stream = io.BytesIO()
    rng = np.random.default_rng(5)
    Image.fromarray(rng.integers(0, 256, (16, 16, 3), np.uint8)).save(stream, kind)
    return stream.getvalue()


def exr() -> bytes:
    import OpenEXR

    rng = np.random.default_rng(5)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.exr"
        header = {"type": OpenEXR.scanlineimage, "compression": OpenEXR.ZIP_COMPRESSION, "comments": "a remark"}
        with OpenEXR.File(header, {name: rng.random((8, 8)).astype(np.float16) for name in "RGB"}) as file:
            file.write(str(path))
        return path.read_bytes()


def archive(model: bytes) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as file:
        file.writestr("3D/3dmodel.model", model)
    return stream.getvalue()


# --- damage


def bytes_damaged(data: bytes, rng: random.Random) -> bytes:
    """A few bytes changed, taken out, repeated, or the end cut off."""
    damaged = bytearray(data)
    for _ in range(rng.randint(1, 4)):
        place = rng.randrange(max(len(damaged), 1))
        match rng.randrange(5):
            case 0:
                damaged[place : place + 1] = bytes([rng.randrange(256)])
            case 1:
                del damaged[place : place + rng.randint(1, 12)]
            case 2:
                damaged[place:place] = damaged[place : place + rng.randint(1, 30)]
            case 3:
                del damaged[place:]
            case 4:
                damaged[place : place + 4] = struct.pack("<i", rng.choice((-1, 2**31 - 1, 0, 2**16)))
    return bytes(damaged)


def words_damaged(data: bytes, rng: random.Random) -> bytes:
    """A few words replaced by numbers that are none, too large, or negative; or bytes damaged."""
    if rng.random() < 0.3:
        return bytes_damaged(data, rng)
    words = re.split(rb"(\s+|/|\")", data)
    for _ in range(rng.randint(1, 3)):
        place = rng.randrange(len(words))
        words[place] = rng.choice((*NUMBERS, rng.choice(words)))
    return b"".join(words)


def json_damaged(header: Any, rng: random.Random) -> Any:
    """A few values anywhere in the JSON replaced, taken out, or exchanged for a neighbour's."""
    header = json.loads(json.dumps(header))
    for _ in range(rng.randint(1, 3)):
        owner, key = header, rng.choice(list(header))
        while isinstance(owner[key], (dict, list)) and owner[key] and rng.random() < 0.85:
            owner = owner[key]
            key = rng.choice(list(owner)) if isinstance(owner, dict) else rng.randrange(len(owner))
        if rng.random() < 0.3:
            del owner[key]
            if not header:
                break
        else:
            owner[key] = rng.choice(VALUES)
    return header


def gltf_files(rng: random.Random) -> dict[str, bytes]:
    header, data = gltf()
    header["buffers"][0]["uri"] = "a.bin"
    damaged = json.dumps(json_damaged(header, rng)).replace(
        "1e+308", rng.choice(("1e+308", "1e999", "NaN", "9" * 5000))
    )
    return {"a.gltf": damaged.encode(), "a.bin": data}


def compressed(rng: random.Random, by: str) -> dict[str, bytes]:
    """A ball whose compressed bytes are damaged; `by` is "draco" or "meshopt"."""
    import trimesh

    ball = trimesh.creation.icosphere(1)
    corners, faces = ball.vertices.astype("<f4"), ball.faces.astype("<u4")
    primitive: dict[str, Any] = {"attributes": {"POSITION": 0}}
    accessors: list[dict[str, Any]] = [{"componentType": 5126, "count": len(corners), "type": "VEC3"}]
    if by == "draco":
        import DracoPy

        streams = [DracoPy.encode(corners, faces, quantization_bits=12)]
        attributes = {"POSITION": DracoPy.decode(streams[0]).attributes[0]["unique_id"]}
        primitive["extensions"] = {"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": attributes}}
        extensions: list[dict[str, Any]] = [{}]
    else:
        import meshopt

        rows = meshopt.encode_filter_exp(corners, 15)
        streams = [meshopt.encode_gltf_buffer(rows, "ATTRIBUTES"), meshopt.encode_gltf_buffer(faces, "TRIANGLES")]
        extensions = [
            {"byteStride": 12, "count": len(corners), "mode": "ATTRIBUTES", "filter": "EXPONENTIAL"},
            {"byteStride": 4, "count": faces.size, "mode": "TRIANGLES"},
        ]
        accessors[0]["bufferView"] = 0
        accessors.append({"bufferView": 1, "componentType": 5125, "count": faces.size, "type": "SCALAR"})
        primitive["indices"] = 1
    damaged = bytes_damaged(b"".join(streams), rng)
    starts = np.cumsum([0, *map(len, streams)]).tolist()
    views = [
        {"buffer": 0, "byteOffset": start, "byteLength": len(one)} for start, one in zip(starts, streams, strict=False)
    ]
    for view, extension in zip(views, extensions, strict=True):
        if extension:
            view["extensions"] = {"EXT_meshopt_compression": {**view, **extension}}
            view["byteLength"] = extension["byteStride"] * extension["count"]
    header = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [primitive]}], "accessors": accessors, "bufferViews": views,
        "buffers": [{"byteLength": len(damaged)}],
    }  # fmt: skip
    return {"a.glb": glb(header, damaged)}


# by kind: the files of a seed, the first of which is loaded
KINDS: dict[str, Callable[[random.Random], dict[str, bytes]]] = {
    "glb": lambda rng: {"a.glb": bytes_damaged(glb(*gltf()), rng)},
    "glb json": lambda rng: {"a.glb": glb(json_damaged(gltf()[0], rng), gltf()[1])},
    "glb binary": lambda rng: {"a.glb": glb(gltf()[0], bytes_damaged(gltf()[1], rng))},
    "gltf": gltf_files,
    "glb draco": lambda rng: compressed(rng, "draco"),
    "glb meshopt": lambda rng: compressed(rng, "meshopt"),
    "obj": lambda rng: {"a.obj": words_damaged(OBJ, rng), "m.mtl": MTL, "t.png": picture("PNG")},
    "mtl": lambda rng: {"a.obj": OBJ, "m.mtl": words_damaged(MTL, rng), "t.png": picture("PNG")},
    "ascii ply": lambda rng: {"a.ply": words_damaged(PLY, rng), "t.png": picture("PNG")},
    "binary ply": lambda rng: {"a.ply": bytes_damaged(BINARY_PLY, rng)},
    "ascii stl": lambda rng: {"a.stl": words_damaged(STL, rng)},
    "binary stl": lambda rng: {"a.stl": bytes_damaged(BINARY_STL, rng)},
    "off": lambda rng: {"a.off": words_damaged(OFF, rng)},
    "3mf": lambda rng: {"a.3mf": bytes_damaged(archive(MODEL.encode()), rng)},
    "3mf model": lambda rng: {"a.3mf": archive(words_damaged(MODEL.encode(), rng))},
    "texture": lambda rng: {
        "a.obj": OBJ,
        "m.mtl": MTL,
        "t.png": bytes_damaged(picture(rng.choice(("PNG", "JPEG", "BMP", "TIFF", "GIF", "TGA", "WEBP"))), rng),
    },
    "exr": lambda rng: {"a.exr": bytes_damaged(exr(), rng)},
    "hdr": lambda rng: {"a.hdr": words_damaged(HDR, rng)},
}


def fault_of(folder: Path, files: dict[str, bytes], options: dict[str, Any]) -> str | None:
    """The fault in how aolab takes the files, or None."""
    import aolab

    for name, content in files.items():
        (folder / name).write_bytes(content)
    path = folder / next(iter(files))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            if path.suffix in (".exr", ".hdr"):
                aolab.Environment.load(path)
            else:
                aolab.load(path, **options)
            told = []
        except aolab.Error as error:
            told = [str(error)]
        except Exception as error:
            return f"{type(error).__name__}: {error}"
    told += [str(one.message) for one in caught]
    for one in caught:
        if not issubclass(one.category, aolab.Notice):
            return f"{one.category.__name__}: {one.message}"
    for text in told:
        if PYTHON.search(text):
            return text
        if len(text) > 1500 or "\n" in text:
            return f"{len(text)} characters: {text[:200]!r}"
    return None


def main(kind: str, first: int, last: int) -> None:
    for seed in range(first, last):
        rng = random.Random(f"{kind} {seed}")
        with tempfile.TemporaryDirectory() as folder:
            options = {"time": 0.5} if "gl" in kind and rng.random() < 0.5 else {}
            print(seed, flush=True)  # a crash is found by the last seed
            fault = fault_of(Path(folder), KINDS[kind](rng), options)
            if fault:
                print(f"seed {seed}: {fault}".replace("\n", " | "), file=sys.stderr)


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]))
