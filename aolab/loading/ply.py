"""PLY, ASCII and binary: polygons of any size, triangle strips, normals, texture coordinates, colours.

Source: Greg Turk, "The PLY Polygon File Format", 1994; triangle strips as in Stanford's scans. Own code, as plyfile,
the well-kept reader, is under the GPL.
"""

import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ..errors import Error, FileError, shorten
from ..input import TooLarge
from ..pictures.images import read_image
from ..scene.mesh import Material, Texture
from .folder import Folder
from .materials import linear_colors
from .options import FileOptions
from .parts import Content, Notes, Part, Placed
from .polygons import triangulate

TYPES = {
    **{"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4", "float": "f4"},
    **{"int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4", "float32": "f4"},
    **{"double": "f8", "float64": "f8", "int64": "i8", "uint64": "u8"},
}
ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
READ = ("vertex", "face", "tristrips")  # elements
MAX_HEADER = 1 << 20  # bytes
# the names that programs give to the same property
XYZ, NORMAL = (("x", "y", "z"),), (("nx", "ny", "nz"), ("normal_x", "normal_y", "normal_z"))
UV = (("s", "t"), ("u", "v"), ("texture_u", "texture_v"), ("texture_s", "texture_t"))
RGB = (("red", "green", "blue"), ("r", "g", "b"), ("diffuse_red", "diffuse_green", "diffuse_blue"))
ALPHA = (("alpha",), ("a",))
INDICES = ("vertex_indices", "vertex_index")


@dataclass
class _Property:
    name: str
    type: str  # as NumPy writes it, without byte order
    count: str | None = None  # of a list: the type of its length


@dataclass
class _Element:
    name: str
    rows: int
    properties: list[_Property] = field(default_factory=list)


@dataclass
class _List:
    """A list property: the values of all rows, and how many each row has."""

    values: np.ndarray
    counts: np.ndarray


Columns = dict[str, np.ndarray | _List]


def read(data: bytes, path: Path, folder: Folder, options: FileOptions, root: np.ndarray) -> Content:
    """The part of a PLY file, at the pose `root`. Raises `FileError`."""
    order, elements, comments, start = _header(data)
    tables = _ascii(data[start:], elements) if order == "ascii" else _binary(data, start, elements, ORDERS[order])
    notes = Notes()
    for element in elements:
        if element.rows and element.name == "edge":
            notes.add("left out, as they hold no triangles: ", "lines")
        elif element.rows and element.name not in READ:
            notes.add("read, but not used: ", f"element '{shorten(element.name)}'")
    vertex = tables.get("vertex", {})
    points = _columns(vertex, XYZ)
    if points is None:
        raise FileError("has no vertices with x, y and z")
    faces, corner_uv, face_colors = _faces(tables, points, notes)
    if not len(faces):
        return Content(left_out=[f"its {len(points)} vertices are points, and no triangle joins them"])
    normals, uv = _columns(vertex, NORMAL), _columns(vertex, UV)
    colors = _colors(vertex)
    if corner_uv is not None or (face_colors is not None and colors is None):
        # a vertex a corner, since corners of one vertex differ
        corner = faces.reshape(-1)
        if corner.min() < 0 or corner.max() >= len(points):
            raise FileError(f"a face names vertex {corner.max()} of {len(points)}")
        points, normals, uv, colors = (None if a is None else a[corner] for a in (points, normals, uv, colors))
        uv = uv if corner_uv is None else corner_uv
        colors = colors if face_colors is None or colors is not None else np.repeat(face_colors, 3, axis=0)
        faces = np.arange(len(corner)).reshape(-1, 3)
    material = Material(base_color=(1.0, 1.0, 1.0)) if colors is not None else Material()
    texture = _texture(comments, folder, notes)
    if texture is not None and uv is None:
        notes.add(
            "its texture ", f"'{texture.name}'", " was left out: neither vertices nor faces have coordinates for it"
        )
    elif texture is not None:
        material = Material(base_color=(1.0, 1.0, 1.0), texture=texture)
    assert points is not None
    rgba = None if colors is None else linear_colors(colors, srgb=True)
    part = Part(points, faces, normals, uv, rgba, material, path.stem)
    return Content([Placed(part, root, path.stem)], notes=notes)


