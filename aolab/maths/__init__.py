"""Mathematics without scenes and without OpenGL."""
