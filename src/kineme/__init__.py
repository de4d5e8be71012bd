"""Cut recordings of human motion into activities, transitions and primitives.

    import kineme

    motion = kineme.read("86_10.amc")
    segments = kineme.segment(motion)
    for row in segments.activities:
        print(row.kind, row.start_s, row.stop_s, row.cluster)

Every public name is importable from here; each is loaded when first used.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from kineme._version import __version__

if TYPE_CHECKING:
    from kineme.datasets import bundled_recording
    from kineme.errors import (
        EndEffectorError,
        FileError,
        KinemeError,
        KinemeWarning,
        MissingDependencyError,
        MotionError,
        ParameterError,
        ReadError,
        WriteError,
    )
    from kineme.export import read_segments, write_segments
    from kineme.features import end_effectors, pose_features, stack
    from kineme.formats import read, supported_formats, write
    from kineme.graph import NeighborGraph, WarpingPaths, neighbor_graph, warping_paths
    from kineme.motion import Motion, Provenance, Skeleton
    from kineme.operations import resample
    from kineme.plot import plot_segmentation
    from kineme.segmentation.analysis import Analysis, analyze
    from kineme.segmentation.presets import PRESETS, Preset
    from kineme.segmentation.result import Segmentation
    from kineme.segmentation.segmenter import segment, segment_and_analysis
    from kineme.segmentation.table import Segment, SegmentTable

_HOMES = {
    "kineme.datasets": ("bundled_recording",),
    "kineme.errors": (
        "EndEffectorError",
        "FileError",
        "KinemeError",
        "KinemeWarning",
        "MissingDependencyError",
        "MotionError",
        "ParameterError",
        "ReadError",
        "WriteError",
    ),
    "kineme.export": ("read_segments", "write_segments"),
    "kineme.features": ("end_effectors", "pose_features", "stack"),
    "kineme.formats": ("read", "supported_formats", "write"),
    "kineme.graph": ("NeighborGraph", "WarpingPaths", "neighbor_graph", "warping_paths"),
    "kineme.motion": ("Motion", "Provenance", "Skeleton"),
    "kineme.operations": ("resample",),
    "kineme.plot": ("plot_segmentation",),
    "kineme.segmentation.analysis": ("Analysis", "analyze"),
    "kineme.segmentation.presets": ("PRESETS", "Preset"),
    "kineme.segmentation.result": ("Segmentation",),
    "kineme.segmentation.segmenter": ("segment", "segment_and_analysis"),
    "kineme.segmentation.table": ("Segment", "SegmentTable"),
}
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}

__all__ = ["__version__", *_HOME_OF]


def __getattr__(name: str) -> Any:
    if name not in _HOME_OF:
        raise AttributeError(f"module 'kineme' has no attribute {name!r}")
    value = getattr(import_module(_HOME_OF[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
