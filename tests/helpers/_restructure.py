"""Change the content of files but keep their syntax, for fuzzing.

JSON gets other values, keys and shapes; tables get other cells, rows and columns; words of BVH,
ASF and AMC change places; arrays and Parquet columns get other types. In all other files, bytes
are damaged.
"""

from __future__ import annotations

import copy
import io
import json
import math
import random
import re
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from _damage import damage_bytes

ODD: list[Any] = [
    None, True, False, 0, -1, 1, 2, 0.5, -0.0, 1e-320, 1e300, -1.7e308, math.nan, math.inf,
    -math.inf, 2**31, 2**53, 2**63, 2**64, -(2**63), 10**400, "", " ", "nan", "1e999", "0x10",
    "\uff11", "=1+1", "a\nb", "\ud800", "\u202e", "é" * 300, "9" * 5000, [], {}, [[]], [None],
    {"": None}, [1, [2, [3]]],
]  # fmt: skip
CELLS = [
    "", " ", "nan", "NaN", "inf", "-inf", "1e300", "-1e-320", "1,5", "1.5.2", "0x1F", "\uff11",
    "--3", "+4", "1_000", "2026-01-31T09:30:00.25", "09:30:00", "1970-01-01", "99999-99-99",
    "9" * 400, '"', '""', "'", "=1+1", "\ufeff", "\u2028", "\x1c", "\x85", "\x0b", "#", "time",
    "frame", "x", "label", "start", "stop", "é",
]  # fmt: skip
WORDS = [
    "HIERARCHY", "ROOT", "JOINT", "End", "Site", "{", "}", "OFFSET", "CHANNELS", "MOTION",
    "Frames:", "Frame", "Time:", "Xposition", "Zrotation", ":root", ":bonedata", ":hierarchy",
    ":units", "begin", "end", "dof", "rx", "tx", "limits", "axis", "XYZ", "direction", "length",
    "root", "order", ":DEGREES", "#", "0", "-1", "1e300", "1e-320", "nan", "3",
]  # fmt: skip
TYPES = ("f2", "f4", "i1", "u8", ">f8", "c16", "S8", "U4", "?")
SHAPES = ((-1,), (1, -1), (-1, 1), (1, 1, 1, -1))
UNWRITABLE = (ValueError, TypeError, ArithmeticError, NotImplementedError, LookupError)
Chance = random.Random


def change_structure(path: Path, data: bytes, seed: int) -> bytes:
    """Return a file with other content, or with damaged bytes if its syntax is unknown."""
    chance = random.Random(seed)
    change = CHANGES.get(path.suffix.lower())
    if change is None:
        return damage_bytes(data, seed)
    try:
        with np.errstate(all="ignore"):
            for _ in range(chance.randint(1, 3)):
                data = change(data, chance)
    except UNWRITABLE:
        return data  # the value cannot be written there
    return data


def _change_json(data: bytes, chance: Chance) -> bytes:
    """Change, move, repeat or delete a value or key anywhere in the tree."""
    tree = json.loads(data)
    places: list[tuple[Any, Any]] = []
    waiting = [tree]
    while waiting:
        node = waiting.pop()
        inner: Any = enumerate(node) if isinstance(node, list) else ()
        inner = node.items() if isinstance(node, dict) else inner
        for key, value in inner:
            places.append((node, key))
            waiting.append(value)
    if not places:
        return json.dumps(chance.choice(ODD)).encode("utf-8", "surrogatepass")
    node, key = chance.choice(places)
    what = chance.randrange(6)
    if what == 0:
        del node[key]
    elif what == 1:
        node[key] = copy.deepcopy(chance.choice(places)[0])
    elif what == 2 and isinstance(node, list):
        node[key:key] = [node[key]] * chance.choice((1, 2, 300))
    elif what == 3 and isinstance(node, dict):
        node[chance.choice(("", "x", "fps", "label", "schema", "a" * 999))] = node.pop(key)
    elif what == 4:
        node[key] = [node[key]]
    else:
        node[key] = copy.deepcopy(chance.choice(ODD))
    return json.dumps(tree).encode("utf-8", "surrogatepass")


def _change_cells(data: bytes, chance: Chance) -> bytes:
    """Change cells, rows or columns of a table."""
    text = data.decode("utf-8", "replace")
    between = max("\t,; ", key=text.count)
    rows = [line.split(between) for line in text.split("\n")]
    at = chance.choice((0, 1, 2, 3, 4, 5, chance.randrange(len(rows)))) % len(rows)
    row = rows[at]
    column = chance.randrange(len(row))
    what = chance.randrange(7)
    if what <= 1:
        row[column] = chance.choice(CELLS)
    elif what == 2:  # a whole column
        odd = chance.choice(CELLS)
        for other in rows[at:]:
            if column < len(other):
                other[column] = odd
    elif what == 3:
        for other in rows:
            other[column : column + 1] = chance.choice(([], other[column : column + 1] * 2))
    elif what == 4:
        rows[at] = row[::-1]
    elif what == 5:
        rows[at:] = rows[at:][:: chance.choice((-1, 2, 7))]
    else:
        rows[at], rows[-1 - at] = rows[-1 - at], rows[at]
    ends = chance.choice(("\n", "\n", "\r\n", "\r"))
    mark = chance.choice((between, between, ";", "\t"))
    changed = ends.join(mark.join(row) for row in rows)
    return changed.encode(chance.choice(("utf-8", "utf-8", "utf-16")))


