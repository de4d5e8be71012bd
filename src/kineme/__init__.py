"""Cut recordings of human motion into activities, transitions and primitives.

    import kineme

    motion = kineme.read("86_10.amc")
    segments = kineme.segment(motion)
    for row in segments.activities:
        print(row.kind, row.start_s, row.stop_s, row.cluster)

Every public name is importable from here; each is loaded when first used.
"""

import lazy_loader

from kineme._util.parallel import choose_numba_cache
from kineme._version import __version__

choose_numba_cache()

__getattr__, _, _names = lazy_loader.attach_stub(__name__, __file__)
__all__ = ["__version__", *_names]


def __dir__() -> list[str]:
    return __all__
