"""The report's file: whole, small, and nothing in it can break out of its place."""

from __future__ import annotations

import base64
import json
import os
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import msgspec
import numpy as np
import pytest

import kineme
from kineme.datasets import bundled_recording
from kineme.errors import ParameterError, WriteError
from kineme.features.similarity import compare_frames_of_motion
from kineme.recordings import Signals
from kineme.report.page import fill_template, write_report
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import COLUMNS
from kineme.web.display import display_motion
from kineme.web.matrix import make_report_tiles
from kineme.web.page_data import make_page_data, make_recording_message

RECORDING = kineme.read(bundled_recording())
SEGMENTS = kineme.segment(RECORDING)
TEMPLATE = "<body><!--kineme:recording--><!--kineme:motion--><!--kineme:tiles--></body>"
NASTY = "</script><script>alert(1)</script><!-- & \"' <b>é"
BREAKS = "\u2028\u2029"  # ends of lines to JavaScript; labels may not hold them, file names may


class Scripts(HTMLParser):
    """The elements of a page, and the text of its script elements by id."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.texts: dict[str | None, str] = {}
        self.inside: str | None = None
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.inside = dict(attrs).get("id")

    def handle_data(self, data: str) -> None:
        self.texts[self.inside] = self.texts.get(self.inside, "") + data


def label_all(text: str) -> Segmentation:
    columns = dict(SEGMENTS.table.columns())
    columns["label"] = np.full(len(SEGMENTS), text)
    return Segmentation.from_columns(
        columns, n_frames=SEGMENTS.n_frames, fps=SEGMENTS.fps, provenance=SEGMENTS.provenance
    )


def read_content(path: Path) -> dict[str, object]:
    return json.loads(Scripts(path.read_text(encoding="utf-8")).texts["kineme-recording"])


def test_everything_is_in_the_page(tmp_path: Path) -> None:
    write_report(RECORDING, SEGMENTS, tmp_path / "out.html")
    page = Scripts((tmp_path / "out.html").read_text(encoding="utf-8"))
    message = json.loads(page.texts["kineme-recording"])
    head, binary = display_motion(RECORDING)
    assert message["name"] == bundled_recording().name
    assert message["motion"] == json.loads(msgspec.json.encode(head))
    assert base64.b64decode(page.texts["kineme-motion"]) == binary
    tiles = {
        place: base64.b64decode(text)
        for place, text in json.loads(page.texts["kineme-tiles"]).items()
    }
    assert tiles == make_report_tiles(compare_frames_of_motion(RECORDING))
    assert message["segmentation"]["provenance"]["preset"] == "kineme"
    assert [[*row] for row in message["segmentation"]["segments"]] == [[*COLUMNS]] * len(SEGMENTS)
    assert (tmp_path / "out.html").stat().st_size < 1_500_000
    assert [path.name for path in tmp_path.iterdir()] == ["out.html"]


def test_the_page_asks_for_nothing_from_elsewhere(tmp_path: Path) -> None:
    write_report(RECORDING, SEGMENTS, tmp_path / "out.html")
    text = (tmp_path / "out.html").read_text(encoding="utf-8")
    assert "default-src 'none'" in text
    assert not re.findall(r"<(?:script|img|iframe)[^>]*\ssrc=", text)
    assert not re.findall(r"<link[^>]*href=(?!\"data:)", text)
    assert "<!--kineme:" not in text


def test_texts_stay_inside_their_element() -> None:
    shown = make_page_data(RECORDING)
    message = make_recording_message(shown, label_all(NASTY), name=NASTY + BREAKS)
    page = fill_template(TEMPLATE, message, shown.binary, {})
    assert page.isascii()
    parsed = Scripts(page)
    assert parsed.tags == ["body", "script", "script", "script"]
    back = json.loads(parsed.texts["kineme-recording"])
    assert back["name"] == NASTY + BREAKS
    assert {row["label"] for row in back["segmentation"]["segments"]} == {NASTY}


def test_names_that_are_not_unicode_are_shown(tmp_path: Path) -> None:
    name = os.fsdecode(b"G\xe4nge.bvh")
    table = replace(SEGMENTS, provenance={"input": {"path": f"/data/{name}"}})
    write_report(RECORDING, table, tmp_path / "out.html")
    assert read_content(tmp_path / "out.html")["name"] == "G?nge.bvh"


def test_a_name_like_a_place_for_data_is_not_filled() -> None:
    shown = make_page_data(RECORDING)
    message = make_recording_message(shown, SEGMENTS, name="<!--kineme:tiles-->")
    page = Scripts(fill_template(TEMPLATE, message, shown.binary, {"0/0/0": b"tile"}))
    assert json.loads(page.texts["kineme-recording"])["name"] == "<!--kineme:tiles-->"
    assert page.tags.count("script") == 3


def test_signals_are_shown_without_a_figure(tmp_path: Path) -> None:
    times = np.arange(3000) / 100
    values = np.column_stack([np.sin(6 * times), np.cos(6 * times)])
    signals = Signals(values, 100.0, gaps=[(1000, 1400)])
    segments = kineme.segment(signals)
    for name, source in (("signals", signals), ("array", values)):
        write_report(source, segments, tmp_path / f"{name}.html", name=name)
        message = read_content(tmp_path / f"{name}.html")
        assert message["motion"] is None
        assert message["matrix"]["sizes"] == [300, 150]
        assert message["name"] == name


def test_tables_with_any_provenance_are_shown(tmp_path: Path) -> None:
    for source, name in (
        ("a/walk.bvh", "walk.bvh"),
        ({"path": None}, "recording"),
        ({}, "recording"),
    ):
        table = replace(SEGMENTS, provenance={"input": source})
        write_report(RECORDING, table, tmp_path / "out.html")
        assert read_content(tmp_path / "out.html")["name"] == name
    with pytest.raises(ParameterError, match=r"the provenance is not as kineme writes it: input"):
        replace(SEGMENTS, provenance={"input": 7})


def test_segments_of_another_recording_are_refused(tmp_path: Path) -> None:
    shorter = kineme.recordings.operations.cut(RECORDING, 0, 900)
    with pytest.raises(ParameterError, match="2898 frames at 60 Hz, but the recording has 900"):
        write_report(shorter, SEGMENTS, tmp_path / "out.html")
    slower = replace(RECORDING, fps=59.0)
    with pytest.raises(ParameterError, match="the recording has 2898 frames at 59 Hz"):
        write_report(slower, SEGMENTS, tmp_path / "out.html")
    assert list(tmp_path.iterdir()) == []


def test_only_pages_are_written(tmp_path: Path) -> None:
    with pytest.raises(WriteError, match=r"the suffix of a report must be \.html"):
        write_report(RECORDING, SEGMENTS, tmp_path / "out.pdf")
    with pytest.raises(WriteError, match="does not exist"):
        write_report(RECORDING, SEGMENTS, tmp_path / "missing" / "out.html")
