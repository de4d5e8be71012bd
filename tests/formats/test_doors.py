"""Any exception in a reader becomes a ReadError that names the file and keeps the cause."""

from __future__ import annotations

import os
import warnings
from pathlib import Path

import numpy as np
import pytest
from format_samples import BVH

import kineme
from kineme.errors import MotionError, ParameterError, ReadError
from kineme.formats import registry
from kineme.formats.listing import scan_folder
from kineme.labels import registry as labels


class SurprisingError(Exception):
    pass


def surprise(*_: object) -> None:
    raise SurprisingError("deep inside")


@pytest.mark.parametrize(
    ("known", "odd", "read"),
    [
        (registry, registry.Format("odd", (".odd",), lambda _: False, surprise), kineme.read),
        (labels, labels.LabelFormat("odd", "", (".odd",), "all", surprise), kineme.read_segments),
    ],
)
def test_surprises_of_a_reader(tmp_path: Path, request, known, odd, read) -> None:
    path = tmp_path / "a.odd"
    path.write_text("anything")
    known.register(odd)
    request.addfinalizer(lambda: known.FORMATS.remove("odd"))
    with pytest.raises(ReadError, match=r"a\.odd: cannot be read, .*deep inside") as caught:
        read(path)
    assert isinstance(caught.value.__cause__, SurprisingError)


@pytest.mark.parametrize("shape", ["()", "(" + "1, " * 70 + ")", "(-1, 3, 3)"])
def test_headers_of_arrays(tmp_path: Path, shape: str) -> None:
    text = f"{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}".ljust(501) + "\n"
    head = b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text.encode()
    (tmp_path / "a.npy").write_bytes(head + bytes(800))
    with pytest.raises(ReadError, match=r"a\.npy"):
        kineme.read(tmp_path / "a.npy", fps=30)


def test_values_that_no_body_or_clock_has(tmp_path: Path) -> None:
    path = tmp_path / "a.bvh"
    path.write_text(BVH.replace("1 91 1 11", "1 1e28 1 11"))
    with (
        warnings.catch_warnings(action="error", category=RuntimeWarning),
        pytest.raises(ReadError, match="positions reach 1e.* m, too far for a body"),
    ):
        kineme.read(path, unit="m")
    with pytest.raises(ReadError, match=r"1e\+300 Hz, which is too high or too low"):
        kineme.read(kineme.bundled_recording(), fps=1e300)
    body = kineme.Skeleton(("a",), (-1,), [[0.0, 0.0, 0.0]])
    with pytest.raises(MotionError, match="too high or too low"):
        kineme.Motion(body, np.zeros((3, 1, 3)), 1e-300)
    with pytest.raises(ParameterError, match="too large for a sensor"):
        kineme.Signals([[1e300], [0.0]], 50)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no pipes with names")
@pytest.mark.parametrize("suffix", [".bvh", ".csv", ".json", ".npz"])
def test_a_pipe_is_not_waited_for(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"a{suffix}"
    os.mkfifo(path)
    for reader in (kineme.read, kineme.read_segments, kineme.KnowledgeBase.load):
        with pytest.raises(ReadError, match="is a pipe|are stored as"):
            reader(path)
    assert scan_folder(tmp_path).recordings == []
