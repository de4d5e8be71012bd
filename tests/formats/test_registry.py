"""Formats of the registry and of other packages, notes on what was inferred, and any error."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from format_samples import BVH

import kineme
from kineme.errors import KinemeWarning, MotionError, ParameterError, ReadError, WriteError
from kineme.formats import Format, ReadOptions, read_quietly, register, registry, supported_formats
from kineme.formats.listing import scan_folder
from kineme.labels import registry as labels

CUT_SHORT = kineme.bundled_recording().read_text(encoding="utf-8").replace("Frames: ", "Frames: 9")


def read_toy(content, options):
    content.warn("read as a toy", 3)
    values = np.array(content.text.split()[1:], float)
    return kineme.Signals(values, options.fps or 10, provenance=content.provenance("toy", ["fun"]))


def write_toy(signals, path: Path) -> None:
    path.write_text(f"TOY {' '.join(map(str, signals.values[:, 0]))}", encoding="utf-8")


TOY = Format(
    "toy", (".toy",), lambda head: head.startswith(b"TOY"), read_toy,
    write_signals=write_toy, channels=True,
)  # fmt: skip


@pytest.fixture
def known() -> Iterator[None]:
    yield
    registry.FORMATS.remove("toy")


def test_what_is_worth_a_warning_is_warned_of_once(tmp_path: Path) -> None:
    path = tmp_path / "a.bvh"
    path.write_text(CUT_SHORT + " 1 2\n", encoding="utf-8")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        motion = kineme.read(path)
    (warning,) = caught
    assert warning.category is KinemeWarning
    assert warning.filename == __file__
    said = motion.provenance.warnings
    assert len(said) == 2
    assert "frames declared" in said[1]
    assert "the last frame is truncated and left out" in said[0]
    assert str(warning.message) == f"{path}: {said[0]}; {said[1]}"
    assert any(note.severity == "info" for note in motion.provenance.notes)
    quiet = read_quietly(path)  # no warning: tests turn them into errors
    assert quiet.provenance == motion.provenance


@pytest.mark.parametrize(
    ("name", "what"),
    [("a.qtm", "export BVH or C3D"), ("a.xlsx", "save it as CSV"), ("a.csv.gz", "unpack it first")],
)
def test_files_that_people_try(tmp_path: Path, name: str, what: str) -> None:
    (tmp_path / name).write_bytes(b"PK\x03\x04")
    with pytest.raises(ReadError, match=f"is not supported: {what}"):
        kineme.read(tmp_path / name)


@pytest.mark.usefixtures("known")
def test_a_format_that_cannot_tell_its_files_costs_itself_only() -> None:
    register(replace(TOY, recognises=lambda head: 1 / 0))
    with pytest.warns(KinemeWarning, match="the format toy was skipped, .* ZeroDivisionError"):
        assert kineme.read(kineme.bundled_recording()).n_frames == 2898


@pytest.mark.usefixtures("known")
def test_a_reader_that_gives_no_recording(tmp_path: Path) -> None:
    register(replace(TOY, read=lambda content, options: None))
    (tmp_path / "a.toy").write_text("TOY 1")
    with pytest.raises(ReadError, match="the reader of toy gave no Motion or Signals"):
        kineme.read(tmp_path / "a.toy")


@pytest.mark.usefixtures("known")
def test_a_format_of_another_package(tmp_path: Path, monkeypatch) -> None:
    register(TOY)
    assert supported_formats()[0] is TOY
    signals = kineme.Signals([1.0, 2.0], 10)
    kineme.write(signals, tmp_path / "a.toy")
    with pytest.warns(KinemeWarning, match="line 3: read as a toy"):
        again = kineme.read(tmp_path / "a.toy", columns=["1"])
    assert again.values.tolist() == signals.values.tolist()
    assert again.provenance.notes == ("line 3: read as a toy", "fun")
    with pytest.raises(ParameterError, match="a format named 'toy' exists already"):
        register(replace(TOY, suffixes=(".toy2",)))
    register(replace(TOY, suffixes=(".toy2",)), replace=True)
    assert sum(known.name == "toy" for known in supported_formats()) == 1
    assert supported_formats()[0].suffixes == (".toy2",)
    with pytest.raises(ParameterError, match="register takes a Format, not str"):
        register("toy")


def test_writers_are_of_motions_or_of_signals(tmp_path: Path) -> None:
    signals = kineme.Signals(np.arange(6.0).reshape(3, 2), 10)
    with pytest.raises(
        WriteError, match=r"cannot write signals with the suffix '.bvh': use one of"
    ):
        kineme.write(signals, tmp_path / "a.bvh")
    with pytest.raises(ParameterError, match="write takes Motion or Signals, not ndarray"):
        kineme.write(np.zeros(3), tmp_path / "a.csv")


def test_a_file_with_nothing_but_a_byte_order_mark_is_empty(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_bytes(b"\xef\xbb\xbf\n")
    with pytest.raises(ReadError, match="the file is empty"):
        kineme.read(tmp_path / "a.csv")


def test_options_are_checked_where_they_are_given() -> None:
    for wrong, said in [
        ({"columns": "acc_x"}, "columns must be a list of texts"),
        ({"fps": 0}, "fps is 0"),
        ({"fps": float("nan")}, "fps is nan"),
        ({"unit": "mile"}, "unit"),
        ({"unit": -1.0}, "unit"),
        ({"up": "w"}, "up"),
        ({"skeleton": 3}, "give the path of a file"),
    ]:
        with pytest.raises(ParameterError, match=said):
            ReadOptions(**wrong)
        with pytest.raises(ParameterError, match=said):
            kineme.read("a.bvh", **wrong)


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
