"""`aolab scenes`."""

import json

from . import options


def scenes(as_json: options.Json = False) -> None:
    """List the scenes, their parameters and the defaults."""
    from ..loading import describe_scene, scene_names

    described = [describe_scene(name) for name in scene_names()]
    if as_json:
        print(
            json.dumps({scene.name: {"summary": scene.summary, "parameters": scene.parameters} for scene in described})
        )
        return
    for scene in described:
        parameters = "&".join(f"{key}={value}" for key, value in scene.parameters.items())
        print(f"{scene.name}{'?' if parameters else ''}{parameters}\n  {scene.summary}")
