"""Everything that talks to OpenGL: context, shader sources, programs, textures, geometry, timing."""
