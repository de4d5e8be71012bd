"""Read and write the tables, analyses and search index of a library.

**Tables** are Parquet files with results over all recordings. ``DESCRIBED`` documents every column.
The tables of a build lie in one folder, which is named by a digest of its content; the head of the
library names the current one.

**Analyses** are the results of one recording on its own. A Parquet file holds the segments with
their embeddings, and facts about the recording as metadata. Features, their windows for an index,
and samples of channels are npy files beside it. These are written first: if the Parquet file
exists, the analysis is complete.

**The search index** holds the windows of all recordings, beside the tables.
``windows.LENGTH.npy`` holds the windows of one length, in the order of the table of recordings.
Libraries below `FROM_HOURS` have no index: they are searched as a whole.
"""

from __future__ import annotations

import json
import re
import secrets
import shutil
from collections.abc import Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from hashlib import sha256
from io import BytesIO
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import IO, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kineme._util.arrays import Ints
from kineme._util.files import (
    OwnedFolder,
    atomic_write,
    is_draft,
    is_remote,
    translate_read_errors,
)
from kineme._util.json import decode_json
from kineme.errors import ReadError, WriteError
from kineme.library.storage.layout import (
    ANALYSES,
    BODIES,
    EMBEDDED,
    KEY_LENGTH,
    TABLES,
    as_array,
    as_column,
    copy_nearby,
    import_arrow,
    write_locally,
)
from kineme.library.windows import (
    LENGTHS,
    NUMBERS,
    Bytes,
    count_windows,
    describe_all_windows,
    group_by_length,
)
from kineme.segments.table import COLUMNS, Column, SegmentTable
from kineme.transfer.embeddings import thin_samples

DESCRIBED: Mapping[str, Mapping[str, Column]] = {
    "recordings": {
        "recording": Column("name in the library: the path below its source"),
        "path": Column("where it was read from"),
        "vocabulary": Column("`bodies`, or the names of channels; empty: not searched"),
        "format": Column("format of the file"),
        "n_frames": Column("frames in the file", int),
        "fps": Column("frames per second", float),
        "duration_s": Column("seconds", float),
        "piece": Column("name of its files in `pieces/`"),
        "features_fps": Column("feature samples per second", float),
        "samples": Column("number of feature samples; 0: not searched", int),
        "notes": Column("what was inferred and what is uncertain, one a line"),
    },
    "segments": {
        "recording": Column("the recording"),
        "segment": Column("its row in the table of the recording, from 0", int),
        **COLUMNS,
        "own_cluster": Column("its cluster in the recording alone", int),
        "action_label": Column("the name of `action`"),
    },
    "local_clusters": {
        "recording": Column("the recording"),
        "own_cluster": Column("cluster in that recording", int),
        "cluster": Column("cluster of the library", int),
        "label": Column("name of `cluster`, or empty"),
        "next_cluster": Column("nearest other cluster; -1: none", int),
        "confidence": Column("how much nearer `cluster` is than `next_cluster`, 0 to 1", float),
        "spread": Column("mean distance from the other members of `cluster`", float),
        "start_s": Column("start of its typical segment", float),
        "stop_s": Column("stop of its typical segment", float),
        "seconds": Column("total duration of its segments", float),
    },
    "embeddings": {
        "recording": Column("the recording"),
        "segment": Column("its row in the table of the recording, from 0", int),
        "embedding": Column(f"{EMBEDDED} numbers, near each other for similar segments", float),
    },
}
"""Columns of each table with edits applied, and their descriptions."""
_FOLDER = re.compile(r"[0-9a-f]{16}|\.[0-9a-f]{12}")
"""Matches folders of tables, and drafts of them."""
_WINDOWS = re.compile(r"windows\.\d+\.npy")
LARGEST = 1e30
"""Largest absolute value in a table."""
ADDED = ("label", "action_label")
"""Columns that `apply_edits` adds if a table lacks them."""
METADATA = b"kineme.library"
FEATURES, WINDOWS, SAMPLES = ".npy", ".windows.npy", ".moments.npy"
_FILE = re.compile(rf"[0-9a-f]{{{KEY_LENGTH}}}(\.parquet|(\.windows|\.moments)?\.npy)")
LARGEST_SUM = 1e30
"""Largest sum of squares of a recording's features for which no distance overflows."""
LARGEST_SAMPLE = 1e18
"""Largest absolute value in the samples of channels."""
FROM_HOURS = 100.0
"""Hours of recordings of bodies from which on a library has an index."""


