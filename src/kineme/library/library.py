"""A library, opened: its recordings, clusters and segments, searched, asked and exported."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self, Unpack

import numpy as np

from kineme._util.checks import check_flag, check_path, format_count
from kineme._util.files import AnyPath
from kineme.errors import ParameterError
from kineme.formats import ReadOptions
from kineme.library.executors import connect
from kineme.library.exporting import get_table, run_query, write_hits, write_pictures, write_table
from kineme.library.finding import as_examples, choose_typical_examples, find_hits, select_tagged
from kineme.library.open_library import Cluster, OpenTables, find_cluster_numbers, list_clusters
from kineme.library.searching import Example, Hit
from kineme.library.storage.layout import as_column, import_arrow
from kineme.library.storage.places import make_path, translate_remote_errors
from kineme.methods.segmenter import SegmentOptions
from kineme.recordings import Motion, Signals
from kineme.transfer.subsequences import THRESHOLD

if TYPE_CHECKING:
    from kineme.clips.options import ClipOptions
    from kineme.clips.tags import Tag
    from kineme.library.clipping import Coverage, Per


class Library:
    """A library, opened for reading; edits are written at once. Clusters go by number or name.

    Parameters
    ----------
    folder : path-like
        What `kineme.library.build` made; or a URL, such as ``s3://bucket/library``.

    Raises
    ------
    ReadError
        There is no library, it is damaged, or of another version.
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
            self._tables = OpenTables(self.folder)

    @property
    def head(self) -> dict[str, Any]:
        """Return what ``library.json`` says: options, sources, constants."""
        return self._tables.head

    @property
    def read_options(self) -> ReadOptions:
        """Return how its recordings are read."""
        return self._tables.options[0]

    @property
    def segment_options(self) -> SegmentOptions:
        """Return how its recordings are segmented."""
        return self._tables.options[1]

    @property
    def failed(self) -> dict[str, str]:
        """Return what could not be read or segmented, by path, and why."""
        return dict(self.head["failed"])

    @property
    def recordings(self) -> dict[str, list[Any]]:
        """Return the table of recordings by column; see `kineme.library.storage.tables`."""
        return self._tables.recordings

    @property
    def hours(self) -> float:
        """Of all recordings together."""
        return float(sum(self.recordings["duration_s"])) / 3600

    def table(self, name: str = "segments") -> Any:
        """One of its tables, edits applied, as a pyarrow.Table.

        ``to_pandas()`` makes a frame of it, `polars.from_arrow` another.

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
        """Return the clusters of the library, those of most seconds first."""
        return list_clusters(self._tables)

    def unsure(self) -> list[dict[str, Any]]:
        """Return rows of ``local_clusters`` that may belong to another cluster, likeliest first."""
        local, most = self._tables.columns("local_clusters"), self.head["clustering"]["unsure"]
        confidence = local["confidence"]
        rows = np.flatnonzero((confidence < most) & (local["cluster"] != local["next_cluster"]))
        rows = rows[np.argsort(confidence[rows], kind="stable")]
        found: list[dict[str, Any]] = (
            self.table("local_clusters").take(as_column(rows, int)).to_pylist()
        )
        return found

    def numbers(self, cluster: int | str) -> list[int]:
        """Return the clusters of that number or name; ParameterError where there is none."""
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
        """Where the recordings of the library are like an example, the nearest first.

        Segments play no part: short recordings and parts of activities are found as well. Of more
        than 100 hours of bodies an index tells what is looked at; all, if ``top`` is None.

        Parameters
        ----------
        like : path-like, Motion, Signals, Example, Hit or sequence of Example or Hit
            What is searched for: a recording, or several spans of some, any of which will do.
        start_s, stop_s : float
            The span of a single recording, seconds.
        cluster : int or str, optional
            Search for the most typical segments of a cluster, by number or name, as well.
        unlike : sequence of Example or Hit
            What is more like one of these than like any example is left out.
        threshold : float
            Largest distance.
        top : int, optional
            Hits at most; None for all.
        max_per_recording : int, optional
            Of one recording at most.
        mirror : bool
            Search for the mirror images of the examples as well; of bodies only. Their distances
            are estimates (see `kineme.features.canonical.mirror_features`).
        tag : str, optional
            Only hits with this tag, such as "backwards" (see `kineme.clips.tags`); the recordings
            of hits are read for it.
        client : dask.distributed.Client or str, optional
            Search on this cluster, or on that of the scheduler at an address.

        Raises
        ------
        ParameterError
            Nothing to search for, or no recording has features that compare with it.
        ReadError
            The example cannot be read, or has no body.
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
        """A PNG of each cluster in a folder, its most typical segment as a strip; of all first."""
        check_path(folder, "pictures")
        return write_pictures(self._tables, Path(folder))

    def clips(self, hits: Sequence[Hit], folder: AnyPath) -> list[Path]:
        """The clips of hits, recording by recording, in a new or empty folder with a manifest."""
        return write_hits(self._tables, hits, folder)

    def coverage(self) -> list[Coverage]:
        """Return what there is of each cluster in each direction; recordings are read for it."""
        from kineme.library.clipping import measure_coverage

        return measure_coverage(self._tables)

    def loops(
        self,
        folder: AnyPath,
        *,
        per: Per = "cluster",
        **options: Unpack[ClipOptions],
    ) -> list[Path]:
        """Write the best loops of each cluster, without near duplicates, to a new folder.

        Parameters
        ----------
        folder : path-like
            New or empty; it gets manifests, too.
        per : {"cluster", "direction", "recording"}
            Of a cluster in all recordings, or of each direction of travel or recording in it.
        **options
            As for `kineme.clips.split.split`, such as ``best=3``, the loops of each at most.

        Raises
        ------
        ParameterError
            No recording has a loop, or an option makes no sense.
        WriteError
            The folder is not empty, or cannot be written.
        """
        from kineme.library.clipping import write_best_loops

        return write_best_loops(self._tables, folder, per=per, **options)

    def query(self, sql: str) -> Any:
        """Return the answer, a pyarrow.Table, to a question in SQL over the tables of the library.

        Parameters
        ----------
        sql : str
            For DuckDB: ``segments``, ``recordings``, ``local_clusters`` and ``embeddings``, whose
            columns are told by `kineme.library.storage.tables.DESCRIBED`, and ``clusters``.

        Raises
        ------
        ParameterError
            DuckDB rejects the query.
        MissingDependencyError
            duckdb is not installed.
        """
        return run_query(self._tables, sql)

    def export(self, path: AnyPath, table: str = "segments") -> None:
        """Write one of its tables, edits applied.

        Parameters
        ----------
        path : path-like
            Parquet, CSV or TSV, by its suffix.
        table : str
            As in `table`.

        Raises
        ------
        WriteError
            Another suffix, or a place that cannot be written.
        """
        check_path(path, "export")
        write_table(self.table(table), path)

    def name(self, cluster: int | str, name: str) -> Self:
        """Return the same library, with a name for a cluster; an empty one takes it away."""
        with self._tables.editing():
            edits = self._tables.edits
            for number in self.numbers(cluster):
                edits = edits.with_name(number, name)
            self._tables.write(edits)
        return self

    def merge(self, cluster: int | str, *others: int | str) -> Self:
        """The same library, with others made part of a cluster, which keeps its number and name."""
        if not others:
            raise ParameterError("nothing to merge: name two clusters at least")
        with self._tables.editing():
            target, *same = self.numbers(cluster)
            moved = [*same, *(number for other in others for number in self.numbers(other))]
            self._tables.write(self._tables.edits.with_merge(target, moved))
        return self

    def split(self, cluster: int | str, recordings: Iterable[str]) -> int:
        """Return the number of a new cluster: what one has in some, not all, of its recordings."""
        chosen, tables = list(recordings), self._tables
        with tables.editing():
            (number, *_) = self.numbers(cluster)
            local = tables.columns("local_clusters")
            present = set(local["recording"][local["cluster"] == number].tolist())
            if not present.intersection(chosen) or present <= set(chosen):
                raise ParameterError(
                    f"cluster {number} is split by naming some, not all, of its {len(present)} "
                    f"recordings: {', '.join(sorted(present)[:5])}"
                )
            into: int = max(tables.head["following"], tables.edits.following)
            tables.write(tables.edits.with_split(number, into, chosen))
        return into

    def path_of(self, recording: str) -> Path:
        """Return the file that a recording of the library was read from."""
        return self._tables.path_of(recording)

    def read(self, recording: str) -> Motion | Signals:
        """A recording, by its name in the library, read as it was when the library was built."""
        return self._tables.read(recording)

    def __len__(self) -> int:
        return len(self.recordings["recording"])

    def __repr__(self) -> str:
        numbers = self._tables.columns("local_clusters")["cluster"].tolist()
        recordings, clusters = (
            format_count(len(self), "recording"),
            format_count(len(set(numbers)), "cluster"),
        )
        return f"<Library of {recordings} ({self.hours:.2g} h), {clusters}>"
