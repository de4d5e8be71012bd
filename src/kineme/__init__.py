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

if TYPE_CHECKING:  # "as": exported, for type checkers
    from kineme.datasets import bundled_recording as bundled_recording
    from kineme.errors import (
        EndEffectorError as EndEffectorError,
        FileError as FileError,
        KinemeError as KinemeError,
        KinemeWarning as KinemeWarning,
        MissingDependencyError as MissingDependencyError,
        MotionError as MotionError,
        ParameterError as ParameterError,
        ReadError as ReadError,
        WriteError as WriteError,
    )
    from kineme.labels import (
        read_segments as read_segments,
        write_segments as write_segments,
    )
    from kineme.features import (
        end_effectors as end_effectors,
        mirror as mirror,
        mirror_features as mirror_features,
        pose_features as pose_features,
        stack as stack,
    )
    from kineme.features.bundling import bundle as bundle
    from kineme.formats import read as read, supported_formats as supported_formats, write as write
    from kineme.graph import (
        NeighborGraph as NeighborGraph,
        WarpingPaths as WarpingPaths,
        neighbor_graph as neighbor_graph,
        warping_paths as warping_paths,
    )
    from kineme.recordings.motion import (
        Motion as Motion,
        Provenance as Provenance,
        Skeleton as Skeleton,
    )
    from kineme.recordings.operations import resample as resample
    from kineme.plot import (
        compare as compare,
        plot_matrix as plot_matrix,
        plot_segmentation as plot_segmentation,
        plot_timeline as plot_timeline,
    )
    from kineme.report.page import write_report as write_report
    from kineme.methods.region_growing.analysis import Analysis as Analysis
    from kineme.segmentation.from_features import analyze as analyze
    from kineme.methods.presets import PRESETS as PRESETS, Preset as Preset
    from kineme.segments.segmentation import Segmentation as Segmentation
    from kineme.segmentation.segmenter import (
        segment as segment,
        segment_and_analysis as segment_and_analysis,
    )
    from kineme.segments.table import Segment as Segment, SegmentTable as SegmentTable
    from kineme.recordings.signals import Signals as Signals
    from kineme.formats.channels.reading import read_signals as read_signals
    from kineme.segmentation.signals import segment_signals as segment_signals
    from kineme.segmentation.estimator import Segmenter as Segmenter
    from kineme.synthesis import (
        MotionGraph as MotionGraph,
        motion_graph as motion_graph,
        synthesize as synthesize,
    )
    from kineme.transfer import (
        KnowledgeBase as KnowledgeBase,
        transfer_labels as transfer_labels,
    )

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
    "kineme.labels": ("read_segments", "write_segments"),
    "kineme.features": ("end_effectors", "mirror", "mirror_features", "pose_features", "stack"),
    "kineme.features.bundling": ("bundle",),
    "kineme.formats": ("read", "supported_formats", "write"),
    "kineme.graph": ("NeighborGraph", "WarpingPaths", "neighbor_graph", "warping_paths"),
    "kineme.recordings.motion": ("Motion", "Provenance", "Skeleton"),
    "kineme.recordings.operations": ("resample",),
    "kineme.plot": ("compare", "plot_matrix", "plot_segmentation", "plot_timeline"),
    "kineme.report.page": ("write_report",),
    "kineme.methods.region_growing.analysis": ("Analysis",),
    "kineme.segmentation.from_features": ("analyze",),
    "kineme.methods.presets": ("PRESETS", "Preset"),
    "kineme.segments.segmentation": ("Segmentation",),
    "kineme.segmentation.segmenter": ("segment", "segment_and_analysis"),
    "kineme.segments.table": ("Segment", "SegmentTable"),
    "kineme.recordings.signals": ("Signals",),
    "kineme.formats.channels.reading": ("read_signals",),
    "kineme.segmentation.signals": ("segment_signals",),
    "kineme.segmentation.estimator": ("Segmenter",),
    "kineme.synthesis": ("MotionGraph", "motion_graph", "synthesize"),
    "kineme.transfer": ("KnowledgeBase", "transfer_labels"),
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