def is_tables_folder(name: str) -> bool:
    """Return whether a folder name is that of a build's tables."""
    return _FOLDER.fullmatch(name) is not None


def is_table_file(name: str) -> bool:
    """Return whether a file name in such a folder is that of a table, an index or a draft."""
    stem, _, suffix = name.partition(".")
    table = stem in DESCRIBED and suffix == "parquet"
    return table or is_draft(name) or _WINDOWS.fullmatch(name) is not None


def make_table(name: str, columns: Mapping[str, Any]) -> Any:
    """Return computed columns as a pyarrow.Table with the declared types, even without rows.

    Embeddings must be a pyarrow.Array.
    """
    pa, _ = import_arrow()
    return pa.table(
        {
            column: columns[column]
            if column == "embedding"
            else as_column(columns[column], declared.type)
            for column, declared in DESCRIBED[name].items()
            if column in columns
        }
    )


def write_tables(folder: Path, tables: Mapping[str, Any]) -> str:
    """Write tables to the folder of a library and return the name of their folder."""
    _, parquet = import_arrow()
    home = folder / TABLES
    if is_remote(home):
        return _upload_tables(home, tables)
    draft = home / f".{secrets.token_hex(6)}"
    try:
        draft.mkdir(parents=True)
        digest = sha256()
        for name, table in tables.items():
            with atomic_write(draft / f"{name}.parquet") as file:
                parquet.write_table(table, file, compression="zstd")
            digest.update((draft / f"{name}.parquet").read_bytes())
        folder_name = digest.hexdigest()[:16]
        if not OwnedFolder(folder).path(TABLES, folder_name).is_dir():
            draft.rename(home / folder_name)
    except OSError as error:
        raise WriteError(folder, f"cannot be written: {error.strerror or error}") from error
    finally:
        shutil.rmtree(draft, ignore_errors=True)
    return folder_name


def _upload_tables(home: Path, tables: Mapping[str, Any]) -> str:
    """Upload tables file by file, since remote folders cannot be renamed; return their name.

    This is safe because the head names the tables only after all files exist.
    """
    with TemporaryDirectory(prefix="kineme-") as local_folder:
        folder_name = write_tables(Path(local_folder), tables)
        for file in sorted((Path(local_folder) / TABLES / folder_name).iterdir()):
            with write_locally(home / folder_name / file.name) as draft:
                shutil.copy(file, draft)
    return folder_name


def read_table(folder: Path, folder_name: str, name: str) -> Any:
    """Read a table from the folder of tables ``named``, as a pyarrow.Table."""
    path = folder / TABLES / folder_name / f"{name}.parquet"
    with translate_read_errors(path):
        table = _read_parquet(path)
        table.validate(full=True)
    for column, declared in DESCRIBED[name].items():
        times = table.column_names.count(column)
        if times > 1 or (times == 0 and column not in ADDED):
            fault = "holds twice" if times else "lacks"
            raise ReadError(path, f"is damaged: it {fault} {column!r}; build the library again")
        if times and not _is_valid(table.column(column), declared.type):
            raise ReadError(path, f"is damaged in {column!r}; build the library again")
    return table


def _read_parquet(path: Path) -> Any:
    pa, parquet = import_arrow()
    content = pa.BufferReader(path.read_bytes())
    return parquet.ParquetFile(content).read(use_threads=False)  # see `import_arrow`


def find_rows(table: Any) -> dict[str, slice]:
    """Return the rows of each recording in a table of segments, which are grouped by recording."""
    names = table.column("recording").combine_chunks().dictionary_encode()
    # Borders are where the dictionary code changes.
    codes = np.from_dlpack(names.indices)
    edges = [*np.flatnonzero(np.diff(codes, prepend=-1)).tolist(), len(codes)]
    recordings = names.dictionary.to_pylist()
    return {recordings[codes[a]]: slice(a, b) for a, b in pairwise(edges)}


def _is_valid(column: Any, kind: type) -> bool:
    """Return whether a column has its type, a value in every row, and no huge numbers."""
    pa, _ = import_arrow()
    types = {str: pa.string(), int: pa.int64(), float: pa.float64()}
    if column.null_count:
        return False
    if pa.types.is_fixed_size_list(column.type):
        return bool(column.type.value_type == pa.float32() and column.type.list_size == EMBEDDED)
    if column.type != types[kind]:
        return False
    return kind is not float or not (np.abs(as_array(column)) > LARGEST).any()


