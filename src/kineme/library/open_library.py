"""Read the tables of an open library with edits applied, and list its clusters."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple, get_type_hints

import numpy as np
from numpy.typing import NDArray

from kineme._util.files import is_remote, read_file_stamp
from kineme.errors import ParameterError, ReadError
from kineme.formats import ReadOptions
from kineme.library.edits import Edits, apply_edits, read_edits
from kineme.library.planning import read_kept_options, read_recording
from kineme.library.storage.layout import (
    EDITS,
    HEAD,
    as_array,
    as_column,
    import_arrow,
    make_path,
    read_head,
)
from kineme.library.storage.tables import DESCRIBED, find_rows, read_table
from kineme.methods.segmenter import SegmentOptions
from kineme.recordings import Motion, Signals

Columns = dict[str, NDArray[Any]]


class OpenTables:
    """The current tables of a library when it was opened, and the edits.

    ``head`` is the content of ``library.json``.
    """

    def __init__(self, folder: Path):
        self.folder = folder
        self._stamps = _read_stamps(folder)  # first, so that a later change is noticed
        self.head = read_head(folder)
        try:
            self._computed = self._read()
        except ReadError:  # a build may have ended between the head and the tables
            self.head = read_head(folder)
            self._computed = self._read()
        self._use_edits(read_edits(folder))

    @property
    def options(self) -> tuple[ReadOptions, SegmentOptions]:
        """Return the options for reading and segmenting."""
        return read_kept_options(self.folder, self.head)

    @cached_property
    def recordings(self) -> dict[str, list[Any]]:
        """Return the table of recordings by column."""
        found: dict[str, list[Any]] = self.table("recordings").to_pydict()
        return found

    def path_of(self, recording: str) -> Path:
        """Return the path of a recording's file."""
        try:
            row = self.recordings["recording"].index(recording)
        except ValueError:
            raise ParameterError(f"no recording is called {recording!r:.60}") from None
        return make_path(self.recordings["path"][row])

    def read(self, recording: str) -> Motion | Signals:
        """Read a recording of the library with the library's options."""
        return read_recording(self.path_of(recording), self.options[0])

    def table(self, name: str) -> Any:
        """Return one of the tables in `DESCRIBED` as a pyarrow.Table with edits applied."""
        if name not in self._computed:
            self._computed[name] = read_table(self.folder, self.head["tables"], name)
        tables = self._edited  # keep this dict: an edit in another thread replaces it
        if name not in tables:
            tables[name] = apply_edits(self._computed[name], self.edits)
        return tables[name]

    def columns(self, name: str) -> Columns:
        """Return a table as arrays by column."""
        arrays = self._arrays
        if name not in arrays:
            table = self.table(name)
            arrays[name] = {column: as_array(table.column(column)) for column in table.column_names}
        return arrays[name]

    @cached_property
    def rows(self) -> dict[str, slice]:
        """Return the rows of each recording's segments."""
        return find_rows(self.table("segments"))

    def is_outdated(self) -> bool:
        """Return whether another process has built or edited the library; False for remote ones."""
        return _read_stamps(self.folder) != self._stamps

    def write(self, edits: Edits) -> None:
        """Write edits to disk and use them."""
        edits.write(self.folder)
        self._stamps = _read_stamps(self.folder)
        self._use_edits(edits)

    def _use_edits(self, edits: Edits) -> None:
        self.edits = edits
        self._edited: dict[str, Any] = {}
        self._arrays: dict[str, Columns] = {}

    def _read(self) -> dict[str, Any]:
        """Read all tables but the embeddings, which are rarely needed."""
        names = [name for name in DESCRIBED if name != "embeddings"]
        tables = {name: read_table(self.folder, self.head["tables"], name) for name in names}
        recordings = {*tables["recordings"].column("recording").to_pylist()}
        for name in names:
            found = {*tables[name].column("recording").unique().to_pylist()}
            # Every recording has segments; the other tables may leave recordings out.
            if found != recordings if name == "segments" else not found <= recordings:
                raise ReadError(
                    self.folder, f"{name} and recordings do not match: build the library again"
                )
        return tables


