"""SSDO: Ritschel, Grosch and Seidel 2009, "Approximating Dynamic Global Illumination in Image Space".

Each function takes the size of a picture, or of the table's largest picture, and returns a `Figure`. Figures 2, 5 and 8
are drawings.
"""

from collections.abc import Callable

from ..figure import Figure
from .fig1 import fig1
from .fig3 import fig3
from .fig4 import fig4
from .fig6 import fig6
from .fig7 import fig7
from .fig9 import fig9
from .fig10 import fig10
from .fig11 import fig11
from .fig12 import fig12
from .fig13 import fig13
from .fig14 import fig14
from .table1 import table1

FIGURES: dict[str, Callable[..., Figure]] = {
    "fig1": fig1,
    "fig3": fig3,
    "fig4": fig4,
    "fig6": fig6,
    "fig7": fig7,
    "fig9": fig9,
    "fig10": fig10,
    "fig11": fig11,
    "fig12": fig12,
    "fig13": fig13,
    "fig14": fig14,
    "table1": table1,
}
