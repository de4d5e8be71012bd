"""What the page of a library is told, and what it sends; see `kineme.web.messages`."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import UNSET, Meta, Struct, UnsetType

from kineme.web.messages import MotionHead
from kineme.web.requests import EditBase, Integer, Request, Text

MOST_EXAMPLES = 500
"""Examples, or counter-examples, of one search."""
Seconds = Annotated[float, Meta(ge=0, le=1e7)]
Path = Annotated[str, Meta(max_length=5000)]


class LibraryRecording(Struct, frozen=True, kw_only=True):
    """A recording of a library; ``id`` is what the studio opens it by, empty where it is gone."""

    recording: str
    id: str
    status: Literal["gone", "as found", "corrected", "checked"]
    vocabulary: str
    duration_s: float


class LibraryCluster(Struct, frozen=True, kw_only=True):
    """A cluster of a library, as `kineme.library.open_library.Cluster` tells it.

    ``recordings`` are places in the list of all; ``unsure`` counts those of single recordings that
    may as well be in another cluster.
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
    """A library: its recordings, its clusters, and what could not be read, with the reason.

    ``undo`` is the last edit of its clusters, in words, where that can be taken back.
    """

    folder: str
    hours: float
    recordings: list[LibraryRecording]
    clusters: list[LibraryCluster]
    failed: dict[str, str]
    undo: str


class LibraryHit(Struct, frozen=True, kw_only=True):
    """Where a recording is like an example; ``label`` is that of the cluster.

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
    """What a search found, the nearest first."""

    hits: list[LibraryHit]


class NamedHits(Struct, frozen=True, kw_only=True):
    """How many hits have the name now, and which have not, with the reason."""

    named: int
    left: list[str]


class LibraryFigure(Struct, frozen=True, kw_only=True):
    """A span of a recording to be drawn small: a motion, its numbers in base 64, or curves.

    Curves are those of the first channels, from 0 to 1.
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
    """What is searched for: any of the spans, or what is typical of a cluster; and unlike what."""

    like: Annotated[list[Span], Meta(max_length=MOST_EXAMPLES)]
    unlike: Annotated[list[Span], Meta(max_length=MOST_EXAMPLES)]
    threshold: Annotated[float, Meta(gt=0, le=10)]
    top: Annotated[int, Meta(ge=1, le=1000)]
    mirror: bool
    cluster: Integer | UnsetType = UNSET


class CallHits(Request, frozen=True, kw_only=True):
    """A name for the segments that hits show, each alone; an empty one takes it away."""

    name: Text
    hits: Annotated[list[Span], Meta(max_length=MOST_EXAMPLES)]


class CallCluster(EditBase, frozen=True, kw_only=True, tag="name"):
    """A name for a cluster of the library; an empty one takes it away."""

    cluster: Integer
    name: Text


class JoinClusters(EditBase, frozen=True, kw_only=True, tag="merge"):
    """Others become part of a cluster of the library, which keeps its number and name."""

    cluster: Integer
    others: list[Integer]


class PartCluster(EditBase, frozen=True, kw_only=True, tag="split"):
    """What a cluster of the library has in some recordings becomes a cluster of its own."""

    cluster: Integer
    recordings: list[Path]


class UndoEdit(EditBase, frozen=True, kw_only=True, tag="undo"):
    """Undo the last edit of the clusters of the library."""


LibraryEdit = CallCluster | JoinClusters | PartCluster | UndoEdit


class TablesRequest(Request, frozen=True, kw_only=True):
    """Saved tables take numbers and names of clusters from the library.

    Clusters that have another name keep it, unless ``names``: then they take it, too.
    """

    names: bool


class CallEverywhere(Request, frozen=True, kw_only=True):
    """What a cluster of one recording is called now holds for it in all recordings.

    In a library for the cluster of it; else for what is called ``before`` elsewhere.
    """

    recording: Text
    cluster: Integer
    before: Text
    label: Text


class TablesChanged(Struct, frozen=True, kw_only=True):
    """How many tables were changed, how many clusters keep another name, and what failed, why."""

    tables: int
    others: int
    left: list[str]
