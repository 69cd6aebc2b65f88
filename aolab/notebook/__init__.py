"""Tools for Jupyter: the glyph of a pixel (`reading` computes it, `lobes` draws it), and a picker for a click."""
