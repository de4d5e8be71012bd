"""The `Library` class: search, query, edit and export a library."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import Any, Self, Unpack

import numpy as np

from kineme._util.checks import as_texts, check_flag, check_path, format_count
from kineme._util.files import AnyPath, is_remote
from kineme.clips.options import ClipOptions
from kineme.clips.root_motion import Tag
from kineme.errors import ParameterError
from kineme.formats import ReadOptions
from kineme.library.executors import connect
from kineme.library.exporting import (
    Coverage,
    Per,
    get_table,
    measure_coverage,
    run_query,
    write_best_loops,
    write_hits,
    write_pictures,
    write_table,
)
from kineme.library.finding import (
    Example,
    Hit,
    as_examples,
    choose_typical_examples,
    find_hits,
    select_tagged,
)
from kineme.library.open_library import (
    Cluster,
    OpenTables,
    find_cluster_numbers,
    list_clusters,
    list_vocabularies,
)
from kineme.library.storage.layout import (
    LOCK_EDITS,
    as_column,
    import_arrow,
    lock_for_writing,
    make_path,
    translate_remote_errors,
)
from kineme.methods.segmenter import SegmentOptions
from kineme.recordings import Motion, Signals
from kineme.transfer.matching import THRESHOLD


class Library:
    """An open library. Edits are saved at once; clusters are given by number or name.

    If another process builds or edits a local library, the next use reads it again; open a library
    at a URL again yourself.

    Parameters
    ----------
    folder : path-like
        Folder made by `kineme.library.build`, or a URL such as ``s3://bucket/library``.

    Raises
    ------
    ReadError
        The folder is not a library, is damaged, or of another version.
    MissingDependencyError
        pyarrow is not installed.

    Examples
    --------
    >>> import kineme
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as home:
    ...     built = kineme.library.build(kineme.bundled_recording(), f"{home}/library")
    ...     library = kineme.Library(f"{home}/library")
    ...     library, len(library.search("exercises.bvh", 0.5, 1.6, top=3))
    (<Library of 1 recording (0.013 h), 6 clusters>, 3)
    """

    def __init__(self, folder: AnyPath):
        import_arrow()
        self.folder = make_path(folder, "Library")
        with translate_remote_errors(self.folder):
            self._opened = OpenTables(self.folder)

    @property
    def _tables(self) -> OpenTables:
        """Return the tables; read them again if another process has changed the library."""
        if self._opened.is_outdated():
            self._opened = OpenTables(self.folder)
        return self._opened

    @contextmanager
    def _lock_edits(self) -> Iterator[OpenTables]:
        """Provide current tables, whose edits no other process changes during the block."""
        with lock_for_writing(self.folder, "try again", LOCK_EDITS):
            if is_remote(self.folder):  # where changes are not noticed
                self._opened = OpenTables(self.folder)
            yield self._tables

    @property
    def head(self) -> dict[str, Any]:
        """Return the content of ``library.json``: options, sources, constants."""
        return self._tables.head

    @property
    def read_options(self) -> ReadOptions:
        """Return the options for reading its recordings."""
        return self._tables.options[0]

    @property
    def segment_options(self) -> SegmentOptions:
        """Return the options for segmenting its recordings."""
        return self._tables.options[1]

    @property
    def failed(self) -> dict[str, str]:
        """Return the recordings that could not be read or segmented, and why, by path."""
        return dict(self.head["failed"])

    @property
    def recordings(self) -> dict[str, list[Any]]:
        """Return the table of recordings by column; see `kineme.library.storage.tables`."""
        return self._tables.recordings

    @property
    def hours(self) -> float:
        """Return the total duration of all recordings in hours."""
        return float(sum(self.recordings["duration_s"])) / 3600

    def table(self, name: str = "segments") -> Any:
        """Return a table with edits applied, as a pyarrow.Table.

        ``to_pandas()`` and `polars.from_arrow` convert it to a data frame.

        Parameters
        ----------
        name : {"segments", "recordings", "local_clusters", "embeddings", "clusters"}

        Raises
        ------
        ParameterError
            There is no such table.
        """
        return get_table(self._tables, name)

    def clusters(self) -> list[Cluster]:
        """Return the clusters of the library, those with the most seconds first."""
        return list_clusters(self._tables)

    def unsure(self) -> list[dict[str, Any]]:
        """Return uncertain rows of ``local_clusters``, the least certain first."""
        local, most = self._tables.columns("local_clusters"), self.head["clustering"]["unsure"]
        confidence = local["confidence"]
        # Once a person has merged the two clusters, there is nothing to choose.
        rows = np.flatnonzero((confidence < most) & (local["cluster"] != local["next_cluster"]))
        rows = rows[np.argsort(confidence[rows], kind="stable")]
        found: list[dict[str, Any]] = (
            self.table("local_clusters").take(as_column(rows, int)).to_pylist()
        )
        return found

    def numbers(self, cluster: int | str) -> list[int]:
        """Return the clusters with a number or name; raise ParameterError if there are none."""
        return find_cluster_numbers(self._tables, cluster)

    def search(
        self,
        like: AnyPath | Motion | Signals | Example | Hit | Sequence[Example | Hit] | None = None,
        start_s: float = 0.0,
        stop_s: float | None = None,
        *,
        cluster: int | str | None = None,
        unlike: Sequence[Example | Hit] = (),
        threshold: float = THRESHOLD,
        top: int | None = 50,
        max_per_recording: int | None = None,
        mirror: bool = True,
        tag: Tag | None = None,
        client: Any = None,
    ) -> list[Hit]:
        """Return the spans of recordings that are similar to an example, the nearest first.

        Segments are not used, so short recordings and parts of activities are found as well. With
        more than 100 hours of bodies an index preselects parts, unless ``top`` is None.

        Parameters
        ----------
        like : path-like, Motion, Signals, Example, Hit or sequence of Example or Hit
            What to search for: a recording, or several spans, any of which may match.
        start_s, stop_s : float
            Span of a single recording, seconds.
        cluster : int or str, optional
            Also search for the most typical segments of a cluster, by number or name.
        unlike : sequence of Example or Hit
            Leave out spans that are more similar to one of these than to any example.
        threshold : float
            Largest distance of a hit.
        top : int, optional
            Largest number of hits; None for all.
        max_per_recording : int, optional
            Largest number of hits in one recording.
        mirror : bool
            Also search for mirror images of the examples (bodies only). Their distances are
            estimates (see `kineme.features.canonical.mirror_features`).
        tag : str, optional
            Return only hits with this tag, such as "backwards" (see `kineme.clips.root_motion`).
            This reads the recordings of the hits.
        client : dask.distributed.Client or str, optional
            Search on this Dask cluster, or on that of the scheduler at an address.

        Raises
        ------
        ParameterError
            Nothing to search for, or no recording has comparable features.
        ReadError
            An example cannot be read, or has no body.
        """
        check_flag(mirror, "mirror")
        examples = as_examples(like, start_s, stop_s)
        if cluster is not None:
            examples += choose_typical_examples(self._tables, cluster)
        if not examples:
            raise ParameterError("nothing to search for: give an example or a cluster")
        with nullcontext() if client is None else connect(client) as executor:
            hits = find_hits(
                self._tables, examples, as_examples(unlike, 0.0, None), threshold=threshold,
                top=top if tag is None else None, mirror=mirror,
                max_per_recording=max_per_recording, executor=executor,
            )  # fmt: skip
        return hits if tag is None else select_tagged(self._tables, hits, tag, top)

    def pictures(self, folder: AnyPath) -> list[Path]:
        """Write a PNG of each cluster's most typical segment, and one of all clusters."""
        check_path(folder, "pictures")
        return write_pictures(self._tables, Path(folder))

    def clips(self, hits: Sequence[Hit], folder: AnyPath) -> list[Path]:
        """Write the clips of hits to a new or empty folder with a manifest."""
        return write_hits(self._tables, hits, folder)

    def coverage(self) -> list[Coverage]:
        """Return the coverage of each cluster in each direction; reads all recordings of bodies."""
        return measure_coverage(self._tables)

    def loops(
        self, folder: AnyPath, *, per: Per = "cluster", **options: Unpack[ClipOptions]
    ) -> list[Path]:
        """Write the best loops of each group, without near duplicates, to a new folder.

        Parameters
        ----------
        folder : path-like
            New or empty; manifests are written to it, too.
        per : {"cluster", "direction", "recording"}
            Groups: each cluster, or each direction of travel or recording within a cluster.
        **options
            As for `kineme.clips.split.split`, such as ``best=3``, the number of loops per group.

        Raises
        ------
        ParameterError
            No recording has a loop, or an option is invalid.
        WriteError
            The folder is not empty, or cannot be written.
        """
        return write_best_loops(self._tables, folder, per=per, **options)

    def query(self, sql: str) -> Any:
        """Return the result of an SQL query over the tables of the library, as a pyarrow.Table.

        Parameters
        ----------
        sql : str
            In DuckDB's dialect. Tables are ``clusters``, and ``segments``, ``recordings``,
            ``local_clusters`` and ``embeddings`` as in `kineme.library.storage.tables.DESCRIBED`.

        Raises
        ------
        ParameterError
            DuckDB rejects the query.
        MissingDependencyError
            duckdb is not installed.
        """
        return run_query(self._tables, sql)

    def export(self, path: AnyPath, table: str = "segments") -> None:
        """Write a table with edits applied.

        Parameters
        ----------
        path : path-like
            Parquet, CSV or TSV, by its suffix.
        table : str
            As in `table`.

        Raises
        ------
        WriteError
            Unknown suffix, or the file cannot be written.
        """
        check_path(path, "export")
        write_table(self.table(table), path)

    def name(self, cluster: int | str, name: str) -> Self:
        """Name a cluster and return the library; an empty name removes the name."""
        with self._lock_edits() as tables:
            edits = tables.edits
            for number in self.numbers(cluster):
                edits = edits.with_name(number, name)
            tables.write(edits)
        return self

    def merge(self, cluster: int | str, *others: int | str) -> Self:
        """Merge others into a cluster and return the library.

        The cluster keeps its number and name; without a name it gets that of the first that has
        one. Clusters of bodies and of different sets of channels cannot be merged.
        """
        if not others:
            raise ParameterError("nothing to merge: name at least two clusters")
        with self._lock_edits() as tables:
            target, *same = self.numbers(cluster)
            moved = [*same, *(number for other in others for number in self.numbers(other))]
            if {cluster}.issuperset(others):
                raise ParameterError(f"{cluster!r} is the same cluster: name at least two")
            if not {target}.issuperset(moved):  # else they are merged already
                kinds = list_vocabularies(tables, [target, *moved])
                if len(kinds) > 1:
                    raise ParameterError(
                        f"clusters of {' and of '.join(kinds)} cannot be merged: "
                        "choose clusters of the same kind of recording"
                    )
                tables.write(tables.edits.with_merge(target, moved))
        return self

    def split(self, cluster: int | str, recordings: Iterable[str]) -> int:
        """Split the segments in some recordings off a cluster; return the new cluster's number."""
        chosen = as_texts(recordings, "recordings")
        with self._lock_edits() as tables:
            number, *others = self.numbers(cluster)
            if others:
                raise ParameterError(
                    f"{cluster!r} is the name of several clusters: give the number of one "
                    f"({', '.join(map(str, [number, *others]))})"
                )
            if unknown := set(chosen) - set(self.recordings["recording"]):
                raise ParameterError(f"there is no recording {min(unknown)!r} in the library")
            local = tables.columns("local_clusters")
            present = set(local["recording"][local["cluster"] == number].tolist())
            if not present.intersection(chosen) or present <= set(chosen):
                raise ParameterError(
                    f"cluster {number} can only be split by naming some, not all, of its "
                    f"{len(present)} recordings: {', '.join(sorted(present)[:5])}"
                )
            # The builds know nothing of clusters that edits made, so take the larger number.
            new: int = max(tables.head["following"], tables.edits.next_cluster)
            tables.write(tables.edits.with_split(number, new, chosen))
        return new

    def path_of(self, recording: str) -> Path:
        """Return the path of a recording's file."""
        return self._tables.path_of(recording)

    def read(self, recording: str) -> Motion | Signals:
        """Read a recording, by its name in the library, with the library's options."""
        return self._tables.read(recording)

    def __len__(self) -> int:
        return len(self.recordings["recording"])

    def __repr__(self) -> str:
        numbers = self._tables.columns("local_clusters")["cluster"].tolist()
        recordings = format_count(len(self), "recording")
        clusters = format_count(len(set(numbers)), "cluster")
        return f"<Library of {recordings} ({self.hours:.2g} h), {clusters}>"
