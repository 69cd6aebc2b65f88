"""S3HO: Herholz, Schairer, Schilling and Straßer 2012, "Screen Space Spherical Harmonic Occlusion".

Each function takes the size of a picture, or of the table's measurement, and returns a `Figure`. Figures 2 and 4 are
drawings, of what `aolab.glyph` shows for any pixel.
"""

from collections.abc import Callable

from ..figure import Figure
from .atrium import fig1, fig9
from .cost import table1
from .light import fig3, fig5, fig6
from .probe import fig7, fig8

FIGURES: dict[str, Callable[..., Figure]] = {
    "fig1": fig1,
    "fig3": fig3,
    "fig5": fig5,
    "fig6": fig6,
    "fig7": fig7,
    "fig8": fig8,
    "fig9": fig9,
    "table1": table1,
}
