"""The public names and their homes: read by type checkers, and by `kineme` itself."""

__version__: str

from . import (
    clips as clips,
)
from . import (
    datasets as datasets,
)
from . import (
    errors as errors,
)
from . import (
    evaluation as evaluation,
)
from . import (
    features as features,
)
from . import (
    formats as formats,
)
from . import (
    interop as interop,
)
from . import (
    labels as labels,
)
from . import (
    library as library,
)
from . import (
    live as live,
)
from . import (
    methods as methods,
)
from . import (
    plot as plot,
)
from . import (
    pose as pose,
)
from . import (
    recordings as recordings,
)
from . import (
    segments as segments,
)
from . import (
    synthesis as synthesis,
)
from . import (
    transfer as transfer,
)
from .cycles import (
    Cycles as Cycles,
)
from .cycles import (
    cycles as cycles,
)
from .datasets import (
    bundled_recording as bundled_recording,
)
from .errors import (
    EndEffectorError as EndEffectorError,
)
from .errors import (
    FileError as FileError,
)
from .errors import (
    KinemeError as KinemeError,
)
from .errors import (
    KinemeWarning as KinemeWarning,
)
from .errors import (
    MissingDependencyError as MissingDependencyError,
)
from .errors import (
    MotionError as MotionError,
)
from .errors import (
    ParameterError as ParameterError,
)
from .errors import (
    ReadError as ReadError,
)
from .errors import (
    WriteError as WriteError,
)
from .features import (
    end_effectors as end_effectors,
)
from .features import (
    mirror as mirror,
)
from .features import (
    mirror_features as mirror_features,
)
from .features import (
    pose_features as pose_features,
)
from .features import (
    stack as stack,
)
from .features.bundling import (
    bundle as bundle,
)
from .features.channels import (
    emg_envelope as emg_envelope,
)
from .formats import (
    read as read,
)
from .formats import (
    supported_formats as supported_formats,
)
from .formats import (
    write as write,
)
from .labels import (
    read_segments as read_segments,
)
from .labels import (
    write_segments as write_segments,
)
from .library import (
    Library as Library,
)
from .live import (
    Stream as Stream,
)
from .methods import (
    PRESETS as PRESETS,
)
from .methods import (
    Found as Found,
)
from .methods import (
    Preset as Preset,
)
from .methods.estimator import (
    Segmenter as Segmenter,
)
from .methods.region_growing.neighbors import (
    NeighborGraph as NeighborGraph,
)
from .methods.region_growing.neighbors import (
    neighbor_graph as neighbor_graph,
)
from .methods.region_growing.warping import (
    WarpingPaths as WarpingPaths,
)
from .methods.region_growing.warping import (
    warping_paths as warping_paths,
)
from .methods.segmenter import (
    analyze as analyze,
)
from .methods.segmenter import (
    segment as segment,
)
from .methods.segmenter import (
    segment_and_found as segment_and_found,
)
from .plot import (
    compare as compare,
)
from .plot import (
    plot_matrix as plot_matrix,
)
from .plot import (
    plot_segmentation as plot_segmentation,
)
from .plot import (
    plot_timeline as plot_timeline,
)
from .recordings import (
    Motion as Motion,
)
from .recordings import (
    Note as Note,
)
from .recordings import (
    Provenance as Provenance,
)
from .recordings import (
    Recording as Recording,
)
from .recordings import (
    Signals as Signals,
)
from .recordings import (
    Skeleton as Skeleton,
)
from .recordings.operations import (
    resample as resample,
)
from .recordings.samples import (
    as_signals as as_signals,
)
from .recordings.samples import (
    join_signals as join_signals,
)
from .report.page import (
    write_report as write_report,
)
from .segments.segmentation import (
    Segmentation as Segmentation,
)
from .segments.table import (
    Segment as Segment,
)
from .segments.table import (
    SegmentTable as SegmentTable,
)
from .synthesis import (
    MotionGraph as MotionGraph,
)
from .synthesis import (
    motion_graph as motion_graph,
)
from .synthesis import (
    synthesize as synthesize,
)
from .transfer import (
    KnowledgeBase as KnowledgeBase,
)
from .transfer import (
    transfer_labels as transfer_labels,
)
