"""aolab: a laboratory for ambient lighting in image space.

>>> import aolab
>>> frame = aolab.render("boxes", "ssao", radius=0.5)
>>> frame.save("boxes.png")

`__init__.pyi` lists the public names. A name is imported when it is first used; no import needs OpenGL.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
