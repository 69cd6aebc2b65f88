"""The kinds of occluders, a file each. This table is all the registry there is."""

from .base import OccluderKind
from .depth import Depth
from .height import Height
from .layers import Layers
from .product import Product
from .views import Views
from .voxels import Voxels

OCCLUDERS: dict[str, type[OccluderKind]] = {kind.name: kind for kind in (Depth, Layers, Views, Voxels, Height)}

__all__ = ["OCCLUDERS", "Depth", "Height", "Layers", "OccluderKind", "Product", "Views", "Voxels"]
