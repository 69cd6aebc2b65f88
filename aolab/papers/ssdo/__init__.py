"""SSDO: Ritschel, Grosch and Seidel 2009, "Approximating Dynamic Global Illumination in Image Space".

Each function takes the size of a picture, or of the table's largest one, and returns a `Figure`. Figures 2, 5 and 8
are drawings; 9 to 12 are about section 5, which is not part of the module.
"""

from collections.abc import Callable

from ..figure import Figure
from .cost import fig1, table1
from .hidden import fig6, fig7
from .light import fig3, fig4, fig13, fig14

FIGURES: dict[str, Callable[..., Figure]] = {
    "fig1": fig1,
    "fig3": fig3,
    "fig4": fig4,
    "fig6": fig6,
    "fig7": fig7,
    "fig13": fig13,
    "fig14": fig14,
    "table1": table1,
}
