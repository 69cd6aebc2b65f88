"""Names that shaders get from the pipeline: a module's parameters and outputs must not take them."""

from collections.abc import Iterable, Mapping

from ..errors import ParameterError
from ..gl.texture import FORMATS
from .buffers import BUFFERS, CONTRACT, LIT, ON_DEMAND, REFLECTIVE, SURFACES
from .filters import FILTERS
from .occluders import OCCLUDERS
from .parameters import Choice

# tests/pipeline/test_names.py compares these with the names that the pipeline gives
OWNERS: dict[str, tuple[str, ...]] = {
    "the view": (
        "ray_from_pixel", "pixel_from_ray", "texel_size", "view_region", "world_origin", "view_from_world",
        "world_from_view", "clip_from_view", "clip_from_world", "small_ray_from_pixel", "orthographic",
    ),
    "the lights": (
        "lights", "light_slots", "light_kind", "light_tile", "light_position", "light_direction", "light_color",
        "light_spot_cos", "suns_alone", "one_tile", "tile_from_world", "tile_place",
    ),
    "the display": ("exposure", "filmic_tone"),
    "the reflective shadow maps": ("rsm_tiles", "rsm_box"),
    "the virtual lights": ("first_light", "light_count"),
    "the environment": ("irradiance_sh", "view_environment_sh"),
    "the samples": ("kernel", "rsm_kernel", "line_start"),
    "the mesh": (
        "base_color", "alpha_cutoff", "blended", "mesh_number", "single_sided", "emission", "one_sided", "cut_outs",
        "textured", "vertex_colored", "normal_scale", "normal_mapped", "relief_number", "bent_normals", "is_smooth",
        "has_shares",
    ),
    "the reliefs": ("reliefs", "relief_region", "relief_wrap"),
    "the last frame": ("has_last", "last_from_view", "last_pixel_from_ray"),
}  # fmt: skip


def reserved() -> dict[str, str]:
    """{name: owner} of all uniforms and constants that the pipeline, the occluder kinds and the filters give."""
    owners = {name: owner for owner, names in OWNERS.items() for name in names}
    choices: list[type[Choice]] = [*OCCLUDERS.values(), *FILTERS.values()]
    for choice in choices:
        names = (*choice.model_fields, *getattr(choice, "uniforms", ()))
        owners |= dict.fromkeys(names, choice.label())
    return owners


def check_parameters(module: str, values: Iterable[str], attributes: Iterable[str]) -> None:
    """Raise `ParameterError` for parameters whose names are taken.

    `values` are the parameters that a shader may read: the pipeline must not give their names. `attributes` are the
    parameters that hide an attribute of the class Module.
    """
    owners = dict.fromkeys(attributes, "the class Module")
    owners |= {name: owner for name, owner in reserved().items() if name in set(values)}
    for name, owner in owners.items():
        raise ParameterError(
            f"{module}: the parameter '{name}' has a name that belongs to {owner}; rename the parameter"
        )


def check_outputs(module: str, outputs: Mapping[str, str]) -> None:
    """Raise `ParameterError` for an output whose name the pipeline fills, or whose format breaks the name's meaning."""
    if not isinstance(outputs, Mapping):
        raise ParameterError(
            f"{module}: outputs = {outputs!r:.80} maps no buffers to formats; write outputs = {{'visibility': 'R16F'}}"
        )
    owners = dict.fromkeys(SURFACES | ON_DEMAND, "the surfaces") | dict.fromkeys(LIT, "the lighting")
    owners |= dict.fromkeys(REFLECTIVE, "the reflective shadow maps")
    for name, format in outputs.items():
        plain = name.removesuffix("_raw")
        if plain in owners:
            raise ParameterError(
                f"{module}: the output '{name}' has a name that belongs to {owners[plain]}; rename the output"
            )
        if plain != name:
            raise ParameterError(f"{module}: the output '{name}' ends in '_raw', as unfiltered buffers do; rename it")
        if name in CONTRACT and format in FORMATS and FORMATS[format][0] < BUFFERS[name].channels:
            about = BUFFERS[name]
            raise ParameterError(
                f"{module}: the output '{name}' has the format {format}; the lighting reads {about.channels} channels "
                f"of it, as {about.format} has. {about.about} Rename the output if it is something else"
            )