def _header(data: bytes) -> tuple[str, list[_Element], list[str], int]:
    """The byte order, the elements, the comments, and where the data begin. Lines end as the first one does."""
    first = re.match(rb"(?:\xef\xbb\xbf)?\s*(?:ply|PLY)[ \t]*(\r\n|\n|\r)", data)
    if first is None:
        raise FileError(f"is no PLY file: it starts with {data[:12]!r}")
    newline = first[1]
    end = re.compile(rb"(?:^|(?<=[\r\n]))end_header[ \t]*" + newline).search(data[:MAX_HEADER])
    if end is None:
        raise FileError("is truncated or corrupt: it has no line 'end_header'")
    order, elements, comments = "", [], []
    for line in re.split(r"\r\n|\n|\r", data[first.end() : end.start()].decode("latin-1")):
        words = line.split()
        try:
            match words:
                case ["format", order, *_] if order in ORDERS:
                    pass
                case ["comment" | "obj_info", *_]:
                    comments.append(line.partition(words[0])[2].strip())
                case ["element", name, rows]:
                    elements.append(_Element(name, _whole(rows)))
                case ["property", "list", count, kind, name]:
                    elements[-1].properties.append(_Property(name, TYPES[kind], TYPES[count]))
                case ["property", kind, name]:
                    elements[-1].properties.append(_Property(name, TYPES[kind]))
                case []:
                    pass
                case _:
                    raise ValueError
        except (ValueError, KeyError, IndexError):
            raise FileError(f"has a header line that is not PLY: '{shorten(line)}'") from None
    if not order:
        raise FileError(f"its header states no format; known: {', '.join(ORDERS)}")
    return order, elements, comments, end.end()


def _whole(text: str) -> int:
    value = int(text[:20])
    if value < 0:
        raise ValueError
    return value


def _ascii(data: bytes, elements: list[_Element]) -> dict[str, Columns]:
    """The elements of a text file, one row a line; lines may also be joined."""
    words = data.split()
    at, tables = 0, {}
    for element in elements:
        columns: Columns = {}
        lists = [property for property in element.properties if property.count]
        width = len(element.properties)
        if not lists:
            taken, at = words[at : at + element.rows * width], at + element.rows * width
            if len(taken) < element.rows * width:
                raise FileError(f"is truncated: it ends within element '{shorten(element.name)}'")
            values = _floats(taken, element).reshape(element.rows, width)
            columns = {property.name: values[:, i] for i, property in enumerate(element.properties)}
        else:
            columns, at = _ascii_lists(words, at, element)
        tables.setdefault(element.name, columns)
    return tables


def _ascii_lists(words: list[bytes], at: int, element: _Element) -> tuple[Columns, int]:
    """The columns of an element with lists, and where the next one begins."""
    taken: list[list[bytes]] = [[] for _ in element.properties]
    counts: list[list[int]] = [[] for _ in element.properties]
    if element.rows > len(words):
        raise FileError(f"is truncated: it ends within element '{shorten(element.name)}'")
    try:
        for _ in range(element.rows):
            for column, property in enumerate(element.properties):
                count = 1
                if property.count:
                    count, at = int(words[at]), at + 1
                    counts[column].append(count)
                if count < 0 or at + count > len(words):
                    raise IndexError
                taken[column] += words[at : at + count]
                at += count
    except IndexError:
        raise FileError(f"is truncated: it ends within element '{shorten(element.name)}'") from None
    except ValueError:
        raise FileError(f"has a list in element '{shorten(element.name)}' whose length is no whole number") from None
    columns: Columns = {}
    for property, values, count in zip(element.properties, taken, counts, strict=True):
        numbers = _floats(values, element)
        columns[property.name] = _List(numbers, np.array(count, np.int64)) if property.count else numbers
    return columns, at