def _swap_words(data: bytes, chance: Chance) -> bytes:
    """Replace or swap words by others that the format uses."""
    words = re.split(r"(\s+)", data.decode("utf-8", "replace"))
    head = chance.choice((40, 400, len(words)))
    a, b = (chance.randrange(min(head, len(words))) for _ in range(2))
    what = chance.randrange(5)
    if what == 0:
        words[a] = chance.choice(WORDS)
    elif what == 1:
        words[a], words[b] = words[b], words[a]
    elif what == 2:
        words[a:a] = [chance.choice(WORDS), chance.choice((" ", "\n"))]
    elif what == 3:
        del words[min(a, b) : min(a, b) + chance.choice((1, 2, 20))]
    else:
        stretch = words[min(a, b) : max(a, b)][:400]
        words[b:b] = stretch * chance.choice((1, 2, 20))
    return "".join(words).encode()


def _change_array(array: Any, chance: Chance) -> Any:
    """The same numbers as another type, in another shape, or with odd ones among them."""
    array = np.asarray(array)
    floats = array.dtype.kind == "f" and array.size
    spoilt = array.astype(np.float64) if floats else np.zeros((1, 3))
    spoilt.flat[chance.randrange(spoilt.size)] = chance.choice((np.nan, np.inf, 1e300, -1e300))
    changes: tuple[Callable[[], Any], ...] = (
        lambda: array.astype(chance.choice(TYPES)),
        lambda: array.reshape(chance.choice(SHAPES)),
        lambda: array[: chance.choice((0, 1, 2))],
        lambda: array.T,
        lambda: spoilt,
        lambda: np.full(array.shape, chance.choice((0, 1, np.nan, 1e300, "x", True))),
        lambda: np.array(chance.choice((0, 60, -1, "x", 1e300, 2**63))),
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # numpy's, where numbers do not fit the other type
        return chance.choice(changes)()


def _change_npy(data: bytes, chance: Chance) -> bytes:
    file = io.BytesIO()
    np.save(file, _change_array(np.load(io.BytesIO(data)), chance), allow_pickle=False)
    return file.getvalue()


def _change_npz(data: bytes, chance: Chance) -> bytes:
    held = dict(np.load(io.BytesIO(data)))
    name = chance.choice(list(held))
    if chance.random() < 0.2:
        del held[name]
    elif name == "head":
        held[name] = np.array(
            _change_json(str(held[name]).encode(), chance).decode("utf-8", "replace")
        )
    else:
        held[name] = _change_array(held[name], chance)
    file = io.BytesIO()
    np.savez(file, **held)
    return file.getvalue()


def _change_parquet(data: bytes, chance: Chance) -> bytes:
    import pyarrow as pa
    from pyarrow import parquet

    table = parquet.ParquetFile(io.BytesIO(data)).read()
    at = chance.randrange(table.num_columns)
    name, n = table.column_names[at], table.num_rows
    values = table.column(at).to_pylist()
    what = chance.randrange(7)
    if what == 0:
        table = table.drop_columns([name])
    elif what == 1:
        values[chance.randrange(max(n, 1))] = chance.choice((None, *values[:2]))
        table = table.set_column(at, name, pa.array(values))
    elif what == 2:
        kinds = (pa.string(), pa.float16(), pa.int8(), pa.bool_(), pa.binary(), pa.timestamp("ns"))
        table = table.set_column(at, name, table.column(at).cast(chance.choice(kinds), safe=False))
    elif what == 3:
        table = table.slice(0, chance.choice((0, 1, 2)))
    elif what == 4:
        table = table.rename_columns(
            [chance.choice(table.column_names) for _ in table.column_names]
        )
    elif what == 5:
        odd = chance.choice((math.nan, 1e300, -1, 2**62, "", "x", [1.0], {"a": 1}, b"x"))
        table = table.set_column(at, name, pa.array([odd] * n))
    else:
        texts = {
            key: text for key, text in (table.schema.metadata or {}).items() if text[:1] == b"{"
        }
        table = table.replace_schema_metadata(
            {k: _change_json(text, chance) for k, text in texts.items()}
        )
    file = io.BytesIO()
    parquet.write_table(table, file)
    return file.getvalue()


CHANGES: dict[str, Callable[[bytes, Chance], bytes]] = {
    ".json": _change_json, ".gltf": _change_json, ".npy": _change_npy, ".npz": _change_npz,
    ".parquet": _change_parquet,
    **dict.fromkeys((".csv", ".tsv", ".txt", ".trc", ".mot", ".sto"), _change_cells),
    **dict.fromkeys((".bvh", ".asf", ".amc"), _swap_words),
}  # fmt: skip
