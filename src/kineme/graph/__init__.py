"""Which frames are similar, and which spans match: graph and warping paths.

Nothing here knows what a skeleton is: any array of frames × dims will do. Who needs the graph
alone, a picture say, does not wait until the code of the paths is compiled.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
