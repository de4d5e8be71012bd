"""Messages of the library page, received and sent; see `kineme.web.messages`."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import UNSET, Meta, Struct, UnsetType

from kineme.web.messages import MotionHead
from kineme.web.requests import EditBase, Integer, Request, Text

MOST_EXAMPLES = 500
"""Positive or negative examples of one search."""
Seconds = Annotated[float, Meta(ge=0, le=1e7)]
Path = Annotated[str, Meta(max_length=5000)]


class LibraryRecording(Struct, frozen=True, kw_only=True):
    """A recording of a library; ``id`` opens it in the studio and is empty if its file is gone."""

    recording: str
    id: str
    status: Literal["gone", "as found", "corrected", "checked"]
    vocabulary: str
    duration_s: float


class LibraryCluster(Struct, frozen=True, kw_only=True):
    """A cluster of a library; see `kineme.library.open_library.Cluster`.

    ``recordings`` are indices into the list of recordings. ``unsure`` counts its parts in single
    recordings that may belong to another cluster.
    """

    cluster: int
    label: str
    vocabulary: str
    recordings: list[int]
    activities: int
    repetitions: int
    seconds: float
    typical_s: float
    example: str
    start_s: float
    stop_s: float
    unsure: int


class LibraryState(Struct, frozen=True, kw_only=True):
    """A library: its recordings, its clusters, and files that could not be read, with the reason.

    ``undo`` describes the last edit of its clusters, if that can be undone.
    """

    folder: str
    hours: float
    recordings: list[LibraryRecording]
    clusters: list[LibraryCluster]
    failed: dict[str, str]
    undo: str


class LibraryHit(Struct, frozen=True, kw_only=True):
    """A match of a search; ``label`` is that of the cluster.

    ``name`` is that of the segment there, in the table beside the recording.
    """

    recording: str
    start_s: float
    stop_s: float
    distance: float
    cluster: int
    label: str
    name: str = ""


class LibraryHits(Struct, frozen=True, kw_only=True):
    """Matches of a search, the nearest first."""

    hits: list[LibraryHit]


class NamedHits(Struct, frozen=True, kw_only=True):
    """Number of hits that were named, and reasons for those that were not."""

    named: int
    left: list[str]


class LibraryFigure(Struct, frozen=True, kw_only=True):
    """A small figure of a span: a motion with its numbers in base 64, or curves.

    Curves are the first channels, scaled to 0 to 1.
    """

    motion: MotionHead | None
    numbers: str
    curves: list[list[float]]


class Span(Request, frozen=True, kw_only=True):
    """A span of a recording of the library."""

    recording: Path
    start_s: Seconds
    stop_s: Seconds


class SearchRequest(Request, frozen=True, kw_only=True):
    """Search for the spans in ``like`` or a cluster; leave out what is nearer to ``unlike``."""

    like: Annotated[list[Span], Meta(max_length=MOST_EXAMPLES)]
    unlike: Annotated[list[Span], Meta(max_length=MOST_EXAMPLES)]
    threshold: Annotated[float, Meta(gt=0, le=10)]
    top: Annotated[int, Meta(ge=1, le=1000)]
    mirror: bool
    cluster: Integer | UnsetType = UNSET


class CallHits(Request, frozen=True, kw_only=True):
    """Name the segments that hits show; an empty name removes the name."""

    name: Text
    hits: Annotated[list[Span], Meta(max_length=MOST_EXAMPLES)]


class CallCluster(EditBase, frozen=True, kw_only=True, tag="name"):
    """Name a cluster of the library; an empty name removes the name."""

    cluster: Integer
    name: Text


class JoinClusters(EditBase, frozen=True, kw_only=True, tag="merge"):
    """Merge other clusters into a cluster of the library, which keeps its number and name."""

    cluster: Integer
    others: list[Integer]


class PartCluster(EditBase, frozen=True, kw_only=True, tag="split"):
    """Move the part of a cluster in some recordings to a new cluster."""

    cluster: Integer
    recordings: list[Path]


class UndoEdit(EditBase, frozen=True, kw_only=True, tag="undo"):
    """Undo the last edit of the clusters of the library."""


LibraryEdit = CallCluster | JoinClusters | PartCluster | UndoEdit


class TablesRequest(Request, frozen=True, kw_only=True):
    """Update clusters and names of saved tables from the library.

    Clusters with a different name keep it unless ``names`` is true.
    """

    names: bool


class CallEverywhere(Request, frozen=True, kw_only=True):
    """Rename a cluster of one recording in all recordings.

    In a library, its library cluster is renamed; else everything called ``before``.
    """

    recording: Text
    cluster: Integer
    before: Text
    label: Text


class TablesChanged(Struct, frozen=True, kw_only=True):
    """Number of changed tables, number of clusters that kept another name, and failures."""

    tables: int
    others: int
    left: list[str]
