"""glTF 2.0, `.glb` and `.gltf`: from a file to the parts of a scene."""
