"""The kinds of occluders, a file each. This table is all the registry there is."""

from .base import OccluderKind
from .depth import Depth
from .layers import Layers
from .product import Product
from .views import Views
from .voxels import Voxels

OCCLUDERS: dict[str, type[OccluderKind]] = {kind.name: kind for kind in (Depth, Layers, Views, Voxels)}

__all__ = ["OCCLUDERS", "Depth", "Layers", "OccluderKind", "Product", "Views", "Voxels"]
