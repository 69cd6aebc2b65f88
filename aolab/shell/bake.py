"""`aolab bake`."""

from pathlib import Path
from typing import Annotated

from typer import Argument, Option

from . import completion


def bake(
    scene: Annotated[
        str,
        Argument(
            metavar="SCENE",
            help="A scene by name, with parameters as in 'toasters?time=1.5', or a model file.",
            autocompletion=completion.scenes,
        ),
    ],
    output: Annotated[Path, Option("-o", "--output", metavar="FILE.glb", help="The glTF file to write.")] = Path(
        "baked.glb"
    ),
    rays: Annotated[int, Option(metavar="N", help="Rays for each vertex and texel, an even number.")] = 256,
    radius: Annotated[
        float | None, Option(metavar="LENGTH", help="Reach of occlusion, scene units. Default: the modules'.")
    ] = None,
    texels: Annotated[int, Option(metavar="N", help="Width and height of an occlusion texture, in texels.")] = 512,
    seed: Annotated[int, Option(metavar="N", help="Number of the set of random samples.")] = 0,
) -> None:
    """Bake ambient occlusion into a model, by rays.

    The file has the occlusion of each vertex, as vertex colours, and an occlusion texture for each mesh whose UV do not
    overlap.
    """
    from ..baking import bake as baked
    from ..baking import write_glb
    from ..output import check_writable

    check_writable(output)
    result = baked(scene, rays=rays, radius="auto" if radius is None else radius, texels=texels, seed=seed)
    write_glb(result, output)
    meshes = [instance.mesh for instance in result.instances]
    maps = sum(mesh.material.occlusion_texture is not None for mesh in meshes)
    vertices = sum(len(mesh.vertices) for mesh in meshes)
    print(f"{output}: {len(meshes)} meshes, {vertices} vertices, {maps} occlusion textures of {texels}x{texels}")