def _floats(words: list[bytes], element: _Element) -> np.ndarray:
    try:
        return np.array(words, "S40").astype(np.float64) if words else np.zeros(0)
    except ValueError:
        raise FileError(f"has a value in element '{shorten(element.name)}' that is no number") from None


def _binary(data: bytes, at: int, elements: list[_Element], order: str) -> dict[str, Columns]:
    """The elements of a binary file."""
    tables: dict[str, Columns] = {}
    for element in elements:
        kinds = [(property, np.dtype(order + property.type)) for property in element.properties]
        if any(property.count for property in element.properties):
            columns, at = _binary_lists(data, at, element, order)
        else:
            row = np.dtype({
                "names": [f"{i}" for i in range(len(kinds))],
                "formats": [kind for _, kind in kinds],
            })  # fmt: skip
            size = element.rows * row.itemsize
            _refuse_truncated(data, at, size, element)
            table = np.frombuffer(data, row, element.rows, at) if size else np.zeros(0, row)
            columns: Columns = {property.name: table[f"{i}"] for i, (property, _) in enumerate(kinds)}
            at += size
        tables.setdefault(element.name, columns)
    return tables


def _binary_lists(data: bytes, at: int, element: _Element, order: str) -> tuple[Columns, int]:
    """The columns of an element with lists: where each property of each row begins, then all values in one go."""
    properties = [
        (np.dtype(order + (p.count or "u1")), np.dtype(order + p.type), bool(p.count)) for p in element.properties
    ]
    _refuse_truncated(data, at, element.rows * sum(k.itemsize if n else v.itemsize for k, v, n in properties), element)
    places: list[list[int]] = [[] for _ in properties]
    counts: list[list[int]] = [[] for _ in properties]
    endian = "big" if order == ">" else "little"
    end = len(data)
    for _ in range(element.rows):
        for column, (length, value, is_list) in enumerate(properties):
            count = 1
            if is_list:
                count = int.from_bytes(data[at : at + length.itemsize], endian)
                if (length.kind != "u" and count >> (8 * length.itemsize - 1)) or length.kind == "f":
                    raise FileError(f"has a list in element '{shorten(element.name)}' whose length is no whole number")
                at += length.itemsize
            places[column].append(at)
            counts[column].append(count)
            at += count * value.itemsize
            if at > end:
                raise FileError(f"is truncated: it ends within element '{shorten(element.name)}'")
    octets = np.frombuffer(data, np.uint8)
    columns: Columns = {}
    for property, (_, value, is_list), place, count in zip(element.properties, properties, places, counts, strict=True):
        number = np.array(count, np.int64)
        within = np.arange(int(number.sum())) - np.repeat(np.cumsum(number) - number, number)
        first = np.repeat(np.array(place, np.int64), number) + within * value.itemsize
        values = octets[first[:, None] + np.arange(value.itemsize)].reshape(-1).view(value)
        columns[property.name] = _List(values, number) if is_list else values
    return columns, at


def _refuse_truncated(data: bytes, at: int, size: int, element: _Element) -> None:
    if at + size > len(data):
        raise FileError(
            f"is truncated: element '{shorten(element.name)}' of {element.rows} rows needs {size} bytes, "
            f"and {len(data) - at} are left"
        )


def _columns(table: Columns, names: tuple[tuple[str, ...], ...]) -> np.ndarray | None:
    """(n, columns) of the first group of names that the table has in full."""
    for group in names:
        found = [table.get(name) for name in group]
        if all(isinstance(column, np.ndarray) for column in found):
            return np.column_stack(found)  # type: ignore[arg-type]
    return None


