"""Messages that pages receive: one msgspec ``Struct`` each, sent as JSON.

A report contains one `Recording`; the studio's server sends the same over HTTP. Messages that pages
send are in `kineme.web.requests`. The TypeScript types (``web/pages/src/messages.ts``) are
generated from both modules.
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
    """A row of the segment table with its annotations, which are unset by default.

    An ``excluded`` row counts in no mean.
    """

    checked: bool | UnsetType = UNSET
    excluded: bool | UnsetType = UNSET
    comment: str | UnsetType = UNSET


class Segments(Struct, frozen=True, kw_only=True):
    """A segment table in its JSON format (``kineme.segments/2``), with annotations in the rows.

    ``cluster_names`` has the names of clusters by number.
    """

    schema: str
    n_frames: int
    fps: float
    provenance: dict[str, Any]
    timings: dict[str, float]
    segments: list[Segment]
    cluster_names: dict[str, str]


class MotionHead(Struct, frozen=True, kw_only=True):
    """Layout of the binary motion; see `kineme.web.display`.

    There are ``n_samples`` poses at ``sample_fps``. A joint's position in metres, y up, is ``origin
    + step * integer``. ``heading`` is the direction in which the body looks at each sample, in
    radians about y from +z towards +x; null if unknown. ``effectors`` has the joints of
    ``left_ankle``, ``right_ankle``, ``head``, ``left_wrist``, ``right_wrist`` and ``pelvis``; it is
    empty without a body.
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

    Level 0 has one cell per sample at ``fps`` and ``sizes[0]`` cells per side. Each next level has
    half as many; the last is one tile. Tiles have ``tile`` cells per side; the last in a row or
    column are cut off at the end of the recording. A report has only tiles with row >= column,
    since the others are mirrored. Of fine levels it may lack tiles off the diagonal.
    """

    fps: float
    tile: int
    sizes: list[int]


class Curve(Struct, frozen=True, kw_only=True):
    """A curve over time, such as a joint's height or a channel; ``group`` is its quantity."""

    name: str
    group: str
    unit: str


class CurveList(Struct, frozen=True, kw_only=True):
    """Curves of a recording and the layout of their levels; see `kineme.web.curves`."""

    curves: list[Curve]
    factor: int
    tile: int
    levels: int


class CycleChannel(Struct, frozen=True, kw_only=True):
    """A channel that can be measured for each repetition, as in ``kineme info --channels``.

    ``opposite`` is the channel of the other side of the body, or empty.
    """

    name: str
    unit: str
    group: str
    opposite: str


class CycleChannels(Struct, frozen=True, kw_only=True):
    """Channels of a recording; those measured by default come first."""

    channels: list[CycleChannel]


class CycleCurve(Struct, frozen=True, kw_only=True):
    """A repetition, sampled evenly from 0 to 100 % of the cycle; null if missing.

    ``start_frame`` is that of its segment; ``start_s`` and ``stop_s`` are its measured borders. If
    it ``counts`` it is part of the mean, else ``note`` says why not. ``distance`` is the root mean
    square distance from the mean.
    """

    start_frame: int
    start_s: float
    stop_s: float
    counts: bool
    note: str
    distance: float | None
    values: list[float | None]


class OtherSession(Struct, frozen=True, kw_only=True):
    """Mean curve of the same movement in another recording, over ``n`` of ``total`` repetitions.

    ``differs`` is true where the confidence bounds of the difference exclude 0.
    """

    n: int
    total: int
    mean: list[float | None]
    sd: list[float | None]
    differs: list[bool]


class ClusterCurves(Struct, frozen=True, kw_only=True):
    """A channel over the repetitions of a cluster, and of clusters with the same name.

    Mean and standard deviation are over ``n`` of ``total`` repetitions: the inner ones, or all
    (``ends``) if there are none. ``left_out`` counts those excluded by hand. ``cycles`` are the
    drawn ones: first those that count, the farthest from the mean first, then the others.
    ``turned`` counts activities that were cut at another phase than the others. ``beside`` is the
    same movement in another recording, if requested and available.
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

    ``curves`` has groups of curves by channel. ``tables`` has the index of the group of each
    cluster, for the shown table and then for each of the ``levels`` of a `Recording`.
    """

    channels: list[CycleChannel]
    curves: list[dict[str, ClusterCurves]]
    tables: list[dict[str, int]]


class TableAtDetail(Struct, frozen=True, kw_only=True):
    """Table of the same recording at another detail; below 1 is coarser."""

    detail: float
    segments: list[Segment]


class Picture(Struct, frozen=True, kw_only=True):
    """Keypoints drawn over a video with this size in pixels; see `kineme.web.display`."""

    width: int
    height: int
    keypoints: MotionHead


class Video(Struct, frozen=True, kw_only=True):
    """A video of the recording, and the time in it at which the recording starts, in seconds.

    ``picture`` is set if the poses come from the video. ``address`` is set in a report, relative to
    its page.
    """

    name: str
    offset_s: float
    picture: Picture | UnsetType = UNSET
    address: str | UnsetType = UNSET


class Recording(Struct, frozen=True, kw_only=True):
    """Everything that a page needs of a recording except the binary parts.

    ``read_options`` are those that the user set (`kineme.web.requests.ReadRequest`). ``takes`` are
    the animations in the file, of which ``take`` is this one. ``people`` are the people in the file
    if there are several, of whom ``person`` is this one; recordings with the same ``file`` share
    time and space. ``levels`` are the tables at all details, coarsest first, in reports only. While
    ``finding`` the recording is being segmented, and the table is a single transition. While
    ``being_read`` the file is being read, and only some poses are available.
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

    A row is identified by level and first frame. ``removed`` rows no longer exist; ``rows`` are new
    or changed. The page renumbers the activities of rows (``activity``) itself.
    """

    of: int
    removed: list[tuple[Level, int]]
    rows: list[Segment]
    cluster_names: dict[str, str]


