"""Convert segments and recordings to and from the objects of other libraries."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__, submodules=["adapters", "movement_dataset", "rerun_recording"]
)
