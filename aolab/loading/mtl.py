"""MTL, the materials of Wavefront OBJ: diffuse colour and its texture, opacity, emission, bumps.

Source: "MTL material format", Alias|Wavefront 1995. The format does not state a colour space: colours are taken as
sRGB, as web viewers take them.
"""

from dataclasses import dataclass, field
from typing import TypedDict

import numpy as np
from PIL import Image

from ..errors import Error, FileError, shorten
from ..input import Budget, TooLarge
from ..pictures.images import linear_from_srgb, read_image
from ..scene.environment import HALF_MAX
from ..scene.mesh import HeightMap, Material, Texture, Wrap
from .folder import Folder, decoded
from .materials import MASK_CUTOFF, alpha_drawn
from .parts import Notes

# options of a texture, and how many values they take; those of -o, -s and -t may be fewer
OPTIONS = {"-blendu": 1, "-blendv": 1, "-cc": 1, "-clamp": 1, "-imfchan": 1, "-mm": 2, "-bm": 1, "-boost": 1,
           "-texres": 1, "-type": 1, "-o": 3, "-s": 3, "-t": 3}  # fmt: skip
COLORS, MAPS = ("Kd", "Ke"), ("map_Kd", "map_d", "map_Ke")
BUMPS = ("norm", "map_bump", "map_Bump", "bump", "disp")  # the first one that is stated is used
READ = {*COLORS, *MAPS, *BUMPS, "d", "Tr"}
# ambient light, highlights and roughness: a diffuse surface has none
DIFFUSE_LACKS = {"Ka", "Ks", "Ns", "Ni", "illum", "sharpness", "Pr", "map_Ka", "map_Ks", "map_Ns", "map_Pr"}
COLORED = 8  # a picture whose channels differ by more than this, of 255 and on average, holds normals, not heights


@dataclass
class Paint:
    """A material, and the transform of its textures' coordinates: uv · scale + offset."""

    material: Material
    scale: np.ndarray = field(default_factory=lambda: np.ones(2))
    offset: np.ndarray = field(default_factory=lambda: np.zeros(2))
    is_default: bool = False

    @property
    def is_plain(self) -> bool:
        """Whether the surface has a colour and nothing else."""
        one = self.material
        maps = one.texture, one.emission_texture, one.normal_texture, one.height
        return all(each is None for each in maps) and one.alpha == 1 and not any(one.emission)


