"""Mathematics. Nothing here depends on a scene or on OpenGL."""
