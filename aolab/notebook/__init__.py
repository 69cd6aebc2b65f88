"""Tools for Jupyter: glyphs of a pixel (`reading`, drawn as `lobes`), and a picker that reads them by a click."""
