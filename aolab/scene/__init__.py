"""The contents of a scene: meshes, camera, lights, environment."""
