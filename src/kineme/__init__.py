"""Cut recordings of human motion into activities, transitions and primitives.

    import kineme

    motion = kineme.read("86_10.amc")
    segments = kineme.segment(motion)
    for row in segments.activities:
        print(row.kind, row.start_s, row.stop_s, row.cluster)

Every public name is importable from here; each is loaded when first used.
"""

from importlib import import_module
from typing import Any

import lazy_loader

from kineme._util.parallel import choose_numba_cache
from kineme._version import __version__

choose_numba_cache()

_load, _, _names = lazy_loader.attach_stub(__name__, __file__)
__all__ = ["__version__", *_names]


def __getattr__(name: str) -> Any:
    # The package `cycles` can be called as the function that the stub names.
    return import_module("kineme.cycles") if name == "cycles" else _load(name)


def __dir__() -> list[str]:
    return __all__
