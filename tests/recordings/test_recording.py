"""What motions and signals have in common: slices, spans, gaps, notes, a picture."""

from __future__ import annotations

import copy
import json
import pickle
import xml.etree.ElementTree as ET
from contextlib import nullcontext

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kineme.errors import MotionError, ParameterError
from kineme.recordings import Motion, Note, Provenance, Recording, Signals, Skeleton
from kineme.recordings.arrays import mark_spans
from kineme.recordings.operations import cut

ARM = Skeleton(("shoulder", "elbow", "hand"), (-1, 0, 1), np.zeros((3, 3)), {2})
EVENTS = ((0.5, "on"), (4.0, "off"))


def make_motion(n: int = 100, fps: float = 20.0, gaps: tuple = ()) -> Motion:
    positions = np.arange(n)[:, None, None] + np.arange(3.0)[:, None] * (1.0, 2.0, 0.5)
    turns = np.zeros((n, 3, 4))
    turns[..., 0] = 1
    return Motion(ARM, positions, fps, turns, Provenance("a.npz", events=EVENTS), gaps)


def make_signals(n: int = 100, fps: float = 20.0, gaps: tuple = ()) -> Signals:
    values = np.arange(2.0 * n).reshape(n, 2)
    return Signals(values, fps, ("x", "y"), gaps, Provenance("a.csv", events=EVENTS))


def get_numbers(recording: Motion | Signals) -> np.ndarray:
    return recording.positions if isinstance(recording, Motion) else recording.values  # noqa: PD011


both = pytest.mark.parametrize("make", [make_motion, make_signals])


@both
@given(st.integers(-120, 120), st.one_of(st.none(), st.integers(-120, 120)))
def test_slices_are_those_of_numpy(make, start: int, stop: int | None) -> None:
    recording = make(gaps=((10, 20), (50, 60)))
    expected = get_numbers(recording)[start:stop]
    rest = ~mark_spans(recording.gaps, 100)[start:stop]
    if not len(expected) or not rest.any():
        is_refused = make is make_signals or not len(expected)
        with pytest.raises(ParameterError) if is_refused else nullcontext():
            recording[start:stop]
        return
    part = recording[start:stop]
    np.testing.assert_array_equal(get_numbers(part), expected)
    assert len(part) == part.n_frames == len(expected)
    np.testing.assert_array_equal(mark_spans(part.spans(), len(expected)), rest)


@both
def test_a_slice_takes_its_events_along(make) -> None:
    part = make()[5:30]
    assert part.provenance.events == ((0.25, "on"),)
    assert part.provenance.notes == ("cut to frames 5 to 30",)
    assert cut(make(), 5, 30).provenance == part.provenance
    assert part.times[-1] == pytest.approx(24 / 20)


@both
def test_slices_by_seconds(make) -> None:
    recording = make()
    np.testing.assert_array_equal(
        get_numbers(recording.seconds(1.0, 2.5)), get_numbers(recording)[20:50]
    )
    assert recording.seconds(4.5, 99).n_frames == recording.seconds(4.5).n_frames == 10
    for times, said in [
        ((-1, 2), "-1 is not a time"),
        ((3, 2), "no frame from 3 s to 2 s"),
        ((9,), "no frame from 9 s to the end in a recording of 5 s"),
        (("a",), "'a' is not a time"),
    ]:
        with pytest.raises(ParameterError, match=said):
            recording.seconds(*times)


@both
def test_what_is_no_slice_is_refused_in_our_words(make) -> None:
    for wrong, said in [
        (3, r"\[0:600\], not 3"),
        ("a", "not 'a'"),
        (slice(0, 10, 2), "step 2"),
        (slice(0.5, 2), "whole numbers of frames"),
        (slice(7, 7), "frames 7 to 7 of 100 contain no frame"),
    ]:
        with pytest.raises(ParameterError, match=said):
            make()[wrong]
    with pytest.raises(TypeError):
        iter(make())


@both
@pytest.mark.parametrize(
    "gaps", [[(5, 5)], [(9, 12), (2, 4)], [(1, 3), (3, 5)], [(90, 101)], [(-1, 3)]]
)
def test_gaps_are_checked_alike(make, gaps) -> None:
    with pytest.raises((MotionError, ParameterError), match="must be within the 100 frames"):
        make(gaps=gaps)
    with pytest.raises((MotionError, ParameterError), match="gaps are pairs of frames"):
        make(gaps=[3])


@both
def test_notes_know_how_severe_they_are(make) -> None:
    said = make().noted("plain", Note("grave", "warning")).provenance
    assert said.notes == ("plain", "grave")
    assert [note.severity for note in said.notes] == ["info", "warning"]
    assert said.warnings == ("grave",)
    assert json.loads(json.dumps(said.notes)) == ["plain", "grave"]
    for same in (copy.deepcopy(said), pickle.loads(pickle.dumps(said))):
        assert [note.severity for note in same.notes] == ["info", "warning"]


@both
def test_a_notebook_shows_a_picture_and_facts(make) -> None:
    recording = make(gaps=((5, 10),)).noted(Note("1 < 2 & so on", "warning"))
    page = ET.fromstring(recording._repr_html_())
    text = " ".join(page.itertext())
    assert "100 (5.00 s at 20 Hz)" in text
    assert "1 < 2 & so on" in text
    assert len(recording._repr_html_()) < 12_000
    assert page.find("{http://www.w3.org/2000/svg}svg") is not None
    still = recording[0:1]
    assert "nan" not in still._repr_html_()


def test_both_are_recordings() -> None:
    assert isinstance(make_motion(), Recording)
    assert isinstance(make_signals(), Recording)
    assert not isinstance(np.zeros(3), Recording)
    assert repr(make_signals()) == "<Signals of 100 frames (5.0 s) at 20 Hz: 2 channels>"
    assert repr(make_motion()) == (
        "<Motion of 100 frames (5.0 s) at 20 Hz: 3 joints, 1 of them end sites>"
    )


def test_channels_of_a_data_frame_keep_their_names() -> None:
    frame = pd.DataFrame({"acc": [0.0, 1.0], "gyro": [2.0, 3.0]})
    assert Signals(frame, 50).names == ("acc", "gyro")
    assert Signals(frame, 50, ["a", "b"]).names == ("a", "b")
    assert Signals(frame["acc"], 50).names == ("1",)


def test_complex_numbers_are_refused_and_not_halved() -> None:
    with pytest.raises(ParameterError, match="array of numbers, not complex128 values"):
        Signals(np.ones((5, 2)) * 1j, 50)
