"""What a pixel knows of light: read off a frame (`reading`), drawn as lobes (`pictures`), by a click (`picker`)."""
