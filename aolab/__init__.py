"""aolab: a laboratory for ambient lighting in image space.

>>> import aolab
>>> frame = aolab.render("boxes", "ssao", radius=0.5)
>>> frame.save("boxes.png")

`__init__.pyi` lists the public names. A name is imported when it is first used; no import needs OpenGL.
"""

import sys

import lazy_loader

_imported, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)


def __getattr__(name: str) -> object:
    try:
        return _imported(name)
    except AttributeError:
        if name in __all__ or name.startswith("_"):
            raise
        from .errors import suggestion

        raise AttributeError(f"aolab has no '{name}'{suggestion(name, __all__)}", name=name) from None


if "IPython" in sys.modules and (_ipython := sys.modules["IPython"].get_ipython()):
    from . import interrupts
    from .notebook import completion

    interrupts.install(_ipython)
    completion.install(_ipython)
