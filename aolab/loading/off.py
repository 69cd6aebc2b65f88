"""OFF, the Object File Format of Geomview: polygons, with normals, colours and texture coordinates at the vertices.

Source: "Object File Format", geomview.org/docs/html/OFF.html. Colours of faces are read, too; the binary form is not.
"""

import re
from pathlib import Path

import numpy as np

from ..errors import FileError, shorten
from ..scene.mesh import Material
from .folder import Folder, decoded
from .materials import linear_colors
from .numbers import Lines, counts_of, flat, table, within
from .options import FileOptions
from .parts import Content, Part, Placed
from .polygons import triangulate

_HEADER = re.compile(r"(ST)?(C)?(N)?(4)?OFF", re.IGNORECASE)


def read(data: bytes, path: Path, folder: Folder, options: FileOptions, root: np.ndarray) -> Content:
    """The part of an OFF file, at the pose `root`. Raises `FileError`, with the line's number."""
    text = decoded(data)
    lines = text.split("\n")
    if "#" in text:
        lines = [line.partition("#")[0] for line in lines]
    places = np.array([place for place, line in enumerate(lines) if line and not line.isspace()], np.int64)
    if not len(places):
        raise FileError("is no OFF file: it holds nothing but comments")
    first, _, behind = lines[places[0]].strip().partition(" ")
    header = _HEADER.fullmatch(first)
    if header is None:
        raise FileError(f"is no OFF file: it starts with '{shorten(first)}'")
    if behind.strip().upper() == "BINARY":
        raise FileError("is a binary OFF file; only the ASCII form is read")
    if behind.strip():  # the counts may share the first line
        lines[places[0]] = behind
    else:
        places = places[1:]
    rows = Lines([lines[place] for place in places], places + 1)
    if not len(places):
        raise FileError("is truncated: the counts of vertices and faces are missing")
    counts = table(_part_of(rows, 0, 1), 2)[0, :2]
    if not (counts >= 0).all() or not (counts < 2**53).all() or (counts % 1).any():
        raise FileError(f"{rows.shown(0)} is no count of vertices and faces")
    vertices, faces = counts.astype(np.int64).tolist()
    if len(places) < 1 + vertices + faces:
        raise FileError(f"is truncated: {vertices} vertices and {faces} faces need {vertices + faces} lines")
    end = 1 + vertices
    part = _part(_part_of(rows, 1, end), _part_of(rows, end, end + faces), header)
    part.name = path.stem
    return Content([Placed(part, root, path.stem)])


def _part_of(lines: Lines, start: int, stop: int) -> Lines:
    return Lines(lines.texts[start:stop], lines.numbers[start:stop])


def _part(vertices: Lines, faces: Lines, header: re.Match[str]) -> Part:
    has_uv, has_color, has_normal, has_w = (bool(group) for group in header.groups())
    size = 4 if has_w else 3
    columns = table(vertices, size + 3 * has_normal + 3 * has_color + 2 * has_uv)
    points, at, last = columns[:, :3], size, columns.shape[1] - 2 * has_uv
    normals = columns[:, at : at + 3] if has_normal else None
    at += 3 * has_normal
    colors = linear_colors(_fractions(columns[:, at : min(at + 4, last)]), srgb=True) if has_color else None
    uv = columns[:, last:] if has_uv else None
    triangles, tint = _triangles(faces, points)
    if colors is None and tint is not None:  # a vertex a corner, since the faces at a vertex differ
        corner = triangles.reshape(-1)
        points, colors = points[corner], np.repeat(linear_colors(tint, srgb=True), 3, axis=0)
        normals, uv = (None if array is None else array[corner] for array in (normals, uv))
        triangles = np.arange(len(corner)).reshape(-1, 3)
    material = Material() if colors is None else Material(base_color=(1.0, 1.0, 1.0))
    return Part(points, triangles, normals, uv, colors, material)


def _triangles(faces: Lines, points: np.ndarray) -> tuple[np.ndarray, np.ndarray | None]:
    """The triangles (F, 3), and their colours (F, 3) where every face has one."""
    words = counts_of(faces)
    values = flat(faces, words)
    starts = np.cumsum(words) - words
    counts = values[starts]
    wrong = np.flatnonzero(~((counts >= 0) & (counts <= words - 1) & (counts % 1 == 0)))
    if len(wrong):
        raise FileError(f"{faces.shown(wrong[0])} has {words[wrong[0]] - 1} corners, not {counts[wrong[0]]:g}")
    counts = counts.astype(np.int64)
    place = np.repeat(starts + 1, counts) + within(counts)
    index = values[place]
    wrong = np.flatnonzero(~((index >= 0) & (index < len(points)) & (index % 1 == 0)))
    if len(wrong):
        face = int(np.searchsorted(np.cumsum(counts), wrong[0], side="right"))
        raise FileError(f"{faces.shown(face)} has vertex {index[wrong[0]]:g} of {len(points)}, counted from 0")
    index = index.astype(np.int64)
    corner, polygon = triangulate(points[index], counts)
    if not len(counts) or (words - 1 - counts).min() < 3:
        return index[corner], None
    tint = values[(starts + 1 + counts)[:, None] + np.arange(3)]
    return index[corner], _fractions(tint)[polygon]


def _fractions(colors: np.ndarray) -> np.ndarray:
    """Colours in [0, 1]: where one is above 1, they are bytes."""
    return colors / (255.0 if colors.size and colors.max() > 1 else 1.0)
