"""RSM and SSAO: Chow 2014, "Reflective Shadow Maps and SSAO".

Each function takes the size of a picture, and returns a `Figure`. The article numbers its pictures 1 to 8, and then 7
to 10 again: `fig9` is the last row, the kernels.
"""

from collections.abc import Callable

from ..figure import Figure
from .fig1 import fig1
from .fig5 import fig5
from .fig7 import fig7
from .fig9 import fig9

FIGURES: dict[str, Callable[..., Figure]] = {"fig1": fig1, "fig5": fig5, "fig7": fig7, "fig9": fig9}