class Library:
    """The materials of the MTL files that an OBJ file names, each made when first used."""

    def __init__(self, folder: Folder, notes: Notes) -> None:
        self._folder, self._notes = folder, notes
        self._statements: dict[str, dict[str, str]] = {}
        self._paints: dict[str, Paint] = {}
        self._pixels: dict[str, np.ndarray | None] = {}
        self._textures: dict[tuple[object, ...], Texture] = {}

    def add(self, names: str) -> None:
        """The files of an `mtllib` line: one whose name may hold spaces, or several."""
        data = self._file(names, "material file", several=True)
        if data is not None:
            self._parse(decoded(data))

    def _file(self, name: str, kind: str, several: bool = False) -> bytes | None:
        """A file's contents; None, with a note, where it is missing or refused."""
        try:
            return self._folder.get(name)
        except TooLarge:
            raise
        except FileNotFoundError:
            if several and len(name.split()) > 1:
                for part in name.split():
                    self.add(part)
                return None
            self._notes.add(f"its {kind} ", f"'{shorten(name)}'", " is missing; drawn without")
        except FileError as error:
            self._notes.add(f"its {kind} ", str(error), "; drawn without")
        return None

    def _parse(self, text: str) -> None:
        current: dict[str, str] = {}
        for line in text.split("\n"):
            keyword, _, rest = line.partition("#")[0].strip().replace("\t", " ").partition(" ")
            if keyword == "newmtl":
                current = self._statements[rest.strip()] = {}
            elif keyword:
                current[keyword] = rest.strip()

    def paint(self, name: str) -> Paint:
        """A material by its name; "" is none, and an unknown name, too, gives the default, with a note."""
        if name not in self._paints:
            if name and name not in self._statements:
                self._notes.add("material ", f"'{shorten(name)}'", " is not defined; drawn in the default grey")
            known = name in self._statements
            self._paints[name] = (
                self._made(name, self._statements[name]) if known else Paint(Material(), is_default=True)
            )
        return self._paints[name]

    def _made(self, name: str, stated: dict[str, str]) -> Paint:
        shown = f"'{shorten(name)}'"
        for key in stated.keys() - READ - DIFFUSE_LACKS:
            if any(_floats(stated[key])) or not _floats(stated[key]):
                self._notes.add("read, but not used: ", shorten(key))
        maps = {key: _map(stated[key]) for key in MAPS if key in stated}
        diffuse, opacity = maps.get("map_Kd"), maps.get("map_d")
        color, glow = (self._color(stated[key], shown, key) if key in stated else None for key in COLORS)
        picture = None if diffuse is None else self._picture(diffuse.name)
        mask = None if opacity is None else self._picture(opacity.name)
        pixels, alpha = _with_alpha(picture, mask, self._folder.budget), self._alpha(stated, shown)
        mode = "MASK" if pixels is not None and pixels[..., 3].min() < 255 else None
        used = diffuse or opacity or maps.get("map_Ke") or _Map("")
        shining = None if "map_Ke" not in maps else self._picture(maps["map_Ke"].name)
        if color is None:
            color = (1.0, 1.0, 1.0) if pixels is not None else Material().base_color
        emission = glow or ((1.0, 1.0, 1.0) if shining is not None else (0.0, 0.0, 0.0))
        material = Material(
            base_color=tuple(np.clip(color, 0, 1).tolist()),
            texture=None if pixels is None else self._texture(pixels, used, diffuse or used),
            alpha=alpha,
            name=shorten(name),
            **alpha_drawn("BLEND" if alpha < 1 else mode, MASK_CUTOFF, shown, self._notes),
            emission=emission,
            emission_texture=None if shining is None or not any(emission) else self._texture(shining, used, used),
            **self._relief(stated, None if used == _Map("") else used, shown),
        )
        if used == _Map(""):
            used = next((_map(stated[key]) for key in BUMPS if key in stated), used)
        return Paint(material, np.array(used.scale), np.array(used.offset))

    def _relief(self, stated: dict[str, str], used: "_Map | None", material: str) -> "Relief":
        """A height map, in units of the model, or a normal map: many programs write normal maps as `map_bump`.

        `used` is the map whose transform the coordinates have; a bump map with another one is left out, with a note.
        """
        key = next((key for key in BUMPS if key in stated), None)
        if key is None:
            return {}
        bump = _map(stated[key])
        if used is not None and (bump.scale, bump.offset) != (used.scale, used.offset):
            self._notes.add(f"{key} of material ", material, " was left out, as its UV are not those of the colour's")
            return {}
        pixels = self._picture(bump.name)
        if pixels is None:
            return {}
        if key == "norm" or np.abs(np.diff(pixels[..., :3].astype(np.int16), axis=2)).mean() > COLORED:
            return {"normal_texture": self._texture(pixels, bump, bump), "normal_scale": bump.strength}
        heights = (bump.base + bump.gain * pixels[..., :3].mean(axis=2, dtype=np.float32) / 255) * bump.strength
        wrap: Wrap = "clamp" if bump.clamp else "repeat"
        return {"height": HeightMap(heights, shorten(bump.name), (wrap, wrap))}

    def _texture(self, pixels: np.ndarray, used: "_Map", named: "_Map") -> Texture:
        wrap: Wrap = "clamp" if used.clamp else "repeat"
        key = (id(pixels), wrap)
        if key not in self._textures:
            self._textures[key] = Texture(pixels, shorten(named.name), wrap=(wrap, wrap))
        return self._textures[key]

    def _color(self, text: str, material: str, key: str) -> tuple[float, float, float] | None:
        """Linear RGB; None, with a note, for a statement that is no colour."""
        values = _floats(text)
        if len(values) == 1:  # red alone stands for all three
            values *= 3
        if len(values) < 3 or not np.isfinite(values[:3]).all():
            self._notes.add(f"{key} of material ", material, f" is '{shorten(text)}', no colour; left out")
            return None
        if key == "Kd" and not all(0 <= value <= 1 for value in values[:3]):
            self._notes.add("Kd of material ", material, " is outside [0, 1], and was clipped")
        stated = np.clip(values[:3], 0, HALF_MAX)
        red, green, blue = np.where(stated > 1, stated, linear_from_srgb(stated)).tolist()  # Ke is not limited by 1
        return red, green, blue

    def _alpha(self, stated: dict[str, str], material: str) -> float:
        """`d`, or 1 - `Tr`; 1 where neither is a number, and for a `Tr` of 1, by which some programs mean opaque."""
        for key in ("d", "Tr"):
            values = _floats(stated.get(key, "").replace("-halo", ""))
            if values and np.isfinite(values[0]):
                alpha = float(np.clip(values[0] if key == "d" else 1 - values[0], 0, 1))
                return 1.0 if key == "Tr" and alpha == 0 else alpha
            if key in stated:
                self._notes.add(f"{key} of material ", material, f" is '{shorten(stated[key])}', no number; left out")
        return 1.0

    def _picture(self, name: str) -> np.ndarray | None:
        """(H, W, 4) uint8; None, with a note, for a texture that cannot be read."""
        if name not in self._pixels:
            data = self._file(name, "texture")
            try:
                self._pixels[name] = None if data is None else read_image(data, name, budget=self._folder.budget)
            except TooLarge:
                raise
            except Error as error:
                self._notes.add("its texture: ", str(error), "; drawn without")
                self._pixels[name] = None
        return self._pixels[name]