@dataclass(frozen=True, eq=False)
class Analysis:
    """Stored results of a recording."""

    facts: dict[str, Any]
    """About the recording and its features; see `kineme.library.descriptions.make_analysis`."""
    table: SegmentTable
    """Its segments, with the clusters of this recording alone."""
    embeddings: NDArray[np.float32]
    """(segments, 32); zero for transitions, and for recordings without features."""


def write_analysis(
    folder: Path,
    key: str,
    analysis: Analysis,
    features: NDArray[np.float32],
    channel_samples: NDArray[np.float32] | None = None,
) -> None:
    """Write an analysis with features (samples, dims) and samples of channels to a folder."""
    pa, parquet = import_arrow()
    values = np.ascontiguousarray(features, np.float32)
    arrays: dict[str, NDArray[Any]] = {FEATURES: values}
    if analysis.facts["vocabulary"] == BODIES:
        arrays[WINDOWS] = describe_all_windows(values)
    if channel_samples is not None:
        arrays[SAMPLES] = channel_samples
    for suffix, array in arrays.items():
        buffer = BytesIO()  # np.save into a file would not report a full disk
        np.save(buffer, array, allow_pickle=False)
        with write_locally(folder / f"{key}{suffix}") as draft:
            draft.write_bytes(buffer.getbuffer())
    flat = as_column(analysis.embeddings.ravel(), np.float32)
    embeddings = pa.FixedSizeListArray.from_arrays(flat, EMBEDDED)
    columns = {
        name: as_column(column, COLUMNS[name].type)
        for name, column in analysis.table.columns().items()
    }
    table = pa.table({**columns, "embedding": embeddings})
    facts = json.dumps(analysis.facts, sort_keys=True).encode()
    with write_locally(folder / f"{key}.parquet") as draft:
        parquet.write_table(
            table.replace_schema_metadata({METADATA: facts}), draft, compression="zstd"
        )


def is_analysis(name: str) -> bool:
    """Return whether a file name is that of an analysis."""
    return _FILE.fullmatch(name) is not None


def has_analysis(folder: Path, key: str) -> bool:
    """Return whether the complete analysis with this key exists."""
    return (folder / f"{key}.parquet").is_file()


def read_analysis(folder: Path, key: str) -> Analysis:
    """Read the analysis with this key."""
    path = folder / f"{key}.parquet"
    with translate_read_errors(path):
        table = _read_parquet(path)
        facts = decode_json(table.schema.metadata[METADATA], path, dict[str, Any])
        columns = {name: _read_column(table, name) for name in COLUMNS}
        flat: NDArray[Any] = np.from_dlpack(table.column("embedding").combine_chunks().flatten())
    return Analysis(facts, SegmentTable(**columns), flat.reshape(-1, EMBEDDED))


def read_features(folder: Path, key: str) -> NDArray[np.float32]:
    """Read the matching features of an analysis, float32 (samples, dims)."""
    features: NDArray[np.float32] = _read_array(folder / f"{key}{FEATURES}", np.float32)
    return features


def read_windows(folder: Path, key: str) -> NDArray[np.int8]:
    """Read the windows of an analysis, the result of `describe_all_windows`."""
    windows: NDArray[np.int8] = _read_array(folder / f"{key}{WINDOWS}", np.int8)
    return windows


def read_spans(
    folder: Path, key: str, spans: Iterable[tuple[int, int]]
) -> Iterator[NDArray[np.float32]]:
    """Yield the features of an analysis in each of several spans of samples."""
    path = folder / f"{key}{FEATURES}"
    with _open_array(path), copy_nearby(path).open("rb", buffering=0) as file:
        offset, dims = _read_header(file)
        for first, stop in spans:
            part = np.empty((stop - first, dims), np.float32)
            file.seek(offset + part.itemsize * dims * first)
            if file.readinto(part.data) != part.nbytes:
                raise ValueError("shorter than was written")
            _check_plausible(part)
            yield part


