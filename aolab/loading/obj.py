"""Wavefront OBJ: polygons with materials, read in time linear in the file.

Source: "Object Files (.obj)", Wavefront Advanced Visualizer 3.0, appendix B1. Vertex colours (six numbers behind
`v`) are an addition of later programs. Objects, groups and smoothing groups are not kept: all that has one material is
a part.
"""

import re
from itertools import pairwise
from pathlib import Path

import numpy as np

from ..errors import FileError, shorten
from ..maths.rows import distinct_rows
from ..scene.mesh import Material
from .folder import Folder, decoded
from .materials import linear_colors
from .mtl import Library, Paint
from .numbers import Lines, counts_of, numbers, table
from .options import FileOptions
from .parts import Content, Notes, Part, Placed
from .polygons import triangulate

WITHOUT_TRIANGLES = {"l": "lines", "p": "points", "curv": "curves", "curv2": "curves", "surf": "surfaces"}
# the forms of a face's corners, by the columns of vertex, uv and normal that their numbers fill
FORMS = (
    (re.compile(r"(?:\s*+-?\d++)*+\s*+"), (0,)),
    (re.compile(r"(?:\s*+-?\d++/-?\d++)*+\s*+"), (0, 1)),
    (re.compile(r"(?:\s*+-?\d++//-?\d++)*+\s*+"), (0, 2)),
    (re.compile(r"(?:\s*+-?\d++/-?\d++/-?\d++)*+\s*+"), (0, 1, 2)),
)
MANY = 256  # materials; of more, those that differ in their colour alone become one part with colours of vertices
LEAST = {"v": 3, "vt": 1, "vn": 3}  # numbers behind the keyword
NAMES = ("vertex", "texture coordinate", "normal")


def read(data: bytes, path: Path, folder: Folder, options: FileOptions, root: np.ndarray) -> Content:
    """The parts of an OBJ file, one a material, at the pose `root`. Raises `FileError`, with the line's number."""
    notes = Notes()
    library = Library(folder, notes)
    lines, rest = _by_keyword(decoded(data))
    names, starts = _statements(rest, library, notes)
    points, coordinates, normals = (table(lines[key], least) for key, least in LEAST.items())
    if coordinates.shape[1] == 1:  # v is 0 where it is not given
        coordinates = np.column_stack([coordinates, np.zeros(len(coordinates))])
    faces = lines["f"]
    if not faces.texts:
        return Content(notes=notes)
    before = np.column_stack([np.searchsorted(lines[keyword].numbers, faces.numbers) for keyword in ("v", "vt", "vn")])
    corners, counts = _corners(faces, before, [len(points), len(coordinates), len(normals)])
    triangles, polygon = triangulate(points[corners[:, 0], :3], counts)
    distinct, of_name = np.unique(names, return_inverse=True)
    material = of_name[np.searchsorted(starts, faces.numbers, side="right") - 1][polygon]
    paints = {number: library.paint(str(distinct[number])) for number in np.unique(material).tolist()}
    plain = [number for number, paint in paints.items() if paint.is_plain]
    group = np.arange(len(distinct))  # of materials that become one part
    palette = np.ones((len(distinct), 3))
    if len(plain) > MANY:
        group[plain] = plain[0]
        colored = points.shape[1] >= 6  # vertices with colours and without a material have no other colour
        palette[plain] = [
            (1, 1, 1) if paints[one].is_default and colored else paints[one].material.base_color for one in plain
        ]
    order = np.argsort(group[material], kind="stable")
    bounds = np.flatnonzero(np.diff(group[material[order]], prepend=-1, append=-1))
    placed = []
    for start, stop in pairwise(bounds.tolist()):
        chosen = order[start:stop]
        first = int(material[chosen[0]])
        name, tint = str(distinct[first]), None
        if len(plain) > MANY and paints[first].is_plain:
            name, tint = f"{len(plain)} colours", (np.repeat(material[chosen], 3), palette)
        arrays = corners[triangles[chosen].reshape(-1)], points, coordinates, normals
        part = _part(*arrays, paints[first], tint)
        part.name = path.stem if len(bounds) == 2 else f"{path.stem} {name or 'without material'}"
        placed.append(Placed(part, root, part.name))
    return Content(placed, notes=notes)


def _by_keyword(text: str) -> tuple[dict[str, Lines], list[tuple[int, str]]]:
    """The lines of vectors and faces by keyword, and all other lines with their numbers.

    A line that ends in a backslash goes on in the next. Comments are cut off.
    """
    lines = text.split("\n")
    if "\\\n" in text:
        for number in range(len(lines) - 1, 0, -1):
            if lines[number - 1].endswith("\\"):
                lines[number - 1], lines[number] = lines[number - 1][:-1] + " " + lines[number], ""
    if "#" in text:
        lines = [line.partition("#")[0] if "#" in line else line for line in lines]
    if "\t" in text:
        lines = [line.replace("\t", " ") for line in lines]
    if "\n " in text or text.startswith(" ") or "\t" in text:
        lines = [line.lstrip() for line in lines]
    heads = np.array([line[:2] for line in lines])
    found = {}
    for keyword, head in {"v": "v ", "vt": "vt", "vn": "vn", "f": "f "}.items():
        places = np.flatnonzero(heads == head)
        found[keyword] = Lines([lines[place][2:] for place in places.tolist()], places + 1, keyword)
    others = np.flatnonzero(~np.isin(heads, ["v ", "vt", "vn", "f ", ""]))
    return found, [(place + 1, lines[place]) for place in others.tolist()]


