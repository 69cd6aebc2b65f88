"""All use of OpenGL."""