def _read_stamps(folder: Path) -> list[tuple[int, int, int] | None]:
    """Return values that change if a local library is written; empty for a remote one."""
    return [] if is_remote(folder) else [read_file_stamp(folder / name) for name in (HEAD, EDITS)]


class Cluster(NamedTuple):
    """A cluster of the library over all recordings.

    Attributes
    ----------
    cluster : int
    label : str
        Name of the cluster, or empty.
    vocabulary : str
        `bodies`, or the set of channels.
    recordings, activities, repetitions : int
        Number of recordings with it, of its activities and its primitives.
    seconds : float
        Total duration of its activities.
    typical_s : float
        Median seconds of a repetition, or of an activity if there are no repetitions.
    example : str
        Recording with its most typical segment.
    start_s, stop_s : float
        Start and stop of that segment.
    """

    cluster: int
    label: str
    vocabulary: str
    recordings: int
    activities: int
    repetitions: int
    seconds: float
    typical_s: float
    example: str
    start_s: float
    stop_s: float


def list_clusters(tables: OpenTables) -> list[Cluster]:
    """Return the clusters of a library, those with the most seconds first."""
    local, segments = tables.columns("local_clusters"), tables.columns("segments")
    recordings = tables.recordings
    vocabularies = dict(zip(recordings["recording"], recordings["vocabulary"], strict=True))
    durations = segments["stop_s"] - segments["start_s"]
    is_active = segments["kind"] != "transition"
    is_primitive = segments["level"] == "primitive"
    clusters = []
    for number in sorted(set(local["cluster"].tolist())):
        members = np.flatnonzero(local["cluster"] == number)
        # The most typical segment is that of the local cluster nearest to all others.
        medoid = members[np.argmin(local["spread"][members])]
        example = str(local["recording"][medoid])
        in_cluster = is_active & (segments["cluster"] == number)
        repetitions, activities = in_cluster & is_primitive, in_cluster & ~is_primitive
        typical = durations[repetitions if repetitions.any() else activities]
        clusters.append(
            Cluster(
                cluster=number,
                label=tables.edits.name(number),
                vocabulary=vocabularies[example],
                recordings=len(set(local["recording"][members].tolist())),
                activities=int(activities.sum()),
                repetitions=int(repetitions.sum()),
                seconds=round(float(durations[activities].sum()), 6),
                typical_s=round(float(np.median(typical)), 6) if len(typical) else 0.0,
                example=example,
                start_s=float(local["start_s"][medoid]),
                stop_s=float(local["stop_s"][medoid]),
            )
        )
    return sorted(clusters, key=lambda cluster: (-cluster.seconds, cluster.cluster))


def tabulate_clusters(clusters: Sequence[Cluster]) -> Any:
    """Return the clusters as a pyarrow.Table."""
    pa, _ = import_arrow()
    hints = get_type_hints(Cluster)
    return pa.table(
        {
            name: as_column([getattr(each, name) for each in clusters], hints[name])
            for name in Cluster._fields
        }
    )


def list_vocabularies(tables: OpenTables, clusters: Sequence[int]) -> list[str]:
    """Return the vocabularies (bodies, or sets of channels) of the recordings with clusters."""
    local = tables.columns("local_clusters")
    members = {*local["recording"][np.isin(local["cluster"], clusters)].tolist()}
    rows = zip(tables.recordings["recording"], tables.recordings["vocabulary"], strict=True)
    return sorted({vocabulary for name, vocabulary in rows if name in members})


def find_cluster_numbers(tables: OpenTables, cluster: int | str) -> list[int]:
    """Return the numbers of the clusters with a number or name, at least one."""
    numbers = sorted(set(tables.columns("local_clusters")["cluster"].tolist()))
    edits, text = tables.edits, str(cluster)
    named = isinstance(cluster, str)  # an int never matches a name of digits
    matches = [number for number in numbers if named and edits.name(number) == text]
    if not matches and text.isdecimal():
        matches = [number for number in numbers if number == edits.number(int(text))]
    if not matches:
        names = ", ".join(edits.name(number) or str(number) for number in numbers[:20])
        raise ParameterError(f"no cluster is called {text:.60}; there are {names or 'none'}")
    return matches
