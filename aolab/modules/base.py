"""Modules: their parameters, their outputs and their passes. No OpenGL in here."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Self, TypeVar

import numpy as np
from pydantic import ConfigDict, Field, WrapValidator

from ..errors import ParameterError
from ..gl.source import beside
from ..scene.scene import Scene
from .buffers import Buffer
from .estimate import Estimate, passes_of
from .filters import FILTERS, Filter
from .names import check_outputs, check_parameters
from .occluders import OCCLUDERS, OccluderKind
from .parameters import AUTO, Choice, Parameters, is_word, label, parameter, unknown
from .passes import AMBIENT, DIRECT, FILL, SHARED_DIRECT, Pass, reflect
from .question import Question
from .readable import Readable

if TYPE_CHECKING:
    from ..scene.prefiltered import Table

# Common parameters: one meaning everywhere (see "The face of the package" in the design)
Radius = Annotated[
    Annotated[float, Field(gt=0)] | Literal["auto"],
    Field(
        description="Reach of occlusion; auto is a first value from the distance between the geometry's local maxima.",
        json_schema_extra={"unit": "scene units"},
    ),
]
Directions = Annotated[int, Field(ge=1, le=256, description="Directions a pixel (N), one set in each of 4×4 pixels.")]
Steps = Annotated[int, Field(ge=1, le=64, description="Points along each direction; more of them approach a ray.")]
Bias = Annotated[
    float,
    Field(
        ge=0,
        le=1,
        description="Height over the tangent plane below which nothing blocks.",
        json_schema_extra={"unit": "radii"},
    ),
]
Falloff = Annotated[
    float,
    Field(
        ge=0,
        le=1,
        description="Outer share of the radius over which occluders fade out, by a smoothstep; 0 is a hard edge.",
    ),
]

Thickness = Annotated[
    float,
    Field(
        gt=0,
        le=10,
        description="Depth behind the visible surface that is taken to be solid: the range check.",
        json_schema_extra={"unit": "radii"},
    ),
]

# of methods that bounce light from occluders: glsl/lib/senders.glsl
Bleeding = Annotated[
    float, Field(ge=0, le=16, description="Strength of the bounce: a factor of the indirect light; 1 is physical.")
]
DistanceClamp = Annotated[
    Annotated[float, Field(gt=0)] | Literal["auto"],
    Field(
        description="Least distance of a patch; auto is the radius of its disc, radius / √N.",
        json_schema_extra={"unit": "scene units"},
    ),
]
Senders = Annotated[
    Literal["patches", "rays"],
    Field(
        description="Share of an occluder in the light: that of its direction (`rays`), or the form factor of a patch "
        "of area π radius² / N, as printed, which is more than the light that there is (`patches`)."
    ),
]

ShadowBias = Annotated[
    Annotated[float, Field(gt=0, le=64)] | Literal["none"],
    Field(
        description="Bias of shadow maps, as a multiple of half a texel times the slope; 6 covers the filter's reach, "
        "`none` shows acne.",
        json_schema_extra={"unit": "(p/2) tan α"},
    ),
]
ShadowResolution = Annotated[
    Annotated[int, Field(ge=16, le=8192)] | Literal["auto"],
    Field(
        description="Pixels a side of a shadow map; auto is 2048 for up to 4 maps, 1024 for up to 36, and then 512.",
        json_schema_extra={"unit": "pixels"},
    ),
]

AUTO_RADIUS_SHARES = (0.02, 0.1)  # of the scene's radius: over a few pixels, and not across the room


def auto_radius(scene: Scene) -> float:
    """A first value for the radius of occlusion, to two digits: the mean distance between two local maxima of the
    geometry (SSDO 2009, section 7.2), but at least 2 % and at most 10 % of the scene's radius.

    Two digits, so that the small changes of an animated scene leave it as it is. A few vertices far out do not count.
    """
    size = float(np.linalg.norm(np.ptp(scene.main_bounds, axis=0))) / 2
    low, high = (share * size for share in AUTO_RADIUS_SHARES)
    return float(f"{min(max(scene.feature_distance or high, low), high):.2g}")


SCALES = (0.125, 1.0)


def by_name(table: Mapping[str, type[Choice]], base: type[Choice]) -> Any:
    """A name of the table, or a choice of one's own; the JSON schema lists the names."""
    own = WrapValidator(lambda value, named: value if isinstance(value, base) else named(value))
    return Annotated[Literal[tuple(table)], own]  # pyright: ignore[reportInvalidTypeForm]


if TYPE_CHECKING:
    OccludersByName = str | OccluderKind
    FilterByName = str | Filter
else:
    OccludersByName = by_name(OCCLUDERS, OccluderKind)
    FilterByName = by_name(FILTERS, Filter)


OPENNESS = """
uniform sampler2D visibility;
float opennessAt(ivec2 pixel) { return texelFetch(visibility, pixel, 0).r; }
"""
OPEN = """
float opennessAt(ivec2 pixel) { return 1.0; }
"""


