"""A library of which one file is damaged says which, in a sentence, whatever is asked of it."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pytest
from library_folders import write_channels
from pyarrow import parquet

from kineme.errors import KinemeError, ReadError, WriteError
from kineme.library import Library, build

Damage = Callable[[Path], None]


def ask(folder: Path) -> None:
    library = Library(folder)
    library.read_options, library.segment_options, library.failed, library.unsure()
    library.search(cluster=library.clusters()[0].cluster, top=3)


def head(**changes: Any) -> Damage:
    def damage(folder: Path) -> None:
        told = json.loads((folder / "library.json").read_text()) | changes
        (folder / "library.json").write_text(json.dumps(told))

    return damage


def edits(**changes: Any) -> Damage:
    def damage(folder: Path) -> None:
        told = {"schema": "kineme.library.edits/1", "names": {}, "merged": {}, "splits": []}
        (folder / "edits.json").write_text(json.dumps(told | changes))

    return damage


def features(change: Callable[[np.ndarray], np.ndarray]) -> Damage:
    def damage(folder: Path) -> None:
        for path in (folder / "pieces").glob("*.npy"):
            np.save(path, change(np.load(path)))

    return damage


def no_arrays(folder: Path) -> None:
    for path in (folder / "pieces").glob("*.npy"):
        path.write_bytes(b"nothing")


def stored(name: str, change: Callable[[pa.Table], pa.Table]) -> Damage:
    def damage(folder: Path) -> None:
        (path,) = (folder / "tables").glob(f"*/{name}.parquet")
        parquet.write_table(change(parquet.ParquetFile(path).read()), path)

    return damage


def local(change: Callable[[pa.Table], pa.Table]) -> Damage:
    return stored("local_clusters", change)


def with_column(name: str, values: Callable[[int], Any]) -> Callable[[pa.Table], pa.Table]:
    return lambda table: table.set_column(
        table.column_names.index(name), name, values(table.num_rows)
    )


def not_utf8(n: int) -> pa.Array:
    ends = np.arange(n + 1, dtype=np.int32)
    return pa.Array.from_buffers(
        pa.string(), n, [None, pa.py_buffer(ends), pa.py_buffer(b"\xff" * n)]
    )


def broken_pages(folder: Path) -> None:
    """pyarrow says of it what is in several lines."""
    for path in (folder / "tables").glob("*/*.parquet"):
        data = bytearray(path.read_bytes())
        data[4:400] = bytes(255 - byte for byte in data[4:400])
        path.write_bytes(data)


DAMAGES: dict[str, Damage] = {
    "pages": broken_pages,
    "options of another type": head(read_options=[1]),
    "an option there is not": head(segment_options={"colour": "red"}),
    "an option of another type": head(read_options={"person": 3}),
    "a constant of no preset": head(segment_options={"constants": {"1": 1}}),
    "constants that are texts": head(clustering={"unsure": "0.1"}),
    "a constant that is missing": head(clustering={}),
    "clusters of nobody": local(with_column("recording", lambda n: pa.array(["nobody"] * n))),
    "a recording without segments": stored("segments", lambda table: table.slice(0, 1)),
    "reasons that are numbers": head(failed={"a": 1}),
    "tables elsewhere": head(tables="../.."),
    "a number no column holds": head(following=1 << 63),
    "a name of cluster 2**63": edits(names={str(1 << 63): "x"}),
    "a merge into 1e300": edits(merged={"1": 1e300}),
    "a split without end": edits(splits=[{"cluster": 1, "into": float("inf"), "recordings": []}]),
    "features of nothing": features(lambda array: array * np.float32(np.nan)),
    "features too large": features(lambda array: array + np.float32(1e30)),
    "features of another type": features(lambda array: array.astype("f8")),
    "features in a row": features(np.ravel),
    "features that are no array": no_arrays,
    "a table without a column": local(lambda table: table.drop_columns(["spread"])),
    "a table with a column twice": local(
        lambda table: table.append_column("spread", table.column("spread"))
    ),
    "a table of texts": local(with_column("spread", lambda n: pa.array(["x"] * n))),
    "a table with holes": local(with_column("spread", lambda n: pa.nulls(n, pa.float64()))),
    "a table of numbers too large": local(
        with_column("spread", lambda n: pa.array(np.full(n, 1e308)))
    ),
    "texts that are none": local(with_column("recording", not_utf8)),
}


@pytest.mark.parametrize("kind", DAMAGES)
def test_damage_is_said_in_a_sentence(folder: Path, kind: str) -> None:
    DAMAGES[kind](folder)
    with pytest.raises(KinemeError) as caught:
        ask(folder)
    assert "\n" not in str(caught.value)
    if isinstance(caught.value, ReadError):
        assert str(folder) in str(caught.value)


@pytest.mark.parametrize("names", [[], ["more.csv"]])
def test_a_build_repairs_missing_segments(folder: Path, tmp_path: Path, names: list[str]) -> None:
    DAMAGES["a recording without segments"](folder)
    for name in names:
        write_channels(tmp_path / name, seed=5)
    build([tmp_path / name for name in names], folder)
    assert len(Library(folder).recordings["recording"]) == 3 + len(names)


@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_a_cluster_without_segments_lasts_no_time(folder: Path) -> None:
    local(with_column("cluster", lambda n: pa.array([99] * n)))(folder)
    assert [cluster.typical_s for cluster in Library(folder).clusters()] == [0.0]


@pytest.mark.skipif(sys.platform == "win32", reason="links need rights there")
@pytest.mark.parametrize("name", ["edits.json", ".edits.lock"])
def test_nothing_is_written_through_a_link(folder: Path, library: Library, name: str) -> None:
    mine = folder.parent / "mine"
    (folder / name).unlink(missing_ok=True)
    (folder / name).symlink_to(mine)
    with pytest.raises(WriteError, match="is a link"):
        library.name(library.clusters()[0].cluster, "walk")
    assert not mine.exists()
