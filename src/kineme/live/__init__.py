"""Streams: segment recordings while they are made.

`sources` yields rows, `intake` resamples them to frames, `stream` segments the recent past at
regular intervals (by `looking`), and `events` holds what is older than the delay. `storage` writes
rows to disk, `outputs` sends events to other programs.
"""

import lazy_loader

# ``__init__.pyi`` lists the names. They are loaded on use, as a stream imports the methods.
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
