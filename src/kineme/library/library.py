"""A library, opened: its recordings, clusters and segments, searched, asked and exported."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import Any, Self

import numpy as np
from threadpoolctl import threadpool_limits

from kineme._checks import check_path, is_number
from kineme._files import atomic_write
from kineme._threads import map_threads
from kineme.errors import MissingDependencyError, ParameterError, WriteError
from kineme.formats import read
from kineme.labels.delimited import as_text, write_rows
from kineme.library.clusters import Cluster, Word, cluster_table, clusters_of, unsure_words
from kineme.library.examples import as_examples, features_of, one_vocabulary
from kineme.library.layout import EXTRA, PIECES, arrow
from kineme.library.opened import OpenTables
from kineme.library.pieces import read_features
from kineme.library.searching import Example, Hit, best, spans_like
from kineme.library.settings import Settings
from kineme.library.tables import DESCRIBED
from kineme.matching import THRESHOLD, Matches
from kineme.recordings import Motion, Signals
from kineme.segments.table import Segment

AnyPath = str | PathLike[str]
TYPICAL = 5
"""Words that stand for a cluster in a search, the most typical ones."""


class Library:
    """A library, opened for reading; edits are written at once.

    Parameters
    ----------
    folder : path-like
        What `kineme.library.build` made.

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
        check_path(folder, "Library")
        arrow()
        self.folder = Path(folder)
        self._tables = OpenTables(self.folder)

    @property
    def head(self) -> dict[str, Any]:
        """What ``library.json`` says: settings, sources, constants."""
        return self._tables.head

    @property
    def settings(self) -> Settings:
        """How its recordings are read and segmented."""
        return Settings.from_json(self.head["settings"])

    @property
    def failed(self) -> dict[str, str]:
        """What could not be read or segmented, by path, and why."""
        return dict(self.head["failed"])

    @cached_property
    def recordings(self) -> dict[str, list[Any]]:
        """The table of recordings by column; see `kineme.library.tables`."""
        found: dict[str, list[Any]] = self._tables.table("recordings").to_pydict()
        return found

    @property
    def hours(self) -> float:
        """Of all recordings together."""
        return float(sum(self.recordings["duration_s"])) / 3600

    def table(self, name: str = "segments") -> Any:
        """One of its tables, edits applied.

        Parameters
        ----------
        name : {"segments", "recordings", "words", "embeddings", "clusters"}

        Returns
        -------
        pyarrow.Table
            ``to_pandas()`` makes a frame of it, `polars.from_arrow` another.

        Raises
        ------
        ParameterError
            There is no such table.
        """
        if name == "clusters":
            return cluster_table(self.clusters())
        if name not in DESCRIBED:
            raise ParameterError(
                f"no table {name!r:.40}; there are {', '.join(DESCRIBED)}, clusters"
            )
        return self._tables.table(name)

    def clusters(self) -> list[Cluster]:
        """The clusters of the library, those of most seconds first."""
        vocabularies = dict(
            zip(self.recordings["recording"], self.recordings["vocabulary"], strict=True)
        )
        return clusters_of(
            self._tables.columns("words"),
            self._tables.columns("segments"),
            vocabularies,
            self._tables.edits,
        )

    def unsure(self) -> list[Word]:
        """The words that may as well be in another cluster, the least sure first."""
        return unsure_words(self._tables.columns("words"), self.head["vocabulary"]["unsure"])

    def numbers(self, cluster: int | str) -> list[int]:
        """The clusters of that number or name.

        Parameters
        ----------
        cluster : int or str

        Returns
        -------
        list of int

        Raises
        ------
        ParameterError
            There is none.
        """
        there = sorted(set(self._tables.columns("words")["cluster"].tolist()))
        edits, text = self._tables.edits, str(cluster)
        found = [number for number in there if edits.name(number) == text]
        if not found and text.isdecimal():
            found = [number for number in there if number == edits.number(int(text))]
        if not found:
            names = ", ".join(edits.name(number) or str(number) for number in there[:20])
            raise ParameterError(f"no cluster is called {text:.60}; there are {names or 'none'}")
        return found

    def search(
        self,
        like: AnyPath | Motion | Signals | Example | Sequence[Example] | None = None,
        start_s: float = 0.0,
        stop_s: float | None = None,
        *,
        cluster: int | str | None = None,
        unlike: Sequence[Example] = (),
        threshold: float = THRESHOLD,
        top: int | None = 50,
        max_per_recording: int | None = None,
        mirror: bool = False,
    ) -> list[Hit]:
        """Where the recordings of the library are like an example, the nearest first.

        Segments play no part: short recordings and parts of activities are found as well.

        Parameters
        ----------
        like : path-like, Motion, Signals, Example or sequence of Example
            What is searched for: a recording, or several spans of some, any of which will do.
        start_s, stop_s : float
            The span of a single recording, seconds.
        cluster : int or str, optional
            Search for the most typical segments of a cluster, by number or name, as well.
        unlike : sequence of Example
            What is more like one of these than like any example is left out.
        threshold : float
            Largest distance.
        top : int, optional
            Hits at most; None for all.
        max_per_recording : int, optional
            Of one recording at most.
        mirror : bool
            Search for the mirror images of the examples as well; of bodies only.

        Returns
        -------
        list of Hit

        Raises
        ------
        ParameterError
            Nothing to search for, or no recording has features that compare with it.
        ReadError
            The example cannot be read, or has no body.
        """
        for name, value in (("top", top), ("max_per_recording", max_per_recording)):
            if value is not None and not (is_number(value) and value >= 1):
                raise ParameterError(f"{name} must be a whole number above 0, not {value!r:.60}")
        wanted = features_of(self, as_examples(like, start_s, stop_s), mirror=mirror)
        if cluster is not None:
            wanted += features_of(self, self._typical(cluster), mirror=mirror)
        if not wanted:
            raise ParameterError("nothing to search for: give an example or a cluster")
        vocabulary = one_vocabulary(wanted)
        refused = [part for kind, part in features_of(self, unlike) if kind == vocabulary]
        rows = [row for row, kind in enumerate(self.recordings["vocabulary"]) if kind == vocabulary]
        if not rows:
            there = sorted(set(self.recordings["vocabulary"]) - {""})
            raise ParameterError(
                f"the example is of {vocabulary}, the library has {'; '.join(there) or 'nothing'}"
            )
        examples = [part for _, part in wanted]

        def spans_in(row: int) -> Matches:
            features = read_features(self.folder / PIECES, self.recordings["piece"][row])
            most = max_per_recording or top
            return spans_like(features, examples, refused, threshold=threshold, top=most)

        with threadpool_limits(1):  # recordings are searched side by side
            found = map_threads(spans_in, rows)
        chosen = best(found, top=top, most=max_per_recording)
        return [self._hit(rows[i], *span) for i, span in chosen]

    def clips(self, hits: Sequence[Hit], folder: AnyPath) -> list[Path]:
        """Write what a search found as clips, with a manifest; see `kineme.clips.split`.

        Parameters
        ----------
        hits : sequence of Hit
        folder : path-like
            To be made; one that is there must be empty.

        Returns
        -------
        list of Path
            Those of one recording together, in the order of the first of each.
        """
        from kineme.clips.split import write_clips

        by_recording: dict[str, list[Hit]] = {}
        for hit in hits:
            by_recording.setdefault(hit.recording, []).append(hit)
        wanted = ((self.read(name), own) for name, own in by_recording.items())
        return write_clips(
            ((seen, [_as_segment(hit, seen) for hit in own]) for seen, own in wanted), folder
        )

    def query(self, sql: str) -> Any:
        """The answer to a question in SQL over the tables of the library.

        Parameters
        ----------
        sql : str
            For DuckDB: ``segments``, ``recordings``, ``words`` and ``embeddings``, whose columns
            are told by `kineme.library.tables.DESCRIBED`, and ``clusters``.

        Returns
        -------
        pyarrow.Table

        Raises
        ------
        ParameterError
            DuckDB cannot make sense of it.
        MissingDependencyError
            duckdb is not installed.
        """
        try:
            import duckdb
        except ImportError as error:
            raise MissingDependencyError("duckdb", EXTRA) from error
        if not isinstance(sql, str):
            raise ParameterError(f"a question is a text of SQL, not {sql!r:.60}")
        with duckdb.connect() as connection:
            connection.execute("SET enable_external_access = false")
            for name in (*DESCRIBED, "clusters"):
                connection.register(name, self.table(name))
            try:
                answer = connection.sql(sql)
                if answer is None:
                    raise ParameterError("this asks for no rows: begin it with select")
                return answer.to_arrow_table()
            except duckdb.Error as error:
                raise ParameterError(" ".join(str(error).split())[:400]) from error

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
        suffix = Path(path).suffix.lower()
        found = self.table(table)
        _, parquet = arrow()
        if suffix == ".parquet":
            with atomic_write(path) as draft:
                parquet.write_table(found, draft)
        elif suffix in (".csv", ".tsv"):
            names = [name for name in found.column_names if name != "embedding"]
            rows = zip(*(map(_cell, found.column(name).to_pylist()) for name in names), strict=True)
            with atomic_write(path) as draft, draft.open("w", encoding="utf-8", newline="") as file:
                write_rows(file, names, rows, delimiter="," if suffix == ".csv" else "\t")
        else:
            raise WriteError(path, "the suffix must be one of .parquet, .csv, .tsv")

    def name(self, cluster: int | str, name: str) -> Self:
        """Call a cluster by a name in all recordings; an empty name takes it away.

        Parameters
        ----------
        cluster : int or str
            By number, or by the name that it had.
        name : str

        Returns
        -------
        Library
            This one.
        """
        with self._tables.editing():
            edits = self._tables.edits
            for number in self.numbers(cluster):
                edits = edits.with_name(number, name)
            self._tables.write(edits)
        return self

    def merge(self, cluster: int | str, *others: int | str) -> Self:
        """Make other clusters part of one, which keeps its number and name.

        Parameters
        ----------
        cluster, *others : int or str
            By number or name.

        Returns
        -------
        Library
            This one.
        """
        if not others:
            raise ParameterError("nothing to merge: name two clusters at least")
        with self._tables.editing():
            target, *same = self.numbers(cluster)
            moved = [*same, *(number for other in others for number in self.numbers(other))]
            self._tables.write(self._tables.edits.with_merge(target, moved))
        return self

    def split(self, cluster: int | str, recordings: Iterable[str]) -> int:
        """Make what a cluster has in some recordings a cluster of its own.

        Parameters
        ----------
        cluster : int or str
            By number or name.
        recordings : iterable of str
            By the names that they have in the library.

        Returns
        -------
        int
            The number of the new cluster.

        Raises
        ------
        ParameterError
            It is in none of these recordings, or in no other.
        """
        names = list(recordings)
        with self._tables.editing():
            (number, *_) = self.numbers(cluster)
            words = self._tables.columns("words")
            there = set(words["recording"][words["cluster"] == number].tolist())
            if not there.intersection(names) or there <= set(names):
                raise ParameterError(
                    f"cluster {number} is split by naming some, not all, of its {len(there)} "
                    f"recordings: {', '.join(sorted(there)[:5])}"
                )
            into: int = max(self.head["following"], self._tables.edits.following)
            self._tables.write(self._tables.edits.with_split(number, into, names))
        return into

    def path_of(self, recording: str) -> Path:
        """The file that a recording of the library was read from."""
        try:
            row = self.recordings["recording"].index(recording)
        except ValueError:
            raise ParameterError(f"no recording is called {recording!r:.60}") from None
        return Path(self.recordings["path"][row])

    def read(self, recording: str) -> Motion | Signals:
        """A recording of the library, read from its file as it was when the library was built.

        Parameters
        ----------
        recording : str
            Its name in the library.

        Returns
        -------
        Motion or Signals
        """
        return read(self.path_of(recording), **self.settings.reading)

    def __len__(self) -> int:
        return len(self.recordings["recording"])

    def __repr__(self) -> str:
        n, clusters = len(self), len(set(self._tables.columns("words")["cluster"].tolist()))
        return (
            f"<Library of {n} recording{'s' * (n != 1)} ({self.hours:.2g} h), "
            f"{clusters} cluster{'s' * (clusters != 1)}>"
        )

    def _typical(self, cluster: int | str) -> list[Example]:
        """The most typical words of a cluster as examples."""
        words = self._tables.columns("words")
        rows = np.flatnonzero(np.isin(words["cluster"], self.numbers(cluster)))
        rows = rows[np.argsort(words["spread"][rows], kind="stable")][:TYPICAL]
        columns = (words[name][rows].tolist() for name in ("recording", "start_s", "stop_s"))
        return [Example(*one) for one in zip(*columns, strict=True)]

    def _hit(self, row: int, start: int, stop: int, distance: float) -> Hit:
        """A span of a recording, samples, with the cluster of the segment that covers most of it.

        Of segments that cover as much, that of the finer level counts.
        """
        recording = self.recordings["recording"][row]
        fps, lasts = (self.recordings[name][row] for name in ("features_fps", "duration_s"))
        start_s, stop_s = start / fps, min(stop / fps, lasts)
        segments = self._tables.columns("segments")
        rows = slice(*self._tables.rows[recording])
        shared = np.minimum(segments["stop_s"][rows], stop_s)
        shared = np.round(shared - np.maximum(segments["start_s"][rows], start_s), 6)
        covers = int(np.lexsort((segments["level"][rows] == "primitive", shared))[-1])
        cluster = int(segments["cluster"][rows][covers])
        label = self._tables.edits.name(cluster) if cluster >= 0 else ""
        return Hit(recording, start_s, stop_s, round(distance, 4), cluster, label)


def _cell(value: object) -> object:
    """What stands in a table of text: nothing where nothing is known, and nothing that runs."""
    if isinstance(value, str):
        return as_text(value)
    return "" if value is None or value != value else value  # noqa: PLR0124 (nan)


def _as_segment(hit: Hit, recording: Motion | Signals) -> Segment:
    """A hit in frames of its recording, one at least."""
    fps, n = recording.fps, recording.n_frames
    start = min(round(hit.start_s * fps), n - 1)
    stop = min(max(round(hit.stop_s * fps), start + 1), n)
    span = (start, stop, start / fps, stop / fps)
    return Segment(
        "primitive", "activity", *span, hit.cluster, -1, hit.label, np.nan, hit.cluster, np.nan
    )
