"""aolab: a laboratory for ambient lighting in image space.

>>> import aolab
>>> frame = aolab.render("boxes", "ssao", radius=0.5)
>>> frame.save("boxes.png")

What is public stands in `__init__.pyi`; each name is imported when first used, and none of them touches OpenGL.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
