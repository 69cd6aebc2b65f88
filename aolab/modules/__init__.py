"""The methods: one file each. This table is all the registry there is."""

from .base import Module, find
from .none import Unoccluded
from .ssao import SSAO
from .ssdo import SSDO

MODULES: dict[str, type[Module]] = {module.name: module for module in (Unoccluded, SSAO, SSDO)}

__all__ = ["MODULES", "SSAO", "SSDO", "Module", "Unoccluded", "find"]
