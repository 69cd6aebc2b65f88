"""Ambient occlusion baked into a scene, by rays: for each vertex, and for each texel of meshes with UV."""

from .bake import bake
from .export import write_glb

__all__ = ["bake", "write_glb"]
