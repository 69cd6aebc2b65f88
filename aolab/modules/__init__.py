"""The methods: one file each. This table is all the registry there is."""

from .base import Module, find
from .buffers import BUFFERS, Buffer
from .none import Unoccluded
from .s3ho import S3HO
from .ssao import SSAO
from .ssbn import SSBN
from .ssdo import SSDO

MODULES: dict[str, type[Module]] = {module.name: module for module in (Unoccluded, SSAO, SSDO, S3HO, SSBN)}


def known_buffers() -> dict[str, Buffer]:
    """The table of buffers with the rows of all modules."""
    return BUFFERS | {row.name: row for module in MODULES.values() for row in module.buffers}


__all__ = ["MODULES", "S3HO", "SSAO", "SSBN", "SSDO", "Module", "Unoccluded", "find", "known_buffers"]
