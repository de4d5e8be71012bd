"""Pieces: what is kept of one recording, as it was found alone.

The segments with their embeddings are a Parquet file, whose metadata tell of the recording; its
features are a plain array beside it. The array is written first: where there is a Parquet file,
the piece is whole.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kineme._doors import reading
from kineme._files import atomic_write
from kineme.errors import ReadError
from kineme.library.layout import EMBEDDED, arrow, as_array, as_column
from kineme.segments.table import COLUMNS, DESCRIBED, SegmentTable

METADATA = b"kineme.library"
LARGEST = 1e30
"""Sum of the squares of all features of a recording; no distance overflows below it."""


@dataclass(frozen=True, eq=False)
class Piece:
    """What is kept of a recording.

    Attributes
    ----------
    facts : dict
        ``format``, ``n_frames``, ``fps``, ``vocabulary``, ``features_fps``, ``notes``.
    table : SegmentTable
        Its segments, with the clusters of this recording alone.
    embeddings : (segments, 32) array of float32
        Zero for those that were not embedded: transitions, and where there are no features.
    """

    facts: dict[str, Any]
    table: SegmentTable
    embeddings: NDArray[np.float32]


def write_piece(folder: Path, key: str, piece: Piece, features: NDArray[np.float32]) -> None:
    """Leave a piece, and the features (samples, dims) of its recording, in a folder."""
    pa, parquet = arrow()
    with atomic_write(folder / f"{key}.npy") as draft, draft.open("wb") as file:
        np.save(file, np.ascontiguousarray(features, np.float32), allow_pickle=False)
    values = as_column(piece.embeddings.ravel(), np.float32)
    embeddings = pa.FixedSizeListArray.from_arrays(values, EMBEDDED)
    columns = {
        name: as_column(column, DESCRIBED[name].type)
        for name, column in piece.table.columns().items()
    }
    table = pa.table({**columns, "embedding": embeddings})
    told = json.dumps(piece.facts, sort_keys=True).encode()
    with atomic_write(folder / f"{key}.parquet") as draft:
        parquet.write_table(
            table.replace_schema_metadata({METADATA: told}), draft, compression="zstd"
        )


def has_piece(folder: Path, key: str) -> bool:
    """Whether there is a whole piece of that name."""
    return (folder / f"{key}.parquet").is_file()


def read_piece(folder: Path, key: str) -> Piece:
    """The piece of that name.

    Raises
    ------
    ReadError
        It is gone or damaged.
    """
    pa, parquet = arrow()
    path = folder / f"{key}.parquet"
    with reading(path):
        table = parquet.ParquetFile(pa.BufferReader(path.read_bytes())).read()
        facts = json.loads(table.schema.metadata[METADATA])
        columns = {name: _column(table, name) for name in COLUMNS}
        flat: NDArray[Any] = np.from_dlpack(table.column("embedding").combine_chunks().flatten())
    return Piece(facts, SegmentTable(**columns), flat.reshape(-1, EMBEDDED))


def read_features(folder: Path, key: str) -> NDArray[np.float32]:
    """The matching features in a piece, float32 (samples, dims).

    Raises
    ------
    ReadError
        They are gone, as after a build that took the recording out, or damaged.
    """
    path = folder / f"{key}.npy"
    damaged = ReadError(path, "is damaged: remove it and build the library again")
    try:
        features: NDArray[np.float32] = np.load(path, allow_pickle=False)
    except FileNotFoundError as error:
        raise ReadError(path, "is gone: the library was built anew, open it again") from error
    except Exception as error:
        raise damaged from error
    if features.ndim != 2 or features.dtype != np.float32:
        raise damaged
    with np.errstate(all="ignore"):
        squares = float(np.vdot(features, features))  # one pass, and not finite if any of them is
    if not squares < LARGEST:
        raise damaged
    return features


def _column(table: Any, name: str) -> NDArray[Any]:
    column = as_array(table.column(name))
    return column.astype(np.str_) if column.dtype == object else column
