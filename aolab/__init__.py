"""aolab: a laboratory for ambient lighting in image space.

>>> import aolab
>>> frame = aolab.render("boxes", "ssao", radius=0.5)
>>> frame.save("boxes.png")

`__init__.pyi` lists the public names. A name is imported when it is first used; no import needs OpenGL.
"""

import sys

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)

if "IPython" in sys.modules and (_ipython := sys.modules["IPython"].get_ipython()):
    from . import interrupts
    from .notebook import completion

    interrupts.install(_ipython)
    completion.install(_ipython)
