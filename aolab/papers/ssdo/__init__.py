"""SSDO: Ritschel, Grosch and Seidel 2009, "Approximating Dynamic Global Illumination in Image Space".

Each function takes the size of a picture, or of the table's largest picture, and returns a `Figure`. Figures 2, 5 and 8
are drawings; figures 9 to 12 belong to section 5, which the module does not implement.
"""

from collections.abc import Callable

from ..figure import Figure
from .fig1 import fig1
from .fig3 import fig3
from .fig4 import fig4
from .fig6 import fig6
from .fig7 import fig7
from .fig13 import fig13
from .fig14 import fig14
from .table1 import table1

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
