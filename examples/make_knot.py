"""Makes knot.glb: a trefoil knot on a plate, a small model file to try `aolab render MODEL` with."""

from pathlib import Path

import numpy as np
import trimesh
from trimesh.visual import TextureVisuals
from trimesh.visual.material import PBRMaterial

ALONG, AROUND, THICKNESS = 160, 14, 0.22


def knot() -> trimesh.Trimesh:
    """A tube along the trefoil knot (sin t + 2 sin 2t, -sin 3t, cos t - 2 cos 2t)."""
    t = np.linspace(0, 2 * np.pi, ALONG, endpoint=False)
    centre = np.stack([np.sin(t) + 2 * np.sin(2 * t), -np.sin(3 * t), np.cos(t) - 2 * np.cos(2 * t)], axis=1) * 0.4
    tangent = np.roll(centre, -1, axis=0) - np.roll(centre, 1, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    side = np.cross(tangent, (0, 1, 0))
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    up = np.cross(side, tangent)
    angle = np.linspace(0, 2 * np.pi, AROUND, endpoint=False)
    ring = np.cos(angle)[None, :, None] * side[:, None] + np.sin(angle)[None, :, None] * up[:, None]
    vertices = (centre[:, None] + THICKNESS * ring).reshape(-1, 3) + np.array((0, 0.62, 0))
    i, j = np.meshgrid(np.arange(ALONG), np.arange(AROUND), indexing="ij")
    corner = [((i + a) % ALONG) * AROUND + (j + b) % AROUND for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
    quads = np.stack(corner, axis=-1).reshape(-1, 4)
    tube = trimesh.Trimesh(vertices, np.concatenate([quads[:, (0, 1, 2)], quads[:, (0, 2, 3)]]), process=False)
    tube.fix_normals()
    return tube


def coloured(mesh: trimesh.Trimesh, name: str, color: tuple[float, float, float]) -> trimesh.Trimesh:
    material = PBRMaterial(name=name, baseColorFactor=[*color, 1.0], roughnessFactor=1.0)
    mesh.visual = TextureVisuals(material=material)
    return mesh


if __name__ == "__main__":
    plate = trimesh.creation.box((4.0, 0.1, 4.0), transform=trimesh.transformations.translation_matrix((0, -0.05, 0)))
    scene = trimesh.Scene()
    scene.add_geometry(coloured(knot(), "clay", (0.75, 0.32, 0.2)), geom_name="knot")
    scene.add_geometry(coloured(plate, "plaster", (0.8, 0.8, 0.78)), geom_name="plate")
    scene.export(Path(__file__).parents[1] / "scenes" / "knot.glb")