@dataclass
class _Map:
    """A texture's statement: its file's name and the options that are used."""

    name: str
    scale: tuple[float, float] = (1.0, 1.0)
    offset: tuple[float, float] = (0.0, 0.0)
    clamp: bool = False
    strength: float = 1.0  # -bm
    base: float = 0.0  # -mm base gain: base + gain × value
    gain: float = 1.0


class Relief(TypedDict, total=False):
    """The bump map of a material: arguments of `Material`."""

    normal_texture: Texture
    normal_scale: float
    height: HeightMap


def _map(text: str) -> _Map:
    """Options stand before the file's name, which may hold spaces."""
    found = _Map("")
    words = text.split(" ")
    while words and words[0] in ("", *OPTIONS):
        option = words.pop(0)
        if not option:
            continue
        values: list[str] = []
        while words and len(values) < OPTIONS[option] and (option not in ("-o", "-s", "-t") or _floats(words[0])):
            values.append(words.pop(0))
        numbers = [*_floats(" ".join(values)), *((1.0, 1.0) if option == "-s" else (0.0, 0.0))]
        if option == "-s":
            found.scale = numbers[0], numbers[1] if len(values) > 1 else 1.0
        elif option == "-o":
            found.offset = numbers[0], numbers[1] if len(values) > 1 else 0.0
        elif option == "-clamp":
            found.clamp = values == ["on"]
        elif option == "-bm" and (strength := _floats(" ".join(values))) and np.isfinite(strength[0]):
            found.strength = strength[0]
        elif option == "-mm" and len(range_of := _floats(" ".join(values))) == 2 and np.isfinite(range_of).all():
            found.base, found.gain = range_of
    found.name = " ".join(words).strip().strip('"')
    return found


def _floats(text: str) -> list[float]:
    """The numbers that a text begins with."""
    numbers = []
    for word in text.split():
        try:
            numbers.append(float(word))
        except ValueError:
            break
    return numbers


def _with_alpha(picture: np.ndarray | None, mask: np.ndarray | None, budget: Budget) -> np.ndarray | None:
    """The picture with the mask as its alpha: the mask's own alpha where it has one, else its brightness.

    Of different sizes the greater one holds, in width and in height: a mask in fewer texels would lose its holes.
    """
    if mask is None or mask is picture:
        return picture
    alpha = mask[..., 3] if mask[..., 3].min() < 255 else mask[..., :3].mean(axis=2).round().astype(np.uint8)
    if picture is None:
        white = np.full_like(alpha, 255)
        return np.dstack([white, white, white, alpha])
    height, width = np.maximum(alpha.shape, picture.shape[:2]).tolist()
    budget.take(4 * width * height, "a texture with its mask")
    color = Image.fromarray(picture).convert("RGB").resize((width, height), Image.Resampling.BILINEAR)
    holes = Image.fromarray(alpha).resize((width, height), Image.Resampling.BILINEAR)
    return np.dstack([np.asarray(color), np.asarray(holes)])
