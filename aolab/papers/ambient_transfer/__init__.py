"""Ambient transfer: Umenhoffer, Tóth and Szirmay-Kalos 2009, "Efficient Methods for Ambient Lighting".

Each function takes the size of a picture and returns a `Figure`. Figures 2, 3, 4 and 6 are drawings.
"""

from collections.abc import Callable

from ..figure import Figure
from .fig1 import fig1
from .fig5 import fig5
from .fig7 import fig7
from .fig8 import fig8
from .fig9 import fig9

FIGURES: dict[str, Callable[..., Figure]] = {"fig1": fig1, "fig5": fig5, "fig7": fig7, "fig8": fig8, "fig9": fig9}
