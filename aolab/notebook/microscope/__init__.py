"""`aolab.microscope`: the samples of one pixel, computed again in NumPy.

The twin of a shader (`twins.py`) computes its samples from the shader's own inputs (`inputs.py`). Every twin returns
`Samples`, so that one text and one picture show them all.
"""

from .pixel import Microscope, microscope
from .sampled import Sampled
from .samples import Samples

__all__ = ["Microscope", "Sampled", "Samples", "microscope"]
