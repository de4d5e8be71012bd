"""Knowledge bases as files: one ``.npz``, a zip of plain numpy arrays, no pickle.

============ ================ ==================================================
``head``     text             JSON: ``schema`` (``kineme.knowledge/2``), ``kineme``
                              (version that wrote it), ``fps``, ``offsets_s`` and
                              ``unit`` of the features
``features`` float32 (n, 40)  frames of all primitives end to end, unit vectors
``lengths``  int64            frames of each primitive; the others go with it
``labels``   text             its name
``sources``  text             file name of the recording
``digests``  text             SHA-256 of the file, with the person of several, or empty
``start_s``  float64          where it starts in the recording, seconds
``stop_s``   float64          where it stops
============ ================ ==================================================

Any program with numpy reads it. A reader ignores arrays it does not know; a
change that old readers would misunderstand gets the next number.
"""

from __future__ import annotations

import json
import zipfile
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kineme._util.files import atomic_write
from kineme._util.json import decode_json
from kineme._version import __version__
from kineme.errors import ReadError, WriteError
from kineme.formats.arrays.numpy_files import members
from kineme.formats.files import load

SCHEMA = "kineme.knowledge/2"
KINDS = {
    "features": "f",
    "lengths": "i",
    "labels": "U",
    "sources": "U",
    "digests": "U",
    "start_s": "f",
    "stop_s": "f",
}
TYPES = {"features": np.float32, "lengths": np.int64}


def write(
    arrays: dict[str, NDArray[Any]], settings: dict[str, Any], path: str | PathLike[str]
) -> None:
    """Leave a knowledge base's arrays at ``path``; ``settings`` are those of its features."""
    if Path(path).suffix.lower() != ".npz":
        raise WriteError(path, "a knowledge base is a .npz file: name it so")
    head = json.dumps({"schema": SCHEMA, "kineme": __version__, **settings})
    with atomic_write(path) as draft, draft.open("wb") as file:
        np.savez(file, allow_pickle=False, head=np.array(head), **arrays)


def read(path: str | PathLike[str], settings: dict[str, Any]) -> dict[str, NDArray[Any]]:
    """The arrays of the knowledge base at ``path``, whose features must have these settings."""
    if not Path(path).exists():
        raise ReadError(path, "cannot be read: there is no such file")
    content = load(path)
    try:
        found = members(content)
        head = decode_json(str(found["head"]), path)
    except KeyError as error:
        raise ReadError(path, "is not a knowledge base: it has no head") from error
    except (ReadError, ValueError) as error:
        reason = f": {error.reason}" if isinstance(error, ReadError) else ""
        raise ReadError(path, f"is not a knowledge base, or is damaged{reason}") from error
    _check_head(head, settings, path)
    if missing := [name for name in KINDS if name not in found]:
        raise ReadError(path, f"is not a knowledge base, or is damaged: it has no {missing[0]!r}")
    arrays = {name: found[name] for name in KINDS}
    for name, kind in KINDS.items():
        if arrays[name].dtype.kind != kind:
            raise ReadError(path, f"is damaged: {name} holds {arrays[name].dtype}")
    return arrays | {name: arrays[name].astype(kind) for name, kind in TYPES.items()}


def _check_head(head: Any, settings: dict[str, Any], path: str | PathLike[str]) -> None:
    schema = head.get("schema") if isinstance(head, dict) else head
    if schema != SCHEMA:
        reason = f"is of version {schema!r}, this kineme reads {SCHEMA}: label its recordings again"
        raise ReadError(path, reason)
    for name, value in settings.items():
        if head.get(name) != value:
            reason = f"has features with {name} {head.get(name)}, not {value}: build it again"
            raise ReadError(path, reason)


def holds_knowledge(path: Path) -> bool:
    """Return whether a file is a knowledge base, as far as the directory of its archive tells."""
    if path.suffix.lower() != ".npz":
        return False
    try:
        with zipfile.ZipFile(path) as parts:
            return {"head.npy", "lengths.npy", "labels.npy"} <= set(parts.namelist())
    except (OSError, zipfile.BadZipFile, NotImplementedError, ValueError, LookupError):
        return False
