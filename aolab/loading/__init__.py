"""Scenes from elsewhere: `scenes/`, model files, trimesh, pyrender. Nothing heavy is imported before it is needed."""

from os import PathLike

from ..errors import ParameterError
from ..scene.scene import Scene
from .named import SceneDescription, describe_scene, load_scene, scene_names

__all__ = ["SceneDescription", "describe_scene", "load", "scene_names"]


def load(source: object, **parameters: object) -> Scene:
    """A `Scene` from nearly anything.

    `source` is one of

    - a scene of `scenes/` by name, with its parameters as keywords or in a query: `load("toasters", time=1.5)`,
      `load("toasters?time=1.5")`;
    - a file: `.glb`, `.gltf`, `.obj` (with `.mtl`), `.ply`, `.stl`, `.off`, `.3mf`, with parameters likewise:
      `load("walk.glb", time=0.5)`, `load("scan.ply?up_axis=z")`. Files that it refers to must lie in its own folder.
      `load("knot.glb")` finds the model that comes with aolab;
    - a `trimesh.Scene` or `trimesh.Trimesh`, a `pyrender.Scene`, or an `aolab.Scene`, which is returned as it is.

    A file's parameters: `time` (seconds) and `animation` (name or number) pose a glTF animation; `up_axis` ("y" or
    "z") is the axis that points up; `shadows` limits how many lights cast shadows; `memory` ("4GB") is how much the
    scene may take, 2 GB unless `AOLAB_MEMORY` is set.

    docs/files.md lists what is drawn of each format. A part that cannot be drawn is left out, or repaired, with a
    `Notice`. A source with lights but no environment gets `Environment.sky()`, so that ambient light has something to
    show; a source without both gets the default sky and sun.

    Raises `FileError` for an unknown scene and a file that is missing, corrupt or refused, `SceneError` where nothing
    can be drawn, `ParameterError` for an unknown parameter or source.
    """
    if isinstance(source, str) and (named := load_scene(source, parameters)) is not None:
        return named
    if isinstance(source, (str, PathLike)):
        from .files import load_file

        return load_file(source, parameters)
    if parameters:
        given = ", ".join(parameters)
        raise ParameterError(
            f"parameters ({given}) are for the scenes of scenes/ and for files; {_describe(source)} takes none"
        )
    if isinstance(source, Scene):
        return source
    packages = {base.__module__.partition(".")[0] for base in type(source).__mro__}
    if "trimesh" in packages:
        from .trimeshes import scene_from_trimesh

        return scene_from_trimesh(source)
    if "pyrender" in packages:
        from .pyrenders import scene_from_pyrender

        return scene_from_pyrender(source)
    raise ParameterError(
        f"cannot load {_describe(source)}; known: a name of scenes/, a file, a trimesh.Scene or Trimesh, "
        "a pyrender.Scene, an aolab.Scene"
    )


def _describe(source: object) -> str:
    return f"a {type(source).__module__}.{type(source).__name__}"
