"""What the pages are told: one msgspec ``Struct`` a message, each of them plain JSON.

The report carries one `Recording` inside its file; the studio's server
sends the same over HTTP. What pages send is in `kineme.web.requests`; the
TypeScript types (``web/pages/src/messages.ts``) are made from both modules.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from msgspec import UNSET, Struct, UnsetType

from kineme.segments import table
from kineme.segments.table import Kind, Level
from kineme.web.requests import Edit


@dataclass(frozen=True, slots=True)
class Segment(table.Segment):
    """A row of the segment table, and what people did to it where they did something.

    It is ``excluded`` where it counts in no mean.
    """

    checked: bool | UnsetType = UNSET
    excluded: bool | UnsetType = UNSET
    comment: str | UnsetType = UNSET


class Segments(Struct, frozen=True, kw_only=True):
    """A segment table as its JSON file has it (``kineme.segments/2``), marks in its rows.

    ``cluster_names`` has the names of clusters by their numbers.
    """

    schema: str
    n_frames: int
    fps: float
    provenance: dict[str, Any]
    timings: dict[str, float]
    segments: list[Segment]
    cluster_names: dict[str, str]


class MotionHead(Struct, frozen=True, kw_only=True):
    """How to read the binary motion; see `kineme.web.display`.

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


class MatrixHead(Struct, frozen=True, kw_only=True):
    """Pyramid of self-similarity tiles; see `kineme.web.matrix`.

    Level 0 has one cell per sample of ``fps`` and ``sizes[0]`` cells a side;
    each next level halves that; the last is one tile. Tiles are square, ``tile``
    cells a side, the last of a row or column cut off at the end of the recording.
    A report has the tiles with row >= column only, the others being their mirror
    images; of the finer levels it may lack those off the diagonal, too.
    """

    fps: float
    tile: int
    sizes: list[int]


class Curve(Struct, frozen=True, kw_only=True):
    """A curve over time: a joint's height, a channel; ``group`` says what it is of that name."""

    name: str
    group: str
    unit: str


class CurveList(Struct, frozen=True, kw_only=True):
    """Curves of a recording and their levels; see `kineme.web.curves`."""

    curves: list[Curve]
    factor: int
    tile: int
    levels: int


class CycleChannel(Struct, frozen=True, kw_only=True):
    """What can be measured of a repetition, as ``kineme info --channels`` has it.

    ``opposite`` is the channel of the other side of the body; empty where there is none.
    """

    name: str
    unit: str
    group: str
    opposite: str


class CycleChannels(Struct, frozen=True, kw_only=True):
    """Channels of a recording, those first that are measured where nobody says which."""

    channels: list[CycleChannel]


class CycleCurve(Struct, frozen=True, kw_only=True):
    """A repetition: from 0 to 100 % of the cycle, evenly; null where nothing was recorded.

    ``start_frame`` is that of its segment, ``start_s`` and ``stop_s`` where it was measured.
    Where it ``counts`` it is part of the mean; else ``note`` says why not. ``distance`` is how far
    it is from the mean: the root of the mean square.
    """

    start_frame: int
    start_s: float
    stop_s: float
    counts: bool
    note: str
    distance: float | None
    values: list[float | None]


class OtherSession(Struct, frozen=True, kw_only=True):
    """Mean curve of the same movement in another recording, of ``n`` of ``total`` repetitions.

    ``differs`` says where the bounds of the difference leave out 0.
    """

    n: int
    total: int
    mean: list[float | None]
    sd: list[float | None]
    differs: list[bool]


class ClusterCurves(Struct, frozen=True, kw_only=True):
    """A channel over the repetitions of a cluster, and of those with the same name.

    Mean and standard deviation are of ``n`` of ``total`` repetitions: of the inner ones, or where
    there are none (``ends``) of all; ``left_out`` counts those that people left out. ``cycles`` are
    those drawn: those farthest from the mean first, after them those that do not count. ``turned``
    counts activities that were cut at another phase than the others. ``beside`` is of another
    recording, where one was asked for and has the movement and the channel.
    """

    channel: str
    unit: str
    n: int
    total: int
    ends: bool
    left_out: int
    turned: int
    mean: list[float | None]
    sd: list[float | None]
    cycles: list[CycleCurve]
    beside: OtherSession | None


class ReportCurves(Struct, frozen=True, kw_only=True):
    """Curves in a report.

    ``curves`` have them by channel, ``tables`` by cluster the number of those, for the table that
    is shown and then for each of the ``levels`` of a `Recording`.
    """

    channels: list[CycleChannel]
    curves: list[dict[str, ClusterCurves]]
    tables: list[dict[str, int]]


