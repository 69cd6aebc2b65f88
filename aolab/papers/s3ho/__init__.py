"""S3HO: Herholz, Schairer, Schilling and Straßer 2012, "Screen Space Spherical Harmonic Occlusion".

Each function takes the size of a picture, or of the table's measurement, and returns a `Figure`. Figures 2 and 4 are
drawings of glyphs; `aolab.glyph` draws them for any pixel.
"""

from collections.abc import Callable

from ..figure import Figure
from .fig1 import fig1
from .fig3 import fig3
from .fig5 import fig5
from .fig6 import fig6
from .fig7 import fig7
from .fig8 import fig8
from .fig9 import fig9
from .table1 import table1

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