class Edited(Struct, frozen=True, kw_only=True):
    """Result of an edit, already saved in the file ``saved``.

    It is either a ``change`` of the table, or another table, ``segmentation``.
    """

    revision: int
    change: TableChange | None
    segmentation: Segments | None
    can_undo: bool
    can_redo: bool
    saved: str
    notes: list[str]


class ScoreMeaning(Struct, frozen=True, kw_only=True):
    """Title of a score, and what it measures."""

    title: str
    help: str


class Comparison(Struct, frozen=True, kw_only=True):
    """Another result, and the agreement of the shown table with it.

    ``meanings`` explain the scores. ``differences`` are the spans in seconds in which the two
    differ.
    """

    name: str
    segmentation: Segments
    scores: dict[str, float]
    meanings: dict[str, ScoreMeaning] = {}
    differences: list[tuple[float, float]] = []


class Preview(Struct, frozen=True, kw_only=True):
    """A table that could replace the present one.

    ``corrections`` (segments edited or checked by hand) and ``names`` count those of the present
    table. ``lost`` are sentences about what would be lost. ``details`` are the levels of detail
    with different segments, ``detail`` the shown one.
    """

    segmentation: Segments
    corrections: int
    names: int
    lost: list[str]
    details: list[float]
    detail: float


class Version(Struct, frozen=True, kw_only=True):
    """A table that was replaced; ``edit`` made it, null for a segmentation or a foreign table."""

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
    """A repetition as a loop: the number of its row in the table, and its quality.

    ``slide_m_s`` is null if no foot touches the ground; ``rank`` 1 is the best of a cluster.
    """

    number: int
    rank: int
    cost: float
    pose_m: float
    slide_m_s: float | None
    turn_deg: float
    speed_m_s: float


class Loops(Struct, frozen=True, kw_only=True):
    """Repetitions of a recording as loops, grouped by cluster, the best first."""

    loops: list[LoopRow]


class PlayedLoop(Struct, frozen=True, kw_only=True):
    """One round of a loop as it would be exported; the first frame is repeated at the end.

    ``numbers`` are the frames as in `kineme.web.display`, in base 64. The next round is rotated by
    ``turn`` radians about the vertical axis, then moved by ``x`` and ``z`` metres.
    """

    motion: MotionHead
    numbers: str
    turn: float
    x: float
    z: float


class BriefTable(Struct, frozen=True, kw_only=True):
    """Columns of a segment table that the page of a folder shows, and its annotations.

    ``checked`` are row numbers, ``comments`` is their count.
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
    """A recording of the folder and its table; null if it is not segmented yet."""

    id: str
    table: BriefTable | None


class FolderTables(Struct, frozen=True, kw_only=True):
    """Tables of all recordings of the folder, in the order of the list."""

    recordings: list[FolderRecording]


class Progress(Struct, frozen=True, kw_only=True):
    """Stage of the computation for a recording, and the completed fraction, 0 to 1.

    ``stage`` is empty if nothing is running, ``share`` null if unknown.
    """

    stage: str
    share: float | None


class PosesProgress(Struct, frozen=True, kw_only=True):
    """Progress of pose estimation for the video ``recording``, which is empty if idle.

    ``done`` of ``all`` videos are done. ``share`` is the completed fraction of this one, null if
    unknown, and ``pace`` the speed in frames per second. ``failed`` are sentences about errors.
    """

    recording: str
    name: str
    share: float | None
    pace: float
    done: int
    all: int
    failed: list[str]


class Changed(Struct, frozen=True, kw_only=True):
    """Sent to every page when a table has changed or a file was added."""

    recording: str
    revision: int


class Failure(Struct, frozen=True, kw_only=True):
    """Reason why a request was refused, in one sentence; ``people`` are the people to choose from.

    ``reading`` is true if the recording cannot be read with its options, ``poses`` if it is a video
    whose poses must be estimated first.
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
    """A preset and its constants that the page offers to change.

    ``signal_parameters`` are those for signals, with lengths in standard deviations of the
    channels.
    """

    name: str
    help: str
    parameters: list[Parameter]
    signal_parameters: list[Parameter]


class Listing(Struct, frozen=True, kw_only=True):
    """A recording of the folder, opened or not; people in the same file have the same ``file``.

    ``needs_poses`` is true for a video without estimated poses, ``corrected`` if a table is saved.
    ``segments``, ``checked``, ``named`` and ``to_name`` count rows of that table: all, checked,
    with a name, and other than transitions.
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
    """A knowledge base or label file of the folder."""

    id: str
    name: str


class ExportFormat(Struct, frozen=True, kw_only=True):
    """A format in which segments can be downloaded, and its suffix."""

    name: str
    suffix: str
    help: str


class State(Struct, frozen=True, kw_only=True):
    """What the studio offers; the first message that a page requests.

    ``suffixes`` are those of recordings, ``details`` the available levels of detail, ``labels`` the
    labels that all recordings share. ``of_library`` tells whether the recordings are those of a
    library. ``install`` tells what to install for pose estimation; it is empty if nothing is
    missing.
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