def _statements(rest: list[tuple[int, str]], library: Library, notes: Notes) -> tuple[list[str], list[int]]:
    """The materials in the order of their use, and the line from which each holds; before any, "" holds."""
    names, starts = [""], [0]
    for number, line in rest:
        keyword, _, value = line.partition(" ")
        if keyword == "usemtl":
            names.append(value.strip())
            starts.append(number)
        elif keyword == "mtllib":
            library.add(value.strip())
        elif keyword in WITHOUT_TRIANGLES:
            notes.add("left out, as they hold no triangles: ", WITHOUT_TRIANGLES[keyword])
    return names, starts


def _corners(faces: Lines, before: np.ndarray, totals: list[int]) -> tuple[np.ndarray, np.ndarray]:
    """(C, 3): vertex, texture coordinate and normal of each corner, from 0, -1 where there is none; and the counts of
    the faces' corners (P,).

    `before` (P, 3): how many vectors stand before each face; an index below 0 counts back from there.
    """
    texts = faces.texts
    counts = counts_of(faces)
    total = int(counts.sum())
    stated = np.zeros((total, 3), np.int64)
    joined = " ".join(texts)
    for form, columns in FORMS:
        if form.fullmatch(joined):
            flat = numbers(joined.replace("/", " "), np.int64, total * len(columns))
            if flat is not None:
                stated[:, columns] = flat.reshape(total, len(columns))
                given = np.isin(np.arange(3), columns)
                break
    else:
        given = _corner_by_corner(faces, stated)
    face = np.repeat(np.arange(len(texts)), counts)
    zero = np.flatnonzero(((stated == 0) & given).any(axis=1))
    if len(zero):
        raise FileError(f"{faces.shown(int(face[zero[0]]))} has index 0; OBJ counts from 1")
    corners = np.where(stated > 0, stated - 1, np.where(stated < 0, before[face] + stated, -1))
    wrong = np.argwhere(given & ((corners < 0) | (corners >= totals)))
    if len(wrong):
        corner, kind = wrong[0]
        shown = faces.shown(int(face[corner]))
        raise FileError(f"{shown} has {NAMES[kind]} {stated[corner, kind]} of {totals[kind]}")
    return corners, counts


def _corner_by_corner(faces: Lines, stated: np.ndarray) -> np.ndarray:
    """Fill `stated` (C, 3) where the corners have several forms; returns which numbers are given (C, 3) bool."""
    given = np.zeros(stated.shape, bool)
    place = 0
    for text, number in zip(faces.texts, faces.numbers, strict=True):
        for token in text.split():
            parts = token.split("/")
            try:
                if not parts[0] or len(parts) > 3:
                    raise ValueError
                for column, part in enumerate(parts):
                    if part:
                        stated[place, column] = int(part)
                        given[place, column] = True
            except (ValueError, OverflowError):
                raise FileError(
                    f"line {number}: '{shorten(token)}' is no corner of a face; write 1, 1/2, 1//3 or 1/2/3"
                ) from None
            place += 1
    return given


def _part(
    corners: np.ndarray,
    points: np.ndarray,
    coordinates: np.ndarray,
    normals: np.ndarray,
    paint: Paint,
    tint: tuple[np.ndarray, np.ndarray] | None = None,
) -> Part:
    """The part of some triangles, whose corners are `corners` (3 F, 3): a vertex a distinct corner.

    `tint`: a number for each corner (3 F,), and the linear colours (n, 3) that they number, in place of the paint's.
    """
    row = None
    if tint is None and (corners[:, 1:] < 0).all():
        point, number = np.unique(corners[:, 0], return_inverse=True)
        coordinate = normal = np.full(len(point), -1)
    else:
        columns = [corners] if tint is None else [corners, tint[0]]
        row, number = distinct_rows(np.column_stack(columns).astype(np.int32))
        point, coordinate, normal = corners[row].T
    colors, uv, given = None, None, None
    if points.shape[1] >= 6:
        colors = linear_colors(points[point, 3:6], srgb=True)
    if (coordinate >= 0).any():
        uv = np.where(coordinate[:, None] >= 0, coordinates[coordinate, :2], 0) * paint.scale + paint.offset
    if (normal >= 0).any():
        given = np.where(normal[:, None] >= 0, normals[normal, :3], 0)
    material = Material(base_color=(1.0, 1.0, 1.0)) if colors is not None and paint.is_default else paint.material
    if tint is not None:
        colors = linear_colors(tint[1][tint[0][row]], srgb=False) * (1 if colors is None else colors)
        material = Material(base_color=(1.0, 1.0, 1.0))
    return Part(points[point, :3], number.reshape(-1, 3), given, uv, colors, material)
