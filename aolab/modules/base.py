"""What a module is: parameters, what it gives, and its passes. No GL in here."""

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal, Self, TypeVar

from pydantic import Field

from ..errors import ParameterError, suggestion
from ..gl.source import Constant
from ..scene.scene import Scene
from .parameters import AUTO, Parameters, parameter
from .passes import AMBIENT, DIRECT, Estimate, Pass, reflect
from .question import Question
from .readable import Readable

if TYPE_CHECKING:
    import numpy as np

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

# of methods that bounce light from what blocks: glsl/lib/senders.glsl
Bleeding = Annotated[
    float, Field(ge=0, le=16, description="Strength of the bounce: scales the area of a sender, π radius² / N.")
]
DistanceClamp = Annotated[
    Annotated[float, Field(gt=0)] | Literal["auto"],
    Field(
        description="Least distance of a sender; auto is the radius of its patch, radius / √N.",
        json_schema_extra={"unit": "scene units"},
    ),
]
Senders = Annotated[
    Literal["patches", "rays"],
    Field(description="What an occluder sends: a patch of area A_s at its distance, or its share of directions."),
]

AUTO_RADIUS_SHARES = (0.02, 0.1)  # of the scene's radius: over a few pixels, and not across the room


def auto_radius(scene: Scene) -> float:
    """A first value for the radius of occlusion, to two digits: the mean distance between two local maxima of the
    geometry (SSDO 2009, section 7.2), but at least 2 % and at most 10 % of the scene's radius.

    Two digits, so that the small changes of an animated scene leave it as it is.
    """
    low, high = (share * scene.radius for share in AUTO_RADIUS_SHARES)
    return float(f"{min(max(scene.feature_distance or high, low), high):.2g}")


SCALES = (0.125, 1.0)


class Module(Parameters):
    """A method. A subclass states its fields with `parameter(...)`, and these facts:

    `name` (lower case), `title`, `paper` (citation), `shader` (a file under glsl/, or GLSL text), `outputs` (buffer:
    format), `derived` (name: function of the frame and of "" or "_raw", for what is read off its outputs). `lit` says
    that the estimate itself reads the environment, so that new light asks for a new estimate.
    A module gives `visibility`, and may give `irradiance`, the environment's with occlusion: the lighting reflects it
    in place of its own. A shader's `const int x;` and `uniform float x;` are filled with the parameter `x`.
    """

    name: ClassVar[str] = ""
    title: ClassVar[str] = ""
    paper: ClassVar[str] = ""
    shader: ClassVar[str] = ""
    outputs: ClassVar[Mapping[str, str]] = {"visibility": "R16F"}
    derived: ClassVar[Mapping[str, "Callable[[Readable, str], np.ndarray]"]] = {}
    lit: ClassVar[bool] = False

    occluders: Literal["depth", "layers", "views"] = parameter(
        "depth", "What is tested for blocking: the camera's depth, `layers` of it, peeled, or further `views`."
    )
    layers: int = parameter(4, "Depth layers, where those are the occluders: two make a solid.", ge=2, le=4)
    views: int = parameter(4, "Cameras beside the camera, where those are the occluders.", ge=1, le=4)
    view_scale: float = parameter(0.5, "Resolution of the further views, as a share of the image's.", ge=0.125, le=1)
    view_layers: int = parameter(1, "Peeled layers of each further view.", ge=1, le=4)
    filter: Literal["none", "box4", "bilateral"] = parameter(
        "box4", "Noise removal: the mean of 4×4 pixels, or a separable 8×8 bilateral; both stay on the same surface."
    )
    scale: float = parameter(
        1.0,
        "Resolution of the estimate as a share of the image's, brought up by joint bilateral upsampling.",
        ge=SCALES[0],
        le=SCALES[1],
    )

    def constants(self) -> dict[str, Constant]:
        """Parameters that a shader may take as compile-time values."""
        return {key: value for key, value in self.model_dump().items() if isinstance(value, (bool, int, float))}

    def passes(self) -> list[Pass]:
        """The estimate's passes, in order; their outputs are filtered and upsampled afterwards."""
        return [Pass(self.name or type(self).__name__, self.shader, self.outputs)]

    def estimate(self) -> Estimate:
        """What is computed from the surfaces, before any lighting."""
        return Estimate(self.passes(), self.outputs)

    def lighting(self) -> list[Pass]:
        """What lights the surfaces once the estimate is known: passes that give `direct` and `ambient` radiance."""
        return [DIRECT, reflect("irradiance", "ambient") if "irradiance" in self.outputs else AMBIENT]

    def bounce(self) -> Estimate | None:
        """What is computed from the lit surfaces (`sender`, RGB radiance): `bounce`, an irradiance; or nothing."""
        return None

    def sends(self) -> bool:
        """Whether what blocks is asked for its light or albedo; then hidden surfaces are drawn with theirs."""
        return self.bounce() is not None

    def tables(self) -> "Mapping[str, Table]":
        """Textures that are made of the environment, by the name of their sampler."""
        return {}

    def samples(self, seed: int) -> dict[str, bytes]:
        """Uniform arrays that depend on the seed; another seed is another sample set."""
        return {}

    def question(self) -> Question:
        """The quantity that a `resolved` module approximates: `aolab.reference(scene, like=module)` computes it."""
        values = self.model_dump()
        return Question(values.get("radius"), values.get("falloff", 0.0), limited_senders=True)

    def resolved(self, scene: Scene) -> Self:
        """The same with every `auto` made a number for this scene."""
        if getattr(self, "radius", None) == AUTO:
            return self.replace(radius=auto_radius(scene))
        return self


Bouncing = TypeVar("Bouncing", bound=Module)


def with_distance_clamp(module: Bouncing) -> Bouncing:
    """The resolved module with an `auto` distance clamp made the radius of a patch: π d² = π radius² / N."""
    values = module.model_dump()
    if values["distance_clamp"] != AUTO:
        return module
    return module.replace(distance_clamp=values["radius"] / values["directions"] ** 0.5)


def find(module: "str | Module | type[Module]", modules: Mapping[str, type[Module]], **parameters: object) -> Module:
    """A module by name, class or instance, with these parameters. Raises `ParameterError` for an unknown one."""
    if isinstance(module, Module):
        return module.replace(**parameters) if parameters else module
    if isinstance(module, str):
        if module not in modules:
            raise ParameterError(f"no module '{module}'{suggestion(module, modules)}")
        module = modules[module]
    return module(**parameters)  # pyright: ignore[reportArgumentType]  # pydantic checks them
