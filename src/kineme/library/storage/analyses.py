"""Analyses: what is kept of one recording, as it was found alone.

The segments with their embeddings are a Parquet file, whose metadata tell of the recording; its
features, their windows for an index, and the samples of channels are plain arrays beside it. These
are written first: where there is a Parquet file, the analysis is whole.
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
"""Characters of the name of an analysis; see `kineme.library.planning.make_analysis_key`."""
_FILE = re.compile(rf"[0-9a-f]{{{KEY_LENGTH}}}(\.parquet|(\.windows|\.moments)?\.npy)")
LARGEST = 1e30
"""Sum of the squares of all features of a recording; no distance overflows below it."""
LARGEST_SAMPLE = 1e18
"""Of any number in the samples of channels."""


@dataclass(frozen=True, eq=False)
class Analysis:
    """What is kept of a recording.

    Attributes
    ----------
    facts : dict
        Of the recording and its features; see `kineme.library.descriptions.make_analysis`.
    table : SegmentTable
        Its segments, with the clusters of this recording alone.
    embeddings : (segments, 32) array of float32
        Zero for those that were not embedded: transitions, and where there are no features.
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
    """Leave an analysis in a folder, with features (samples, dims) and samples of channels."""
    pa, parquet = import_arrow()
    values = np.ascontiguousarray(features, np.float32)
    arrays: dict[str, NDArray[Any]] = {FEATURES: values}
    if analysis.facts["vocabulary"] == BODIES:
        arrays[WINDOWS] = describe_all_windows(values)
    if channel_samples is not None:
        arrays[SAMPLES] = channel_samples
    for suffix, array in arrays.items():
        buffer = BytesIO()  # into a file itself, numpy does not tell that the disk is full
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
    """Return whether a file of an analysis is named so."""
    return _FILE.fullmatch(name) is not None


def has_analysis(folder: Path, key: str) -> bool:
    """Return whether there is a whole analysis of that name."""
    return (folder / f"{key}.parquet").is_file()


def read_analysis(folder: Path, key: str) -> Analysis:
    """Return the analysis of that name."""
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
    """Return the matching features in an analysis, float32 (samples, dims)."""
    features: NDArray[np.float32] = _read_array(folder / f"{key}{FEATURES}", np.float32)
    return features


def read_windows(folder: Path, key: str) -> NDArray[np.int8]:
    """Return the windows of these features, as `describe_all_windows` gives them."""
    windows: NDArray[np.int8] = _read_array(folder / f"{key}{WINDOWS}", np.int8)
    return windows


def read_parts(
    folder: Path, key: str, starts: Iterable[int], into: Iterable[NDArray[np.float32]]
) -> None:
    """Fill arrays (samples, dims) with the features in an analysis, each from a sample on."""
    with _open_features(folder, key) as (file, start, _):
        _read_rows(file, start, starts, into)


def read_spans(
    folder: Path, key: str, spans: Sequence[tuple[int, int]]
) -> list[NDArray[np.float32]]:
    """Return the features in an analysis from some samples to others."""
    with _open_features(folder, key) as (file, start, dims):
        parts = [np.empty((stop - first, dims), np.float32) for first, stop in spans]
        _read_rows(file, start, [first for first, _ in spans], parts)
    return parts


def read_channel_samples(folder: Path, key: str, step: int = 1) -> NDArray[np.float32]:
    """The samples of channels in an analysis, one of each ``step``: second, means, deviations."""
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
    """Where the rows of an npy file begin, and how many float32 numbers each has."""
    length = int.from_bytes(file.read(10)[8:], "little")
    header = re.search(rb"'descr': '<f4'.*'shape': \(\d+, (\d+)\)", file.read(length))
    if header is None:
        raise ValueError("not rows of features")
    return 10 + length, int(header[1])


def _read_rows(
    file: IO[bytes], start: int, firsts: Iterable[int], parts: Iterable[NDArray[np.float32]]
) -> None:
    """Rows of an npy file from some samples on."""
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
    squares = float(np.vdot(features, features))  # one pass, not finite if any of them is not
    if not squares < LARGEST:
        raise ValueError("features that no recording has")


@contextmanager
def _open_features(folder: Path, key: str) -> Iterator[tuple[IO[bytes], int, int]]:
    """A block that reads features of an analysis: their file, where they begin in it, and dims."""
    path = folder / f"{key}{FEATURES}"
    with _open_array(path), copy_nearby(path).open("rb", buffering=0) as file:
        yield file, *_read_header(file)


@contextmanager
def _open_array(path: Path) -> Iterator[None]:
    """A block that reads an array of an analysis, or ends in a ReadError."""
    try:
        yield
    except FileNotFoundError as error:
        raise ReadError(path, "is gone: the library was built anew, open it again") from error
    except Exception as error:
        raise ReadError(path, "is damaged: remove it and build the library again") from error


def _read_column(table: Any, name: str) -> NDArray[Any]:
    column = as_array(table.column(name))
    return column.astype(np.str_) if column.dtype == object else column