def read_channel_samples(folder: Path, key: str, step: int = 1) -> NDArray[np.float32]:
    """Read every ``step``-th channel sample of an analysis: second, means, deviations."""
    path = folder / f"{key}{SAMPLES}"
    with _open_array(path):
        rows: NDArray[np.float32] = np.load(copy_nearby(path), mmap_mode="r", allow_pickle=False)
        rows = np.array(thin_samples(rows, step))
        if rows.ndim != 2 or rows.dtype != np.float32 or not len(rows) or rows.shape[1] % 2 == 0:
            raise ValueError("not samples of channels")
        deviations = rows[:, 1 + rows.shape[1] // 2 :]
        if not ((np.abs(rows) <= LARGEST_SAMPLE).all() and (deviations >= 0).all()):
            raise ValueError("samples that no recording has")
    return rows


def _read_header(file: IO[bytes]) -> tuple[int, int]:
    """Return the offset of the rows in an npy file, and the float32 values per row."""
    # Bytes 8 and 9 of an npy file (version 1) hold the length of its header.
    length = int.from_bytes(file.read(10)[8:], "little")
    header = re.search(rb"'descr': '<f4'.*'shape': \(\d+, (\d+)\)", file.read(length))
    if header is None:
        raise ValueError("not rows of features")
    return 10 + length, int(header[1])


def _read_array(path: Path, kind: type[np.number[Any]]) -> NDArray[Any]:
    with _open_array(path):
        rows: NDArray[Any] = np.load(copy_nearby(path), allow_pickle=False)
        if rows.ndim != 2 or rows.dtype != kind:
            raise ValueError(
                f"holds {rows.dtype} of shape {rows.shape}, not rows of {np.dtype(kind)}"
            )
        if kind is np.float32:  # integers cannot be nan or overflow a distance
            _check_plausible(rows)
    return rows


def _check_plausible(features: NDArray[np.float32]) -> None:
    squares = float(np.vdot(features, features))  # not finite if any value is not
    if not squares < LARGEST_SUM:
        raise ValueError("features that no recording has")


@contextmanager
def _open_array(path: Path) -> Iterator[None]:
    """Turn errors while reading an array of an analysis into ReadError."""
    try:
        yield
    except FileNotFoundError as error:
        raise ReadError(
            path, "was removed when the library was built again: open it again"
        ) from error
    except Exception as error:
        raise ReadError(path, "is damaged: remove it and build the library again") from error


def _read_column(table: Any, name: str) -> NDArray[Any]:
    column = as_array(table.column(name))
    return column.astype(np.str_) if column.dtype == object else column


class Windows(NamedTuple):
    """Windows of one length: ``embedded`` (windows, 32) is memory-mapped."""

    length: int
    embedded: Bytes
    firsts: Ints
    """First window of each recording, and the total number."""
    samples: Ints
    """Number of feature samples of each recording."""


def write_index(folder: Path, tables: str, recordings: dict[str, list[Any]]) -> None:
    """Write an index beside the tables of that name, if the library is large enough."""
    samples = _list_samples(recordings)
    rates = zip(samples.tolist(), recordings["features_fps"], strict=True)
    if sum(n / fps for n, fps in rates if n) < FROM_HOURS * 3600:
        return
    home = folder / TABLES / tables
    if all(_make_path(home, length).is_file() for length in LENGTHS):
        return
    with ExitStack() as stack:
        drafts = {
            length: np.lib.format.open_memmap(
                stack.enter_context(write_locally(_make_path(home, length))),
                mode="w+",
                dtype=np.int8,
                shape=(int(count_windows(samples, length).sum()), NUMBERS),
            )
            for length in LENGTHS
        }
        firsts = dict.fromkeys(LENGTHS, 0)
        # Write into memory-mapped files, since all windows may not fit into memory.
        for row in np.flatnonzero(samples):
            windows = read_windows(folder / ANALYSES, recordings["piece"][row])
            for length, part in group_by_length(windows, int(samples[row])):
                drafts[length][firsts[length] : firsts[length] + len(part)] = part
                firsts[length] += len(part)
        for draft in drafts.values():
            draft.flush()


def open_index(
    folder: Path, tables: str, recordings: dict[str, list[Any]], length: int
) -> Windows | None:
    """Return the windows of one length, or None if the library has no index."""
    path = _make_path(folder / TABLES / tables, length)
    try:
        embedded: Bytes = np.load(copy_nearby(path), mmap_mode="r", allow_pickle=False)
    except FileNotFoundError:
        return None
    except (OSError, ValueError) as error:
        raise ReadError(path, "is damaged: remove it and build the library again") from error
    samples = _list_samples(recordings)
    firsts = np.concatenate([[0], np.cumsum(count_windows(samples, length))])
    if embedded.shape != (firsts[-1], NUMBERS) or embedded.dtype != np.int8:
        raise ReadError(path, "is damaged: remove it and build the library again")
    return Windows(length, embedded, firsts, samples)


def _list_samples(recordings: dict[str, list[Any]]) -> Ints:
    """Return the number of samples of each recording, 0 for those that are not bodies."""
    bodies = np.array(recordings["vocabulary"], object) == BODIES
    return np.where(bodies, np.array(recordings["samples"], np.int64), 0)


def _make_path(home: Path, length: int) -> Path:
    return home / f"windows.{length}.npy"
