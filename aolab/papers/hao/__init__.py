"""HAO: Reinbothe, Boubekeur and Alexa 2009, "Hybrid Ambient Occlusion".

Each function takes the size of a picture, or of its measurement, and returns a `Figure`. Table 1 holds the settings:
`TABLE_1` in settings.py. Figures 1 and 3 are drawings of the method.
"""

from collections.abc import Callable

from ..figure import Figure
from .fig2 import fig2
from .fig4 import fig4
from .fig5 import fig5
from .fig6 import fig6
from .fig7 import fig7
from .fig8 import fig8
from .fig9 import fig9

FIGURES: dict[str, Callable[..., Figure]] = {
    "fig2": fig2,
    "fig4": fig4,
    "fig5": fig5,
    "fig6": fig6,
    "fig7": fig7,
    "fig8": fig8,
    "fig9": fig9,
}
