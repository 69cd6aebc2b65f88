"""3MF: the meshes and components of the build, in time linear in the file. Materials and textures are not read.

Source: 3MF Consortium, "3D Manufacturing Format, Core Specification" 1.3. A 3MF file is a ZIP archive; its coordinates
are in the model's unit, with z up. Own code, as the readers at hand expand entities and archives without a limit.
"""

import io
import posixpath
import zipfile
import zlib
from pathlib import Path
from xml.parsers import expat

import numpy as np

from ..errors import FileError, shorten
from .folder import Folder
from .options import FileOptions
from .parts import Content, Notes, Part, Placed

CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
RELATIONSHIPS = "_rels/.rels"
MODEL_TYPE = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"
MODEL = "3D/3dmodel.model"
MAX_DEPTH = 32  # components within components
MAX_PLACED = 100_000  # placements of meshes: components that double at each depth would never end


class _Object:
    """A mesh, or components: (object's id, object_from_component (4, 4)) each."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.vertices: list[tuple[str, str, str]] = []
        self.triangles: list[tuple[str, str, str]] = []
        self.components: list[tuple[str, np.ndarray]] = []


def read(data: bytes, path: Path, folder: Folder, options: FileOptions, root: np.ndarray) -> Content:
    """The parts of a 3MF file's build, at the pose `root`. Raises `FileError`."""
    model = _model(data, folder)
    objects, build, unread = _parsed(model)
    notes = Notes()
    for name in sorted(unread):
        notes.add("read, but not used: ", name)
    parts: dict[str, Part] = {}
    waiting = [(identity, root @ pose, 0) for identity, pose in reversed(build)]
    placed: list[Placed] = []
    visited = 0
    while waiting:
        identity, pose, depth = waiting.pop()
        if identity not in objects:
            raise FileError(f"refers to object '{shorten(identity)}', which is not defined")
        if depth > MAX_DEPTH:
            raise FileError(f"its object '{shorten(identity)}' lies {depth} components deep; the limit is {MAX_DEPTH}")
        one = objects[identity]
        waiting += [(child, pose @ matrix, depth + 1) for child, matrix in reversed(one.components)]
        visited += 1
        if visited > MAX_PLACED:
            raise FileError(f"places more than {MAX_PLACED} objects")
        if one.vertices or one.triangles:
            if identity not in parts:
                parts[identity] = _part(one)
            placed.append(Placed(parts[identity], pose, one.name))
    return Content(placed, notes=notes)


def _model(data: bytes, folder: Folder) -> bytes:
    """The XML of the archive's model."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            name = _model_name(archive, folder)
            return _unpacked(archive, name, folder)
    except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError, KeyError, ValueError) as error:
        # RuntimeError: a file with a password; NotImplementedError: an unusual compression
        raise FileError("is no readable 3MF file: its ZIP archive is corrupt, encrypted, or holds no model") from error


def _model_name(archive: zipfile.ZipFile, folder: Folder) -> str:
    """The path of the model that the archive's relationships name; else where it usually lies."""
    names = archive.namelist()
    found: list[str] = []

    def start(tag: str, attributes: dict[str, str]) -> None:
        if tag.rpartition(" ")[2] == "Relationship" and attributes.get("Type") == MODEL_TYPE:
            found.append(posixpath.normpath(attributes.get("Target", "").lstrip("/")))

    if RELATIONSHIPS in names:
        _parse(_unpacked(archive, RELATIONSHIPS, folder), start)
    return next((name for name in [*found, MODEL] if name in names), "")


def _unpacked(archive: zipfile.ZipFile, name: str, folder: Folder) -> bytes:
    """The bytes of a file in the archive: as many as its directory states, which the budget has to hold."""
    info = archive.getinfo(name)
    folder.budget.take(info.file_size, f"'{shorten(name)}' in the archive")
    with archive.open(info) as file:
        data = file.read(info.file_size + 1)
    if len(data) != info.file_size:
        raise zipfile.BadZipFile
    return data


def _parse(xml: bytes, start: object, end: object = None) -> None:
    """Run through XML; tags are "namespace name". Raises `FileError` for a document type: entities live there."""
    parser = expat.ParserCreate(namespace_separator=" ")
    parser.StartElementHandler = start  # type: ignore[assignment]
    parser.EndElementHandler = end  # type: ignore[assignment]

    def refuse(*_: object) -> None:
        raise FileError("its XML declares a document type, which is refused: entities could be of any size")

    parser.StartDoctypeDeclHandler = refuse
    try:
        parser.Parse(xml, True)
    except expat.ExpatError as error:
        raise FileError(f"its XML is broken at line {error.lineno}: {expat.ErrorString(error.code)}") from None


def _parsed(xml: bytes) -> tuple[dict[str, _Object], list[tuple[str, np.ndarray]], set[str]]:
    """The objects by their id, the build's items, and the kinds of elements that are not read."""
    objects: dict[str, _Object] = {}
    build: list[tuple[str, np.ndarray]] = []
    unread: set[str] = set()
    current: list[_Object] = []

    def start(tag: str, attributes: dict[str, str]) -> None:
        namespace, _, name = tag.rpartition(" ")
        try:
            if namespace not in ("", CORE):
                unread.add(shorten(name))
            elif name == "object":
                identity = attributes["id"]
                current[:] = [_Object(shorten(attributes.get("name") or f"object {identity}"))]
                objects[identity] = current[0]
            elif name == "vertex" and current:
                current[0].vertices.append((attributes["x"], attributes["y"], attributes["z"]))
            elif name == "triangle" and current:
                current[0].triangles.append((attributes["v1"], attributes["v2"], attributes["v3"]))
            elif name == "component" and current:
                current[0].components.append((attributes["objectid"], _transform(attributes)))
            elif name == "item":
                build.append((attributes["objectid"], _transform(attributes)))
            elif name == "basematerials":
                unread.add("basematerials")
        except KeyError as error:
            raise FileError(f"its <{shorten(name)}> lacks '{error.args[0]}'") from None

    def end(tag: str) -> None:
        if tag.rpartition(" ")[2] == "object":
            current.clear()

    _parse(xml, start, end)
    return objects, build, unread


def _transform(attributes: dict[str, str]) -> np.ndarray:
    """(4, 4) from the twelve numbers of a row-major matrix that multiplies row vectors from the right."""
    text = attributes.get("transform")
    if text is None:
        return np.eye(4)
    try:
        numbers = np.array(text.split(), float).reshape(4, 3)
    except ValueError:
        raise FileError(f"its transform '{shorten(text)}' is not twelve numbers") from None
    matrix = np.eye(4)
    matrix[:3] = numbers.T
    return matrix


def _part(one: _Object) -> Part:
    try:
        vertices = np.array(one.vertices, "S40").astype(np.float64).reshape(-1, 3)
        faces = np.array(one.triangles, "S20").astype(np.int64).reshape(-1, 3)
    except (ValueError, UnicodeEncodeError, OverflowError):
        raise FileError(f"its object '{one.name}' holds a vertex or triangle that is not made of numbers") from None
    return Part(vertices, faces, name=one.name)
