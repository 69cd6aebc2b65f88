"""The methods: one file each. This table is all the registry there is."""

from .base import Module, find
from .none import Unoccluded
from .s3ho import S3HO
from .ssao import SSAO
from .ssbn import SSBN
from .ssdo import SSDO

MODULES: dict[str, type[Module]] = {module.name: module for module in (Unoccluded, SSAO, SSDO, S3HO, SSBN)}

__all__ = ["MODULES", "S3HO", "SSAO", "SSBN", "SSDO", "Module", "Unoccluded", "find"]
