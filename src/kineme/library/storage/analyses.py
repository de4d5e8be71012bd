"""Read and write analyses: the stored results of one recording on its own.

A Parquet file holds the segments with their embeddings, and facts about the recording as metadata.
Features, their windows for an index, and samples of channels are npy files beside it. These are
written first: if the Parquet file exists, the analysis is complete.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from kineme._util.files import translate_read_errors
from kineme._util.json import decode_json
from kineme.errors import ReadError
from kineme.library.storage.layout import BODIES, EMBEDDED, as_array, as_column, import_arrow
from kineme.library.storage.places import copy_nearby, write_locally
from kineme.library.windows import describe_all_windows
from kineme.segments.table import COLUMNS, SegmentTable
from kineme.transfer.channel_samples import thin_samples

METADATA = b"kineme.library"
FEATURES, WINDOWS, SAMPLES = ".npy", ".windows.npy", ".moments.npy"
KEY_LENGTH = 32
"""Length of the key of an analysis; see `kineme.library.planning.make_analysis_key`."""
_FILE = re.compile(rf"[0-9a-f]{{{KEY_LENGTH}}}(\.parquet|(\.windows|\.moments)?\.npy)")
LARGEST_SUM = 1e30
"""Largest sum of squares of a recording's features for which no distance overflows."""
LARGEST_SAMPLE = 1e18
"""Largest absolute value in the samples of channels."""


@dataclass(frozen=True, eq=False)
class Analysis:
    """Stored results of a recording.

    Attributes
    ----------
    facts : dict
        About the recording and its features; see `kineme.library.descriptions.make_analysis`.
    table : SegmentTable
        Its segments, with the clusters of this recording alone.
    embeddings : (segments, 32) array of float32
        Zero for transitions, and for recordings without features.
    """

    facts: dict[str, Any]
    table: SegmentTable
    embeddings: NDArray[np.float32]


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
    pa, parquet = import_arrow()
    path = folder / f"{key}.parquet"
    with translate_read_errors(path):
        content = pa.BufferReader(path.read_bytes())
        table = parquet.ParquetFile(content).read(use_threads=False)  # see `import_arrow`
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


def read_parts(
    folder: Path, key: str, starts: Iterable[int], into: Iterable[NDArray[np.float32]]
) -> None:
    """Read features of an analysis into arrays (samples, dims), each from a first sample on."""
    with _open_features(folder, key) as (file, start, _):
        _read_rows(file, start, starts, into)


def read_spans(
    folder: Path, key: str, spans: Sequence[tuple[int, int]]
) -> list[NDArray[np.float32]]:
    """Read the features of an analysis in several spans of samples."""
    with _open_features(folder, key) as (file, start, dims):
        parts = [np.empty((stop - first, dims), np.float32) for first, stop in spans]
        _read_rows(file, start, [first for first, _ in spans], parts)
    return parts


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


def _read_rows(
    file: IO[bytes], start: int, firsts: Iterable[int], parts: Iterable[NDArray[np.float32]]
) -> None:
    """Read rows of an npy file into ``parts``, each from a first row on."""
    for first, part in zip(firsts, parts, strict=True):
        file.seek(start + part.itemsize * part.shape[1] * first)
        if file.readinto(part) != part.nbytes:  # type: ignore[attr-defined]
            raise ValueError("shorter than was written")
        _check_plausible(part)


def _read_array(path: Path, kind: type[np.number[Any]]) -> NDArray[Any]:
    with _open_array(path):
        rows: NDArray[Any] = np.load(copy_nearby(path), allow_pickle=False)
        if rows.ndim != 2 or rows.dtype != kind:
            raise ValueError("not rows of features")
        if kind is np.float32:  # integers cannot be nan or overflow a distance
            _check_plausible(rows)
    return rows


def _check_plausible(features: NDArray[np.float32]) -> None:
    squares = float(np.vdot(features, features))  # not finite if any value is not
    if not squares < LARGEST_SUM:
        raise ValueError("features that no recording has")


@contextmanager
def _open_features(folder: Path, key: str) -> Iterator[tuple[IO[bytes], int, int]]:
    """Open the features of an analysis: the file, the byte at which rows begin, and dims."""
    path = folder / f"{key}{FEATURES}"
    with _open_array(path), copy_nearby(path).open("rb", buffering=0) as file:
        yield file, *_read_header(file)


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
