"""The parameters of a scene that is a file."""

from collections.abc import Mapping
from typing import Annotated, Literal
from urllib.parse import quote

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from ..errors import ParameterError, suggestion
from ..queries import parameters


class FileOptions(BaseModel):
    """The parameters of a scene that is a file, as keywords or in a query: `walk.glb?time=0.5&up_axis=z`."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    time: float | None = Field(None, description="The time of the file's animation in seconds; none is its rest pose.")
    animation: str | None = Field(None, description="The animation's name or number. Default: the first.")
    up_axis: Literal["y", "z"] | None = Field(
        None, description="The file's axis that points up. Default: y, and z for 3MF."
    )
    shadows: Annotated[int, Field(ge=0)] | None = Field(
        None, description="How many lights cast shadows at most, the file's first. Default: as many as possible."
    )
    memory: str | None = Field(
        None, description="The memory that the scene may take, as in 4GB. Default: AOLAB_MEMORY."
    )


def options_from(what: str, query: str, keywords: Mapping[str, object]) -> FileOptions:
    """The options in a query and in keywords. Raises `ParameterError` for an unknown, repeated or ill-typed one."""
    given: dict[str, object] = {}
    for key, value in [*parameters(what, query).items(), *keywords.items()]:
        if key in given:
            raise ParameterError(f"{what}: parameter '{key}' is given twice")
        if key not in FileOptions.model_fields:
            raise ParameterError(f"{what}: a file has no parameter '{key}'{suggestion(key, FileOptions.model_fields)}")
        given[key] = str(value) if key in ("animation", "memory") and value is not None else value
    try:
        return FileOptions(**given)  # type: ignore[arg-type]
    except ValidationError as error:
        first = error.errors()[0]
        key = str(first["loc"][0])
        text = FileOptions.model_fields[key].description
        raise ParameterError(f"{what}: {key} = {given[key]!r:.80} is not valid. {text}") from None


def query_of(options: FileOptions) -> str:
    """The options as a query, "?" before it; nothing where all are defaults."""
    given = options.model_dump(exclude_none=True)
    return "?" + "&".join(f"{key}={quote(str(value), safe=',+-.')}" for key, value in given.items()) if given else ""


def turned_up(axis: str) -> np.ndarray:
    """(4, 4): the pose that turns the `axis` upwards, to y."""
    pose = np.eye(4)
    if axis == "z":
        pose[:3, :3] = [[1, 0, 0], [0, 0, 1], [0, -1, 0]]
    return pose
