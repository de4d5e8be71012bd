"""What the pages are told: one type per message, each of them plain JSON.

The report carries one :class:`Recording` inside its file; the studio's server
sends the same over HTTP. The TypeScript side of these types is made from this
page (``src/kineme/web/pages/src/messages.ts``); a test holds the two together.
"""

from __future__ import annotations

from typing import Any, Literal, NotRequired, TypedDict

Level = Literal["activity", "primitive"]
Kind = Literal["activity", "transition"]


class Segment(TypedDict):
    """A row of the segment table; ``score`` is null where there is none."""

    level: Level
    kind: Kind
    start_frame: int
    stop_frame: int
    start_s: float
    stop_s: float
    cluster: int
    activity: int
    label: str
    score: float | None


class Segments(TypedDict):
    """A segment table as its JSON file has it (``kineme.segments/1``)."""

    schema: str
    n_frames: int
    fps: float
    provenance: dict[str, Any]
    timings: dict[str, float]
    segments: list[Segment]


class MotionHead(TypedDict):
    """How to read the binary motion; see :mod:`kineme.web.display`.

    ``n_samples`` poses at ``sample_fps``; position of a joint in metres, y up:
    ``origin + step * integer``. ``heading`` is where the body looks at each
    sample: radians about y from +z towards +x; null where it is not known.
    ``effectors`` has the joint of ``left_ankle``, ``right_ankle``, ``head``,
    ``left_wrist``, ``right_wrist`` and ``pelvis``; it is empty without a body.
    """

    n_samples: int
    sample_fps: float
    joints: list[str]
    parents: list[int]
    bones: list[tuple[int, int]]
    origin: tuple[float, float, float]
    step: float
    heading: list[float] | None
    effectors: dict[str, int]


class MatrixHead(TypedDict):
    """The pyramid of self-similarity tiles; see :mod:`kineme.web.matrix`.

    Level 0 has one cell per sample of ``fps`` and ``sizes[0]`` cells a side;
    each next level halves that; the last is one tile. Tiles are square, ``tile``
    cells a side, the last of a row or column cut off at the end of the recording.
    A report has the tiles with row >= column only, the others being their mirror
    images; where ``band`` is a number, tiles of the finer levels farther than so
    many of their cells from the diagonal may be missing, too.
    """

    fps: float
    tile: int
    sizes: list[int]
    band: int | None


class Recording(TypedDict):
    """Everything a page needs of one recording but the binary parts."""

    id: str
    name: str
    n_frames: int
    fps: float
    motion: MotionHead | None
    matrix: MatrixHead
    segmentation: Segments
    revision: int
    can_undo: bool
    can_redo: bool
    saved: str
    warnings: list[str]


class Parameter(TypedDict):
    """A constant of a preset that the page offers to change."""

    name: str
    help: str
    value: float
    minimum: float
    maximum: float
    step: float
    unit: str


class PresetChoice(TypedDict):
    """A preset, and the few of its constants that matter most."""

    name: str
    help: str
    parameters: list[Parameter]


class Listing(TypedDict):
    """A recording of the folder, opened or not."""

    id: str
    name: str
    bytes: int
    corrected: bool


class FileChoice(TypedDict):
    """A file of the folder that an operation can take: a knowledge base, a label file."""

    id: str
    name: str


class ExportFormat(TypedDict):
    """A format segments can be written in."""

    name: str
    suffix: str
    help: str


class State(TypedDict):
    """What the studio offers: the first message a page asks for."""

    version: str
    folder: str
    recordings: list[Listing]
    presets: list[PresetChoice]
    default_preset: str
    knowledge_bases: list[FileChoice]
    annotations: list[FileChoice]
    export_formats: list[ExportFormat]


class MoveBorder(TypedDict):
    """The border at ``frame`` of a level goes to ``to``."""

    kind: Literal["move_border"]
    level: Level
    frame: int
    to: int


class Split(TypedDict):
    """A new border at ``frame``."""

    kind: Literal["split"]
    level: Level
    frame: int


class Merge(TypedDict):
    """The segments of ``[start_frame, stop_frame)`` become one."""

    kind: Literal["merge"]
    level: Level
    start_frame: int
    stop_frame: int


class DeleteBorder(TypedDict):
    """The two segments that meet at ``frame`` become one: the longer takes the other."""

    kind: Literal["delete_border"]
    level: Level
    frame: int


class NameSegment(TypedDict):
    """The segment that starts at ``frame`` gets a label; an empty one takes it away."""

    kind: Literal["name_segment"]
    level: Level
    frame: int
    label: str


class NameCluster(TypedDict):
    """All segments of a cluster, of both levels, get a label."""

    kind: Literal["name_cluster"]
    cluster: int
    label: str


class SetCluster(TypedDict):
    """The segment that starts at ``frame`` joins a cluster; -1: none."""

    kind: Literal["set_cluster"]
    level: Level
    frame: int
    cluster: int


class SetKind(TypedDict):
    """The segment that starts at ``frame`` is an activity, or a transition and in no cluster."""

    kind: Literal["set_kind"]
    level: Level
    frame: int
    to: Kind


class SegmentAgain(TypedDict):
    """The whole table anew, by a preset."""

    kind: Literal["segment"]
    preset: str
    parameters: dict[str, float]


class Transfer(TypedDict):
    """Labels from a knowledge base of the folder."""

    kind: Literal["transfer"]
    knowledge_base: str
    threshold: NotRequired[float]
    spread: NotRequired[bool]


class Undo(TypedDict):
    """The last edit is taken back."""

    kind: Literal["undo"]


class Redo(TypedDict):
    """The last edit taken back is done again."""

    kind: Literal["redo"]


Edit = (
    MoveBorder
    | Split
    | Merge
    | DeleteBorder
    | NameSegment
    | NameCluster
    | SetCluster
    | SetKind
    | SegmentAgain
    | Transfer
    | Undo
    | Redo
)


class EditRequest(TypedDict):
    """An edit of the table as it was at ``revision``."""

    revision: int
    edit: Edit


class Edited(TypedDict):
    """The table after an edit, already on the disk as ``saved``."""

    revision: int
    segmentation: Segments
    can_undo: bool
    can_redo: bool
    saved: str
    notes: list[str]


class CompareRequest(TypedDict):
    """Another result to lay beside the shown one: a preset's, or a file's of the folder."""

    preset: NotRequired[str]
    annotation: NotRequired[str]


class Comparison(TypedDict):
    """The other result, and how well the shown one agrees with it."""

    name: str
    segmentation: Segments
    scores: dict[str, float]


class Changed(TypedDict):
    """Sent to every page when a recording's table changed or a file came."""

    recording: str
    revision: int


class Failure(TypedDict):
    """Why a request was refused, in one sentence."""

    error: str