def _colors(table: Columns) -> np.ndarray | None:
    """(n, 3 or 4): bytes, or floats in [0, 1]; numbers beyond 1 are taken for bytes, as text files do not tell."""
    rgb, alpha = _columns(table, RGB), _columns(table, ALPHA)
    if rgb is None:
        return None
    colors = rgb if alpha is None else np.column_stack([rgb, alpha])
    if colors.dtype == np.uint8:
        return colors
    return colors / (255.0 if len(colors) and colors.max() > 1 else 1.0)


def _faces(
    tables: dict[str, Columns], points: np.ndarray, notes: Notes
) -> tuple[np.ndarray, np.ndarray | None, np.ndarray | None]:
    """The triangles (F, 3), the texture coordinates of their corners (3 F, 2), and their colours (F, 3 or 4)."""
    face = tables.get("face", {})
    indices = next((face[name] for name in INDICES if isinstance(face.get(name), _List)), None)
    strips = tables.get("tristrips", {})
    strip = next((strips[name] for name in INDICES if isinstance(strips.get(name), _List)), None)
    faces, uv, colors = np.zeros((0, 3), np.int64), None, None
    if isinstance(indices, _List) and len(indices.values):
        index = _whole_numbers(indices.values)
        inside = index.clip(0, max(len(points) - 1, 0))
        corner, polygon = triangulate(np.asarray(points, np.float64)[inside], indices.counts)
        faces, colors = index[corner], _colors(face)
        colors = None if colors is None else colors[polygon]
        coordinates = face.get("texcoord")
        if isinstance(coordinates, _List) and (coordinates.counts == 2 * indices.counts).all():
            uv = np.asarray(coordinates.values, np.float64).reshape(-1, 2)[corner.reshape(-1)]
    if isinstance(strip, _List) and len(strip.values):
        faces = np.concatenate([faces, _strips(_whole_numbers(strip.values), strip.counts)])
        if uv is not None or colors is not None:
            notes.add("colours and texture coordinates of faces were left out, as strips have none")
        uv = colors = None
    return faces, uv, colors


def _whole_numbers(values: np.ndarray) -> np.ndarray:
    if values.dtype.kind == "f" and not (np.isfinite(values).all() and (values == np.round(values)).all()):
        raise FileError("has a face whose vertices are no whole numbers")
    if len(values) and not np.abs(values.astype(np.float64)).max() < 2**53:
        raise FileError(f"a face names vertex {values.max()}")
    return values.astype(np.int64)


def _strips(indices: np.ndarray, counts: np.ndarray) -> np.ndarray:
    """(F, 3): the triangles of strips; -1 ends a strip, and so does the end of a list."""
    ends = np.cumsum(counts)
    breaks = np.zeros(len(indices), bool)
    breaks[indices < 0] = True
    first = np.zeros(len(indices) + 1, bool)
    first[ends] = True
    # the place of each index within its strip
    start = np.maximum.accumulate(np.where(first[:-1] | np.roll(breaks, 1), np.arange(len(indices)), 0))
    place = np.arange(len(indices)) - start
    third = np.flatnonzero((place >= 2) & ~breaks)
    faces = np.column_stack([indices[third - 2], indices[third - 1], indices[third]])
    odd = place[third] % 2 == 1
    faces[odd] = faces[odd][:, (1, 0, 2)]
    return faces


def _texture(comments: list[str], folder: Folder, notes: Notes) -> Texture | None:
    """The texture that a comment names; None, with a note, where it cannot be read."""
    names = [comment.removeprefix("TextureFile ") for comment in comments if comment.startswith("TextureFile ")]
    if len(names) > 1:
        notes.add(f"all but the first of its {len(names)} textures were left out")
    for name in names[:1]:
        shown = f"'{shorten(name.strip())}'"
        try:
            data = folder.get(name.strip())
            return Texture(read_image(data, name.strip(), budget=folder.budget), shorten(name.strip()))
        except TooLarge:
            raise
        except FileNotFoundError:
            notes.add("its texture ", shown, " is missing; drawn without")
        except Error as error:
            notes.add("its texture: ", str(error), "; drawn without")
    return None
