"""The tables of a library: what was computed over all recordings, as Parquet.

``DESCRIBED`` tells every column. Tables of one build lie in one folder, which is called by a digest
of what it holds; the head of the library names the valid one.
"""

from __future__ import annotations

import secrets
import shutil
from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path
from typing import Any

from kineme._doors import reading
from kineme._files import atomic_write
from kineme.errors import WriteError
from kineme.library.descriptions import EMBEDDED
from kineme.library.layout import TABLES, arrow
from kineme.segments.table import DESCRIBED as SEGMENTS

DESCRIBED: Mapping[str, Mapping[str, str]] = {
    "recordings": {
        "recording": "its name in the library: the path in the folder that was given",
        "path": "where it was read from",
        "vocabulary": "`bodies`, or which channels; empty where it cannot be searched",
        "format": "of its file",
        "n_frames": "frames of its file",
        "fps": "frames per second",
        "duration_s": "seconds",
        "piece": "name of the files in `pieces/` that hold what is kept of it",
        "features_fps": "samples of its features per second",
        "notes": "what had to be inferred, and what is unsure, one a line",
    },
    "segments": {
        "recording": "the recording it is of",
        "segment": "its row among those of the recording, from 0",
        **{name: column.meaning for name, column in SEGMENTS.items()},
        "own_cluster": "its cluster in the recording alone",
        "action_label": "the name of `action`",
    },
    "words": {
        "recording": "the recording it is of",
        "own_cluster": "the cluster in that recording",
        "cluster": "the cluster of the library",
        "label": "the name of that, or empty",
        "following": "the cluster that it would be in if there were not this one; -1: none",
        "confidence": "how much nearer it is to its cluster than to the next, 0 to 1",
        "spread": "mean distance to the other words of its cluster",
        "start_s": "where its typical segment starts",
        "stop_s": "where that stops",
        "seconds": "of all its segments",
    },
    "embeddings": {
        "recording": "the recording it is of",
        "segment": "its row among those of the recording, from 0",
        "embedding": f"{EMBEDDED} numbers: what is near is alike",
    },
}
"""The columns of each table, and what is in them."""


def write_tables(folder: Path, tables: Mapping[str, Any]) -> str:
    """Leave tables in the folder of a library; the name under which they lie there.

    Parameters
    ----------
    folder : Path
    tables : mapping of str to pyarrow.Table

    Returns
    -------
    str
    """
    _, parquet = arrow()
    home = folder / TABLES
    draft = home / f".{secrets.token_hex(6)}"
    try:
        draft.mkdir(parents=True)
        digest = sha256()
        for name, table in tables.items():
            with atomic_write(draft / f"{name}.parquet") as file:
                parquet.write_table(table, file, compression="zstd")
            digest.update((draft / f"{name}.parquet").read_bytes())
        named = digest.hexdigest()[:16]
        if not (home / named).is_dir():
            draft.rename(home / named)
    except OSError as error:
        raise WriteError(folder, f"cannot be written: {error.strerror or error}") from error
    finally:
        shutil.rmtree(draft, ignore_errors=True)
    return named


def read_table(folder: Path, named: str, name: str) -> Any:
    """One of the tables, a pyarrow.Table.

    Parameters
    ----------
    folder : Path
    named : str
        The tables that the head of the library names.
    name : str
        Of the table.

    Raises
    ------
    ReadError
        It is gone or damaged.
    """
    pa, parquet = arrow()
    path = folder / TABLES / named / f"{name}.parquet"
    with reading(path):
        return parquet.read_table(pa.BufferReader(path.read_bytes()))