class TableAtDetail(Struct, frozen=True, kw_only=True):
    """Same recording, coarser (``detail`` below 1) or finer."""

    detail: float
    segments: list[Segment]


class Picture(Struct, frozen=True, kw_only=True):
    """What is drawn over a video, whose picture has so many pixels; see `kineme.web.film`."""

    width: int
    height: int
    keypoints: MotionHead


class Video(Struct, frozen=True, kw_only=True):
    """A video of the recording, and when in it the recording starts, seconds.

    ``picture`` is there where the poses come from it; ``address`` in a report, relative to its
    page.
    """

    name: str
    offset_s: float
    picture: Picture | UnsetType = UNSET
    address: str | UnsetType = UNSET


class Recording(Struct, frozen=True, kw_only=True):
    """Everything a page needs of one recording but the binary parts.

    ``read_options`` has what people said of how it is read (`kineme.web.requests.ReadRequest`),
    ``takes`` the animations in its file, of which ``take`` is this one, ``people`` those in it,
    where there are several, of whom ``person`` is this one: what has the same ``file`` is of the
    same time and space. ``levels`` are the tables at all details, coarsest first, in a report; the
    studio's server is asked for them.
    While ``finding`` its segments are still to be found, and the table is a single transition;
    while ``being_read`` its file is still being read, and few of its poses are here.
    """

    id: str
    name: str
    n_frames: int
    fps: float
    motion: MotionHead | None
    matrix: MatrixHead
    segmentation: Segments
    levels: list[TableAtDetail]
    video: Video | None
    read_options: dict[str, Any]
    take: str | None = None
    takes: list[str] = []
    file: str = ""
    person: str | None = None
    people: list[str] = []
    revision: int
    can_undo: bool
    can_redo: bool
    saved: str
    finding: bool = False
    being_read: bool = False
    warnings: list[str]


class TableChange(Struct, frozen=True, kw_only=True):
    """Rows in which a table differs from that of the revision ``of``.

    A row is known by its level and first frame: ``removed`` ones are there no more, ``rows`` are
    new, or have changed. The numbers of the activities that rows lie in (``activity``) follow.
    """

    of: int
    removed: list[tuple[Level, int]]
    rows: list[Segment]
    cluster_names: dict[str, str]


class Edited(Struct, frozen=True, kw_only=True):
    """What an edit made, already on the disk as ``saved``.

    It is a ``change`` of the table that was edited, or another table, ``segmentation``.
    """

    revision: int
    change: TableChange | None
    segmentation: Segments | None
    can_undo: bool
    can_redo: bool
    saved: str
    notes: list[str]


class ScoreMeaning(Struct, frozen=True, kw_only=True):
    """What people call a score, and what it measures."""

    title: str
    help: str


class Comparison(Struct, frozen=True, kw_only=True):
    """Other result, and how well the shown one agrees with it.

    ``meanings`` are those of the scores; ``differences`` are spans in seconds, in order, in which
    the two say different things.
    """

    name: str
    segmentation: Segments
    scores: dict[str, float]
    meanings: dict[str, ScoreMeaning] = {}
    differences: list[tuple[float, float]] = []


class Preview(Struct, frozen=True, kw_only=True):
    """A table that would take the place of the present one.

    ``corrections`` (segments made by hand or checked) and ``names`` are those of the present
    table; ``lost`` says, in a sentence each, what the new one would not have of them.
    ``details`` are those that make a difference, ``detail`` the one of them that is shown.
    """

    segmentation: Segments
    corrections: int
    names: int
    lost: list[str]
    details: list[float]
    detail: float


class Version(Struct, frozen=True, kw_only=True):
    """A table that was replaced; ``edit`` made it, null: it was found, or came from elsewhere."""

    number: int
    at: str
    edit: Edit | None
    segments: int
    corrections: int
    names: int


class Versions(Struct, frozen=True, kw_only=True):
    """Tables of a recording that were replaced, the latest first."""

    versions: list[Version]


class LoopRow(Struct, frozen=True, kw_only=True):
    """A repetition as a loop: the number of its row in the table, and how good it would be.

    ``slide_m_s`` is null where no foot is planted; ``rank`` 1 is the best of a cluster.
    """

    number: int
    rank: int
    cost: float
    pose_m: float
    slide_m_s: float | None
    turn_deg: float
    speed_m_s: float


class Loops(Struct, frozen=True, kw_only=True):
    """Repetitions of a recording as loops, those of a cluster together, the best first."""

    loops: list[LoopRow]


