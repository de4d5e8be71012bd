"""Labels of other programs that are spoilt or claim too much: one clear error each."""

from __future__ import annotations

import math
import tracemalloc
import warnings
from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from test_label_formats import LABEL_FORMATS, NASTY, format_babel, make_example, place

from _damage import damage_bytes
from kineme.errors import KinemeError, KinemeWarning, ParameterError, ReadError, WriteError
from kineme.labels import label_formats, read_segments, write_segments

WRITTEN = [name for name, known in label_formats().items() if known.write]


@pytest.mark.parametrize(
    ("text", "options", "message"),
    [
        ("", {"fps": 10}, "has no labels"),
        ("0\t1\twalk\n", {}, "audacity does not state the frame rate .*: give fps"),
        ("0\t1\twalk\n0.5\t2\trun\n", {"fps": 10}, "'run' starts at frame 5, before .* stops .10."),
        ("0\t0\twalk\n", {"fps": 10}, "no label of at least one frame"),
        ("1\t0\twalk\n", {"fps": 10}, "'walk' stops at 0.0, before 1.0"),
        ("-1\t1\twalk\n", {"fps": 10}, "has a label at -1.0"),
        ("0\t1e300\twalk\n", {"fps": 10}, r"has a label at 1e\+300"),
        ("0\tone\twalk\n", {"fps": 10}, "line 1: the stop must be a number, not 'one'"),
        ("0\tnan\twalk\n", {"fps": 10}, "line 1: the stop must be a number, not 'nan'"),
        ("0\t1\twalk\n5\n", {"fps": 10}, "line 2: a label must be a start, a stop and a text"),
        ("0\t9\twalk\n", {"fps": 10, "n_frames": 50}, "labels up to frame 90, .* has 50"),
    ],
)
def test_bad_labels_are_one_clear_error(tmp_path, text, options, message) -> None:
    (tmp_path / "l.txt").write_text(text)
    with pytest.raises(ReadError, match=message):
        read_segments(tmp_path / "l.txt", **options)


def test_text_that_is_not_utf_8_is_to_be_saved_as_it(tmp_path) -> None:
    (tmp_path / "l.txt").write_bytes("0\t1\tübung\n".encode("latin-1"))
    with pytest.raises(ReadError, match=r"is not UTF-8 text \(byte 4\): save it as UTF-8"):
        read_segments(tmp_path / "l.txt", fps=10)


def test_bad_arguments_name_what_there_is(tmp_path) -> None:
    result = make_example(["walk"])
    with pytest.raises(ParameterError, match="format must be one of csv, json, .* not 'srt'"):
        write_segments(result, tmp_path / "l.srt", format="srt")
    with pytest.raises(ParameterError, match="csv always holds both levels"):
        write_segments(result, tmp_path / "l.csv", level="activity")
    with pytest.raises(ParameterError, match="fps is 0"):
        read_segments(tmp_path / "l.txt", fps=0)
    with pytest.raises(ParameterError, match="n_frames is 0"):
        read_segments(tmp_path / "l.txt", n_frames=0)
    with pytest.raises(WriteError, match="too coarse for 2000 frames per second"):
        write_segments(make_example(["walk"], fps=2000.0), tmp_path / "l.eaf")


def test_a_document_type_is_refused_before_it_can_grow(tmp_path) -> None:
    levels = "".join(f'<!ENTITY e{i} "{f"&e{i - 1};" * 10}">' for i in range(1, 10))
    text = f'<?xml version="1.0"?><!DOCTYPE d [<!ENTITY e0 "ha">{levels}]><d>&e9;</d>'
    (tmp_path / "bomb.eaf").write_text(text)
    with pytest.raises(ReadError, match="it has a document type declaration, which is not allowed"):
        read_segments(tmp_path / "bomb.eaf", fps=10)


@pytest.mark.parametrize("name", WRITTEN)
@settings(max_examples=25)
@given(
    labels=st.lists(st.sampled_from([*NASTY, ""]), min_size=1, max_size=4),
    seed=st.integers(0, 2**32 - 1),
)
def test_a_damaged_file_is_read_or_refused(folder, name, labels, seed) -> None:
    path = place(folder, name, f"damaged_{name}")
    write_segments(make_example(labels), path, format=name)
    path.write_bytes(damage_bytes(path.read_bytes(), seed))
    with warnings.catch_warnings(), suppress(ReadError):
        warnings.simplefilter("ignore", KinemeWarning)
        result = read_segments(path, format=name, fps=119.88)
        assert result.n_frames >= result.table.stop_frame.max()


@pytest.mark.parametrize("name", LABEL_FORMATS)
def test_memory_is_bounded_by_the_size_of_the_file(tmp_path, name) -> None:
    path = place(tmp_path, name)
    path.parent.mkdir(exist_ok=True)
    huge = "999999999999999"
    claims = {
        "audacity": f"0\t{huge[:12]}\twalk\n",
        "elan": '<ANNOTATION_DOCUMENT><TIME_ORDER><TIME_SLOT TIME_SLOT_ID="a" TIME_VALUE="0"/>'
        f'<TIME_SLOT TIME_SLOT_ID="b" TIME_VALUE="{huge}"/></TIME_ORDER><TIER TIER_ID="t">'
        '<ANNOTATION><ALIGNABLE_ANNOTATION TIME_SLOT_REF1="a" TIME_SLOT_REF2="b"/></ANNOTATION>'
        "</TIER></ANNOTATION_DOCUMENT>",
        "textgrid": f'"ooTextFile" "TextGrid" 0 {huge} 1 "IntervalTier" "t" 0 {huge} 900000000',
        "bids": f"onset\tduration\ttrial_type\n0\t{huge[:12]}\twalk\n",
        "boris": f"Behavior,Start (s),Stop (s)\nwalk,0,{huge[:12]}\n",
        "babel": format_babel(("walk", 0, 1e12), dur=1e12),
        "ms-tcn": "walk\n",
        "clips": f"file,start,stop\na.bvh,0,{huge}\n",
    }
    path.write_text(claims[name])
    read_or_refuse(path, name)
    tracemalloc.start()
    read_or_refuse(path, name)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 1_000_000


def read_or_refuse(path: Path, name: str) -> None:
    with suppress(KinemeError):
        result = read_segments(path, format=name, fps=119.88)
        assert math.isfinite(result.table.stop_s[-1])


def test_clips_that_last_no_seconds_do_not_tell_the_rate(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("file,start,stop,stop_s\nx.bvh,0,7,0.0\n", encoding="utf-8")
    with pytest.raises(ReadError, match="frame rate"):
        read_segments(tmp_path / "a.csv", format="clips")
