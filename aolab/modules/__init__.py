"""The methods: one file each. This table is all the registry there is. `aolab.modules()` lists it."""

import sys
from types import ModuleType
from typing import Literal

from ..pictures.html import Listing
from .ambient_transfer import AmbientTransfer
from .base import Module
from .buffers import BUFFERS, Buffer
from .find import find
from .hao import HAO
from .none import Unoccluded
from .rotated_ssao import RotatedSSAO
from .rsm import RSM
from .s3ho import S3HO
from .ssao import SSAO
from .ssbn import SSBN
from .ssdo import SSDO
from .virtual_lights import EnvironmentVPL, InstantRadiosity
from .voxel_view import VoxelView

MODULES: dict[str, type[Module]] = {
    module.name: module
    for module in (
        Unoccluded,
        SSAO,
        SSDO,
        HAO,
        S3HO,
        SSBN,
        AmbientTransfer,
        RotatedSSAO,
        RSM,
        EnvironmentVPL,
        InstantRadiosity,
    )
}


def known_buffers() -> dict[str, Buffer]:
    """The table of buffers with the rows of all modules."""
    return BUFFERS | {row.name: row for module in MODULES.values() for row in module.buffers}


# the same names, for editors; a test compares them
ModuleName = Literal[
    "none",
    "ssao",
    "ssdo",
    "hao",
    "s3ho",
    "ssbn",
    "ambient_transfer",
    "rotated_ssao",
    "rsm",
    "environment_vpl",
    "instant_radiosity",
]


class _Callable(ModuleType):
    def __call__(self) -> Listing:
        """The names of the modules and their titles; a notebook shows a table."""
        return Listing("module", {name: module.title for name, module in MODULES.items()})


sys.modules[__name__].__class__ = _Callable  # `aolab.modules` is this package, and has to be called like `aolab.scenes`

__all__ = [
    "HAO", "MODULES", "RSM", "S3HO", "SSAO", "SSBN", "SSDO", "AmbientTransfer", "EnvironmentVPL", "InstantRadiosity",
    "Module", "ModuleName", "RotatedSSAO", "Unoccluded", "VoxelView", "find", "known_buffers",
]  # fmt: skip