class PlayedLoop(Struct, frozen=True, kw_only=True):
    """A round of a loop as it would be written, its first frame again at the end.

    ``numbers`` are all its frames, as `kineme.web.display` has them, in base 64. The next round is
    turned by ``turn`` radians about the vertical axis, then moved by ``x`` and ``z`` metres.
    """

    motion: MotionHead
    numbers: str
    turn: float
    x: float
    z: float


class BriefTable(Struct, frozen=True, kw_only=True):
    """What the page of a folder shows of a segment table: its columns, and what people did.

    ``checked`` are numbers of rows, ``comments`` counts them.
    """

    n_frames: int
    fps: float
    level: list[Level]
    kind: list[Kind]
    start_frame: list[int]
    stop_frame: list[int]
    cluster: list[int]
    activity: list[int]
    label: list[str]
    confidence: list[float | None]
    border_confidence: list[float | None]
    checked: list[int]
    comments: int


class FolderRecording(Struct, frozen=True, kw_only=True):
    """A recording of the folder and its table; null where nobody has segmented it yet."""

    id: str
    table: BriefTable | None


class FolderTables(Struct, frozen=True, kw_only=True):
    """Tables of all recordings of the folder, in the order of the list."""

    recordings: list[FolderRecording]


class Progress(Struct, frozen=True, kw_only=True):
    """What is being computed for a recording, and how much of that is done, 0 to 1.

    ``stage`` is empty where nothing is, ``share`` null where nobody knows.
    """

    stage: str
    share: float | None


class PosesProgress(Struct, frozen=True, kw_only=True):
    """Poses that are being estimated of the video ``recording``, empty where none are.

    ``done`` of ``all`` videos are; ``share`` of this one, null where nobody knows, at a ``pace`` in
    frames a second. ``failed`` says in a sentence each what went wrong.
    """

    recording: str
    name: str
    share: float | None
    pace: float
    done: int
    all: int
    failed: list[str]


class Changed(Struct, frozen=True, kw_only=True):
    """Sent to every page when a recording's table changed or a file came."""

    recording: str
    revision: int


class Failure(Struct, frozen=True, kw_only=True):
    """Why a request was refused, in one sentence; ``people`` are those one of whom is to be chosen.

    ``reading`` says that the recording could not be read as it was told to be, ``poses`` that it is
    a video whose poses have to be estimated first.
    """

    error: str
    people: list[str] = []
    reading: bool = False
    poses: bool = False


class Parameter(Struct, frozen=True, kw_only=True):
    """A constant of a preset that the page offers to change."""

    name: str
    help: str
    value: float
    minimum: float
    maximum: float
    step: float
    unit: str


class PresetChoice(Struct, frozen=True, kw_only=True):
    """A preset, and those of its constants that the page offers to change.

    ``signal_parameters`` are the same for signals, where lengths are in
    standard deviations of the channels.
    """

    name: str
    help: str
    parameters: list[Parameter]
    signal_parameters: list[Parameter]


class Listing(Struct, frozen=True, kw_only=True):
    """A recording of the folder, opened or not; people in the same file have the same ``file``.

    It ``needs_poses`` where it is a video whose poses have not been estimated. ``segments``,
    ``checked`` and ``named`` count the rows of its table, if it has been saved (``corrected``),
    that are there, checked, have a name, and are no transitions.
    """

    id: str
    file: str
    name: str
    bytes: int
    needs_poses: bool
    corrected: bool
    segments: int
    checked: int
    named: int
    to_name: int


class FileChoice(Struct, frozen=True, kw_only=True):
    """A file of the folder that an operation can use: a knowledge base, a label file."""

    id: str
    name: str


class ExportFormat(Struct, frozen=True, kw_only=True):
    """A format that segments can be written in, and the suffix of what is downloaded."""

    name: str
    suffix: str
    help: str


class State(Struct, frozen=True, kw_only=True):
    """What the studio offers: the first message a page asks for.

    ``suffixes`` are those of files that can be recordings, ``details`` the levels of detail that
    a segmentation may have, ``labels`` those that all recordings share, ``of_library`` whether the
    recordings are those of a library. ``install`` says what to install before poses of videos can
    be estimated; it is empty where nothing is to be.
    """

    version: str
    folder: str
    of_library: bool
    suffixes: list[str]
    recordings: list[Listing]
    presets: list[PresetChoice]
    default_preset: str
    details: list[float]
    labels: list[str]
    knowledge_bases: list[FileChoice]
    annotations: list[FileChoice]
    export_formats: list[ExportFormat]
    install: str
