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
    - a file: `.glb`, `.gltf`, `.obj` (with `.mtl`), `.ply`, `.stl`. What it refers to must lie in its own folder;
    - a `trimesh.Scene` or `trimesh.Trimesh`, a `pyrender.Scene`, or an `aolab.Scene`, which is returned as it is.

    What survives: node transforms, instances (a mesh placed twice is one `Mesh` in two `Instance`s), normals, UV,
    base colour and its texture, vertex colours, alpha masks, the first perspective camera (its clip planes are left
    to the scene), and the lights of glTF (KHR_lights_punctual: lux and candela are taken as irradiance and intensity
    as they are) and pyrender. A source with lights but no environment gets `Environment.sky()`, so that ambient light
    has something to show; one without both gets the default sky and sun.

    Raises `FileError` for an unknown scene and a file that is missing, corrupt or refused, `SceneError` for contents
    that cannot be drawn, `ParameterError` for an unknown parameter or source. What was left out or repaired is a
    `Notice`.
    """
    if isinstance(source, str) and (named := load_scene(source, parameters)) is not None:
        return named
    if parameters:
        given = ", ".join(parameters)
        raise ParameterError(f"parameters ({given}) are for the scenes of scenes/; {_describe(source)} takes none")
    if isinstance(source, Scene):
        return source
    if isinstance(source, (str, PathLike)):
        from .files import load_file

        return load_file(source)
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
    return (
        f"'{source}'" if isinstance(source, (str, PathLike)) else f"a {type(source).__module__}.{type(source).__name__}"
    )