class Module(Parameters):
    """A method. A subclass states its fields with `parameter(...)`, and these facts:

    `name` (lower case), `title`, `paper` (citation), `shader` (a file under glsl/, GLSL text, or the path of a file of
    your own, relative to the Python file or to the working directory), `outputs` (buffer: format), `derived` (name:
    function of the frame and of "" or "_raw"; a buffer computed from the outputs). With `lit`, the estimate reads the
    environment, so that relighting computes it again. `buffers` describes outputs and derived buffers that the table of
    buffers lacks.
    The lighting multiplies ambient light by the output `visibility`. If there is an output `irradiance`, the
    environment's with occlusion, the lighting reflects that instead. A shader's `const int x;` and `uniform float x;`
    are filled with the parameter `x`.
    Raises `ParameterError`, when the class is made, for a parameter or an output whose name belongs to the pipeline.

    The parameters of the chosen occluder kind and filter are parameters of the module, too: `SSAO(occluders="layers",
    layers=3).layers` is 3.
    """

    model_config = ConfigDict(extra="allow")  # the parameters of choices; `prepared` refuses others

    name: ClassVar[str] = ""
    title: ClassVar[str] = ""
    paper: ClassVar[str] = ""
    shader: ClassVar[str | Path] = ""
    outputs: ClassVar[Mapping[str, str]] = {"visibility": "R16F"}
    derived: ClassVar[Mapping[str, "Callable[[Readable, str], np.ndarray]"]] = {}
    buffers: ClassVar[Sequence[Buffer]] = ()
    lit: ClassVar[bool] = False
    claims: ClassVar[str] = "visibility"  # the buffer by which the method differs from others: `aolab compare` takes it
    parts: ClassVar[Sequence[str]] = ()  # of other modules: see `combined.py`
    choices: ClassVar[Mapping[str, Mapping[str, type[Choice]]]] = {"occluders": OCCLUDERS, "filter": FILTERS}

    occluders: OccludersByName = parameter(
        "depth", "The data that is tested for blocking: the camera's depth, peeled `layers` of it, or further `views`."
    )
    filter: FilterByName = parameter(
        "box4", "Noise removal: the mean of 4×4 pixels, or a separable 8×8 bilateral; both stay on the same surface."
    )
    normals: Literal["shading", "geometric"] = parameter(
        "shading", "The normals of the estimate: bent by normal and height maps, or the vertices' own (`geometric`)."
    )
    scale: float = parameter(
        1.0,
        "Resolution of the estimate as a share of the image's, brought up by joint bilateral upsampling.",
        ge=SCALES[0],
        le=SCALES[1],
    )
    shadow_bias: ShadowBias = 6.0
    shadow_resolution: ShadowResolution = AUTO
    fill: int = parameter(
        0, "Samples in the gap that a shadow map's bias leaves: contact shadows; 0 is the map alone.", ge=0, le=64
    )

    @classmethod
    def __pydantic_init_subclass__(cls, **kwargs: Any) -> None:
        super().__pydantic_init_subclass__(**kwargs)
        cls.shader = beside(cls.shader, cls.__module__)
        own = [name for name in cls.model_fields if name not in Module.model_fields]
        check_parameters(
            label(cls),
            [name for name in own if not is_word(cls, name)],
            [name for name in own if hasattr(Module, name)],
        )
        check_outputs(label(cls), cls.outputs)

    @classmethod
    def stated(cls) -> dict[str, type[Parameters]]:
        of_choices = {
            name: choice for table in cls.choices.values() for choice in table.values() for name in choice.model_fields
        }
        return super().stated() | of_choices

    @classmethod
    def prepared(cls, values: dict[str, Any]) -> dict[str, Any]:
        """The values with all parameters of the chosen kinds. Raises `ParameterError` for one of another choice."""
        fields = cls.model_fields  # pydantic takes its time for each look
        own = {name: value for name, value in values.items() if name in fields}
        others = {name: value for name, value in values.items() if name not in own}
        for axis, table in cls.choices.items():
            chosen = own.get(axis, fields[axis].default)
            if isinstance(chosen, str) and chosen in table:
                chosen = table[chosen]()
            if isinstance(chosen, Choice):
                chosen = chosen.replace(**{name: others.pop(name) for name in [*others] if name in chosen.stated()})
                builtin = type(chosen) is table.get(chosen.name)
                own |= {axis: chosen.name, **chosen.values()} if builtin else {axis: chosen}
        for name, value in others.items():
            if name not in cls.stated():
                raise ParameterError(unknown(cls, name))
            choice = cls.stated()[name]
            assert issubclass(choice, Choice)
            now = own.get(choice.axis, cls.model_fields[choice.axis].default)
            raise ParameterError(
                f"{label(cls)}: {name} = {value!r} is a parameter of {choice.label()}; here {choice.axis} is "
                f"'{now if isinstance(now, str) else now.name}'"
            )
        return own

    def values(self) -> dict[str, Any]:
        """{name: value} of all parameters, those of the chosen kinds among them."""
        values = super().values()
        for axis in self.choices:
            chosen = self.chosen(axis)
            values |= {axis: chosen.name, **chosen.values()}
        return values

    @classmethod
    def model_json_schema(cls, *args: Any, **kwargs: Any) -> dict[str, Any]:
        """The JSON schema of the values. A parameter of a choice has the choice as `with`: {"occluders": "layers"}."""
        schema = super().model_json_schema(*args, **kwargs)
        schema["additionalProperties"] = False
        for name, choice in cls.stated().items():
            if issubclass(choice, Choice):
                about = choice.model_json_schema()["properties"][name]
                schema["properties"][name] = {**about, "with": {choice.axis: choice.name}}
        return schema

    def chosen(self, axis: str) -> Choice:
        """The occluder kind (`occluders`) or the filter (`filter`), with its parameters."""
        value = getattr(self, axis)
        if isinstance(value, Choice):
            return value
        choice = self.choices[axis][value]
        return choice(**{name: (self.model_extra or {})[name] for name in choice.model_fields})

    @classmethod
    def changed(cls, values: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
        """The values with some changed. Another choice drops the parameters of the choice before it."""
        if cls.choices.keys().isdisjoint(changes):
            return {**values, **changes}
        stated = cls.stated()
        dropped = {
            name
            for name in values
            if (choice := stated.get(name)) and issubclass(choice, Choice)
            if changes.get(choice.axis, values.get(choice.axis)) != values.get(choice.axis)
        }
        return {name: value for name, value in values.items() if name not in dropped} | dict(changes)

    def replace(self, **changes: object) -> Self:
        """The same with some values changed, validated again. Another choice starts with its own defaults."""
        values = {name: getattr(self, name) for name in type(self).model_fields} | (self.model_extra or {})
        return type(self)(**self.changed(values, changes))

    @property
    def occlusion_radius(self) -> float | None:
        """The radius of occlusion in scene units, of a resolved module; None where the method has none."""
        radius = getattr(self, "radius", None)
        return radius if isinstance(radius, (int, float)) else None

    @classmethod
    def has_radius(cls) -> bool:
        """Whether the method has a radius of occlusion."""
        return "radius" in cls.model_fields

    def passes(self) -> list[Pass]:
        """The estimate's passes, in order; their outputs are filtered and upsampled afterwards.

        Raises `ParameterError` for a module without a shader.
        """
        if not self.shader:
            raise ParameterError(
                f"{self.label()}: no shader; set `shader` to GLSL text or a file, or override passes()"
            )
        return [Pass(self.name or type(self).__name__, self.shader, self.outputs)]

    def estimate(self) -> Estimate:
        """The estimate: computed from the surfaces, before any lighting."""
        return Estimate(self.passes(), self.outputs)

    def lighting(self) -> Sequence[Pass | Estimate]:
        """The steps that light the surfaces after the estimate; they compute `direct` and `ambient` radiance.

        Each step may read the outputs of those before it. A step that takes samples is an `Estimate`.
        """
        if "irradiance" in self.outputs:
            return [*self.direct(), reflect("irradiance", "ambient")]
        return [*self.direct(), replace(AMBIENT, constants={"occluded": "visibility" in self.outputs})]

    def openness(self) -> str:
        """GLSL text with `float opennessAt(ivec2 pixel)`, the visibility in [0, 1]: it stands for "openness.glsl".

        A module without the output `visibility` returns its own.
        """
        return OPENNESS if "visibility" in self.outputs else OPEN

    def direct(self) -> Sequence[Pass]:
        """The passes of direct light: through shadow maps, and with `fill` also past the screen."""
        return [FILL, SHARED_DIRECT] if self.fill else [DIRECT]

    def bounce(self) -> Estimate | None:
        """An estimate over the lit surfaces (`sender`, RGB radiance) of `bounce`, an irradiance; None for no bounce."""
        return None

    def all_passes(self) -> list[Pass]:
        """Every pass of the estimate, the lighting and the bounce."""
        return passes_of([self.estimate(), *self.lighting(), *filter(None, [self.bounce()])])

    def sends(self) -> bool:
        """Whether the shaders read the light or albedo of occluders; then hidden surfaces are drawn with theirs."""
        return self.bounce() is not None

    def tables(self) -> "Mapping[str, Table]":
        """Textures computed from the environment, by the name of their sampler."""
        return {}

    def samples(self, seed: int) -> dict[str, bytes]:
        """Uniform arrays that depend on the seed; each seed is a sample set."""
        return {}

    def question(self) -> Question:
        """The quantity that a `resolved` module approximates: `aolab.reference(scene, like=module)` computes it."""
        values = self.values()
        return Question(values.get("radius"), values.get("falloff", 0.0), limited_senders=True, normals=self.normals)

    def resolved(self, scene: Scene) -> Self:
        """The module with a number for this scene in place of every `auto`."""
        if getattr(self, "radius", None) == AUTO:
            return self.replace(radius=auto_radius(scene))
        return self


Bouncing = TypeVar("Bouncing", bound=Module)


def with_distance_clamp(module: Bouncing) -> Bouncing:
    """The resolved module with an `auto` distance clamp made the radius of a patch: π d² = π radius² / N."""
    values = module.values()
    if values["distance_clamp"] != AUTO:
        return module
    return module.replace(distance_clamp=values["radius"] / values["directions"] ** 0.5)
