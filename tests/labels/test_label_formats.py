"""Labels of other programs: what is written comes back, frame for frame."""

from __future__ import annotations

import json
from dataclasses import replace
from itertools import product
from pathlib import Path
from xml.etree import ElementTree as ET

import hypothesis
import pandas as pd
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from praatio import textgrid
from pympi import Elan

from kineme.errors import KinemeWarning, ReadError, WriteError
from kineme.labels import label_formats, read_segments, write_segments
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level
from segmentations import make_activities, segmentations

FORMATS = label_formats()
LABEL_FORMATS = [n for n, known in FORMATS.items() if known.holds != "all" and known.write]
BOTH_LEVELS = [name for name, known in FORMATS.items() if known.write and known.holds == "levels"]
TELL_THE_RATE = ("elan", "bids", "boris", "clips")
NASTY = [
    "walk on the spot",
    "Kniebeugen über Äpfel",
    "a \"long\", 'quoted' step",
    "<b>jump & run</b> &amp;",
    '"',
    "  blanks  ",
    "\\backslash",
    "歩く 🏃",
    "cluster",
    "0.5",
]
RATES = [25.0, 30000 / 1001, 119.88]


def place(folder: Path, name: str, stem: str = "take") -> Path:
    """Where a file of the format may lie."""
    known = FORMATS[name]
    return folder / known.folder / f"{stem}{known.written_suffix}"


def write_and_read(result: Segmentation, path: Path, name: str, level: Level | None = None):
    for left_over in (*path.parent.glob("*.*"), path.parent.parent / "mapping.txt"):
        if left_over.is_file():
            left_over.unlink()
    write_segments(result, path, format=name, level=level)
    told = {} if name in TELL_THE_RATE else {"fps": result.fps}
    return read_segments(path, format=name, n_frames=result.n_frames, **told)


def list_spans(result: Segmentation, level: Level) -> list[tuple]:
    """Frames, seconds and text of each segment of a level."""
    rows = result.level(level)
    return [
        (r.start_frame, r.stop_frame, r.start_s, r.stop_s, r.kind, r.cluster, r.label) for r in rows
    ]


def list_kept_spans(
    result: Segmentation, level: Level, name: str, read_as: Level | None = None
) -> list[tuple]:
    """What of `spans` a format has room for; primitives alone are read as activities."""
    rows = []
    for r in result.level(level):
        label = r.label
        if name == "ms-tcn":
            label = "".join("_" if letter.isspace() else letter for letter in label)
        if name == "elan":
            label = label.replace("\ufffe", "\ufffd").replace("\uffff", "\ufffd")
        rests = r.kind == "transition" and not r.label
        kind = "transition" if rests else read_as or level
        cluster = -1 if rests or r.label else r.cluster
        if name == "bids":
            cluster = r.cluster
        rows.append((r.start_frame, r.stop_frame, r.start_s, r.stop_s, kind, cluster, label))
    return rows


def merge_spans(rows: list[tuple]) -> list[tuple]:
    """Equal neighbours as one, for a format that has one label per frame."""
    out: list[tuple] = []
    for row in rows:
        if out and out[-1][4:] == row[4:]:
            out[-1] = (out[-1][0], row[1], out[-1][2], row[3], *row[4:])
        else:
            out.append(row)
    return out


def make_example(labels: list[str], fps: float = 119.88) -> Segmentation:
    """Two activities of every label, with a transition in the middle, and their repetitions."""
    n = len(labels)
    kinds = ["activity" if label else "transition" for label in labels]
    borders = [7 * i for i in range(n + 1)]
    inner = [0, *(7 * i + 3 for i in range(n)), 7 * n]
    inner = sorted({*borders, *inner})
    columns = {
        "level": ["activity"] * n + ["primitive"] * (len(inner) - 1),
        "kind": kinds + ["activity"] * (len(inner) - 1),
        "start_frame": [*borders[:-1], *inner[:-1]],
        "stop_frame": [*borders[1:], *inner[1:]],
        "cluster": [-1] * n + [i % 3 for i in range(len(inner) - 1)],
        "label": [*labels, *[""] * (len(inner) - 1)],
        "confidence": [0.5] * (n + len(inner) - 1),
    }
    provenance = {"input": {"path": "takes/take.bvh"}}
    return Segmentation.from_columns(columns, n_frames=7 * n, fps=fps, provenance=provenance)


@pytest.mark.parametrize("name", LABEL_FORMATS)
@hypothesis.example(result=make_example(NASTY), level="activity")
@given(result=segmentations(), level=st.sampled_from(["activity", "primitive"]))
def test_each_level_comes_back_frame_for_frame(folder, name, result, level) -> None:
    assume(len(result.level(level)))
    assume(name != "elan" or result.fps < 1000)
    labels = result.table.label.tolist()
    assume(not {"transition", "activity", "n/a"} & set(labels))
    assume(name != "ms-tcn" or not any(label.startswith("\ufeff") for label in labels))
    back = write_and_read(result, place(folder, name), name, level)
    assert back.n_frames == result.n_frames
    assert back.fps == pytest.approx(result.fps, rel=1e-12)
    expected = list_kept_spans(result, level, name, "activity")
    got = list_spans(back, "activity")
    if name == "ms-tcn":
        expected, got = merge_spans(expected), merge_spans(got)
    for mine, theirs in zip(got, expected, strict=True):
        assert (*mine[:2], *mine[4:]) == (*theirs[:2], *theirs[4:])
        assert mine[2:4] == pytest.approx(theirs[2:4], rel=1e-12)


@pytest.mark.parametrize("name", BOTH_LEVELS)
@given(result=segmentations())
def test_both_levels_come_back_together(folder, name, result) -> None:
    assume(name != "elan" or result.fps < 1000)
    assume(not {"transition", "activity", "n/a"} & set(result.table.label.tolist()))
    back = write_and_read(result, place(folder, name), name)
    for level in ("activity", "primitive"):
        assert [row[:2] + row[4:] for row in list_spans(back, level)] == [
            row[:2] + row[4:] for row in list_kept_spans(result, level, name)
        ]


@pytest.mark.parametrize("name", LABEL_FORMATS)
@pytest.mark.parametrize("fps", RATES)
def test_frames_and_seconds_are_right_at_any_rate(tmp_path, name, fps) -> None:
    n = 20_000
    cuts = [0, *range(1, 40), *range(40, n, 997), n]
    labels = [f"step {i}" for i in range(len(cuts) - 1)]
    result = make_activities(*cuts[1:], fps=fps, label=labels)
    back = write_and_read(result, place(tmp_path, name), name)
    assert back.table.start_frame.tolist() == cuts[:-1]
    assert back.table.stop_s.tolist() == pytest.approx([cut / fps for cut in cuts[1:]], rel=1e-13)
    assert (back.n_frames, back.fps) == (n, pytest.approx(fps, rel=1e-13))


# Against the programs and packages these files are for.


def test_praatio_reads_what_we_write_and_we_read_both_of_its_forms(tmp_path) -> None:
    result = make_example([label for label in NASTY if label == label.strip()])
    write_segments(result, tmp_path / "mine.TextGrid")
    theirs = textgrid.openTextgrid(str(tmp_path / "mine.TextGrid"), includeEmptyIntervals=True)
    assert theirs.tierNames == ("activity", "primitive")
    for level in theirs.tierNames:
        entries = theirs.getTier(level).entries
        rows = result.level(level)
        assert [entry.start for entry in entries] == pytest.approx(rows.start_s.tolist())
        assert [entry.end for entry in entries] == pytest.approx(rows.stop_s.tolist())
    assert [e.label for e in theirs.getTier("activity").entries] == result.activities.label.tolist()
    for form in ("short_textgrid", "long_textgrid"):
        theirs.save(str(tmp_path / "theirs.TextGrid"), format=form, includeBlankSpaces=True)
        back = read_segments(tmp_path / "theirs.TextGrid", fps=result.fps)
        assert list_spans(back, "activity") == list_kept_spans(result, "activity", "textgrid")
        assert list_spans(back, "primitive") == list_kept_spans(result, "primitive", "textgrid")


def test_a_textgrid_in_utf_16_with_points_and_gaps(tmp_path) -> None:
    points = ['"TextTier"', '"beats"', 0, 2, 1, 0.5, '"clap"']
    spans = [0, 0.5, '""', 0.5, 1, '"Kniebeuge\ntief"', 1, 2, '""']
    intervals = ['"IntervalTier"', '"Bewegung"', 0, 2, 3, *spans]
    head = ['File type = "ooTextFile"', 'Object class = "TextGrid"', "", 0, 2, "<exists>", 2]
    text = "".join(f"{line}\n" for line in [*head, *points, *intervals])
    (tmp_path / "wide.TextGrid").write_text(text, encoding="utf-16")
    back = read_segments(tmp_path / "wide.TextGrid", fps=10)
    assert back.activities.start_frame.tolist() == [0, 5, 10]
    assert back.activities.kind.tolist() == ["transition", "activity", "transition"]
    assert back.activities.label.tolist() == ["", "Kniebeuge tief", ""]
    assert back.n_frames == 20


def test_pympi_reads_what_we_write_and_we_read_what_it_writes(tmp_path) -> None:
    result = make_example(NASTY, fps=100.0)
    write_segments(result, tmp_path / "mine.eaf")
    theirs = Elan.Eaf(str(tmp_path / "mine.eaf"))
    found = sorted(theirs.get_annotation_data_for_tier("activity"))
    rows = result.activities
    assert [a[0] for a in found] == [round(1000 * s) for s in rows.start_s.tolist()]
    assert [a[2] for a in found] == rows.label.tolist()
    other = Elan.Eaf()
    other.remove_tier("default")
    other.add_tier("Bewegung")
    for start, stop, label, *_ in found:
        other.add_annotation("Bewegung", start, stop, label)
    other.to_file(str(tmp_path / "theirs.eaf"))
    back = read_segments(tmp_path / "theirs.eaf", fps=100)
    assert list_spans(back, "activity") == list_kept_spans(result, "activity", "elan")


def write_tiers(path: Path, *tiers: str) -> Path:
    document = Elan.Eaf()
    document.remove_tier("default")
    for tier in tiers:
        document.add_tier(tier)
        for start in (0, 500) if tier.lower() == "primitive" else (0,):
            document.add_annotation(tier, start, start + 500, f"in {tier}")
    document.to_file(str(path))
    return path


@pytest.mark.parametrize("others", [(), ("primitive",)])
def test_several_unknown_tiers_are_a_question_to_the_user(tmp_path, others) -> None:
    path = write_tiers(tmp_path / "two.eaf", "left", "right", *others)
    with pytest.raises(ReadError, match=r"tiers \(left, right.*\): keep one, or name one"):
        read_segments(path, fps=100)


@pytest.mark.parametrize(
    "tiers",
    [("Exercise", "primitive"), ("Activity", "Primitive"), ("notes", "activity", "PRIMITIVE")],
)
def test_tiers_of_levels_are_known_in_any_case(tmp_path, tiers) -> None:
    found = read_segments(write_tiers(tmp_path / "take.eaf", *tiers), fps=100, n_frames=100)
    assert found.activities.label.tolist()[0] == f"in {tiers[-2]}"
    assert found.primitives.label.tolist() == [f"in {tiers[-1]}"] * 2


def test_pandas_reads_bids_events_and_the_sidecar_describes_every_column(tmp_path) -> None:
    result = make_example(NASTY, fps=30.0)
    write_segments(result, tmp_path / "walk_events.tsv")
    frame = pd.read_csv(tmp_path / "walk_events.tsv", sep="\t", keep_default_na=False)
    assert frame.trial_type[: len(NASTY)].tolist() == NASTY
    assert frame.onset.tolist() == result.table.start_s.tolist()
    sidecar = json.loads((tmp_path / "walk_events.json").read_text())
    assert set(frame.columns) - {"onset", "duration"} <= set(sidecar)
    assert sidecar["SamplingFrequency"] == 30.0
    back = read_segments(tmp_path / "walk_events.tsv")
    assert back.table.confidence.tolist() == result.table.confidence.tolist()
    assert back.primitives.cluster.tolist() == result.primitives.cluster.tolist()


def test_a_bids_sidecar_keeps_what_others_wrote_and_a_segment_table_is_not_taken_for_one(
    tmp_path,
) -> None:
    result = make_example(["walk", "run"])
    (tmp_path / "a.json").write_text('{"trial_type": {"HED": {"walk": "Action/Walk"}}}')
    write_segments(result, tmp_path / "a.tsv")
    assert "HED" in json.loads((tmp_path / "a.json").read_text())["trial_type"]
    write_segments(result, tmp_path / "b.json")
    before = (tmp_path / "b.json").read_bytes()
    with pytest.raises(WriteError, match="would be overwritten"):
        write_segments(result, tmp_path / "b.tsv")
    assert (tmp_path / "b.json").read_bytes() == before
    assert not (tmp_path / "b.tsv").exists()


def test_boris_of_old_and_new_versions(tmp_path) -> None:
    old = """Observation id,observation #1,,,,,,,
,,,,,,,,
Time offset (s),0.0,,,,,,,
variable,value,,,,,,,
Time,Media file path,Total length,FPS,Subject,Behavior,Behavioral category,Comment,Status
1.200,video.mp4,5.960,25.0,subject1,step,,,START
1.000,video.mp4,5.960,25.0,subject1,blink,,,POINT
2.000,video.mp4,5.960,25.0,subject1,step,,,STOP
2.000,video.mp4,5.960,25.0,subject1,step,,,START
3.040,video.mp4,5.960,25.0,subject1,step,,,STOP
"""
    aggregated = """Media duration (s),FPS (frame/s),Behavior,Behavior type,Start (s),Stop (s)
5.960,25.0,step,STATE,1.200,2.000
5.960,25.0,blink,POINT,1.000,1.000
5.960,25.0,step,STATE,2.000,3.040
"""
    for suffix, text in product((".csv", ".tsv"), (old, aggregated)):
        path = tmp_path / f"events{suffix}"
        path.write_text(text if suffix == ".csv" else text.replace(",", "\t"))
        with pytest.warns(KinemeWarning, match=r"left out: blink \(1\)"):
            back = read_segments(path)
        assert back.activities.start_frame.tolist() == [0, 30, 50, 76]
        assert back.activities.label.tolist() == ["", "step", "step", ""]
        assert (back.fps, back.n_frames) == (25.0, 149)
    (tmp_path / "events.csv").write_text(old.rsplit("\n", 2)[0])
    with pytest.raises(ReadError, match="'step' has a START without a STOP"):
        read_segments(tmp_path / "events.csv", format="boris")


def test_boris_rows_alternate_and_carry_the_frame(tmp_path) -> None:
    write_segments(
        make_example(["walk", "walk"]), tmp_path / "e.csv", format="boris", level="activity"
    )
    frame = pd.read_csv(tmp_path / "e.csv")
    assert frame["Behavior type"].tolist() == ["START", "STOP", "START", "STOP"]
    assert frame["Image index"].tolist() == [0, 7, 7, 14]
    assert frame["Time"].tolist() == [0, 7 / 119.88, 7 / 119.88, 14 / 119.88]


def format_babel(*labels: tuple[str, float, float], dur: float = 4.0) -> str:
    annotated = [
        {"proc_label": text, "start_t": start, "end_t": stop} for text, start, stop in labels
    ]
    return json.dumps({"5788": {"babel_sid": 5788, "dur": dur, "frame_ann": {"labels": annotated}}})


def test_overlapping_babel_labels_become_segments_of_both(tmp_path) -> None:
    path = tmp_path / "train.json"
    path.write_text(format_babel(("walk", 0, 3), ("wave", 1, 2), ("turn", 3, 3.5)))
    with pytest.warns(KinemeWarning, match="with the texts of several: 1 segment"):
        back = read_segments(path, format="babel", fps=10)
    assert back.activities.label.tolist() == ["walk", "walk + wave", "walk", "turn", ""]
    assert back.activities.stop_frame.tolist() == [10, 20, 30, 35, 40]


def test_babel_without_frame_labels_takes_those_of_the_sequence(tmp_path) -> None:
    path = tmp_path / "one.json"
    labels = [{"raw_label": "walk on a treadmill", "proc_label": None}]
    path.write_text(json.dumps({"dur": 2.0, "frame_ann": None, "seq_ann": {"labels": labels}}))
    back = read_segments(path, format="babel", fps=10)
    assert list_spans(back, "activity") == [
        (0, 20, 0.0, 2.0, "activity", -1, "walk on a treadmill")
    ]


def test_the_ms_tcn_mapping_grows_and_keeps_its_numbers(tmp_path) -> None:
    for stem, labels in (("a", ["walk", "high jump"]), ("b", ["run", "walk"])):
        write_segments(
            make_example(labels), tmp_path / "groundTruth" / f"{stem}.txt", format="ms-tcn"
        )
    lines = (tmp_path / "mapping.txt").read_text().splitlines()
    assert lines == ["0 walk", "1 high_jump", "2 run"]
    assert (tmp_path / "groundTruth" / "b.txt").read_text() == "run\n" * 7 + "walk\n" * 7
    with pytest.raises(WriteError, match="give groundTruth/c.txt"):
        write_segments(make_example(["run"]), tmp_path / "c.txt", format="ms-tcn")


def test_background_of_ms_tcn_corpora_is_transition(tmp_path) -> None:
    (tmp_path / "t.txt").write_text("SIL\nSIL\npour\nbackground\n")
    back = read_segments(tmp_path / "t.txt", format="ms-tcn", fps=15)
    assert back.activities.kind.tolist() == ["transition", "activity", "transition"]


def test_a_clip_list_as_motion_matching_has_it(tmp_path) -> None:
    rows = "file,start,stop,mirror\nrun1.bvh,90,200,0\nrun1.bvh,90,200,1\nrun1.bvh,300,310,0\n"
    (tmp_path / "clips.csv").write_text(rows)
    back = read_segments(tmp_path / "clips.csv", format="clips", fps=60, n_frames=400)
    assert back.activities.start_frame.tolist() == [0, 90, 200, 300, 310]
    (tmp_path / "clips.csv").write_text(rows + "run2.bvh,0,4,0\n")
    with pytest.raises(ReadError, match=r"lists clips of 2 files \(run1.bvh, run2.bvh\): keep one"):
        read_segments(tmp_path / "clips.csv", format="clips", fps=60)


# What is missing, wrong or hostile.


def test_gaps_become_transitions_that_respect_the_borders_of_activities(tmp_path) -> None:
    rows = [
        ("onset", "duration", "trial_type", "level"),
        (1, 2, "walk", "activity"),
        (3, 1, "run", "activity"),
        (1.5, 0.5, "step", "primitive"),
    ]
    text = "\n".join("\t".join(map(str, row)) for row in rows)
    (tmp_path / "e.tsv").write_text(text)
    back = read_segments(tmp_path / "e.tsv", fps=10, n_frames=50)
    assert back.activities.start_frame.tolist() == [0, 10, 30, 40]
    assert back.primitives.start_frame.tolist() == [0, 10, 15, 20, 30, 40]
    assert back.primitives.label.tolist() == ["", "", "step", "", "", ""]


def test_points_are_left_out_and_the_end_is_said_to_be_guessed(tmp_path) -> None:
    (tmp_path / "l.txt").write_text(
        "0\t1,0\twalk\n0.5\t0.5\tclap\n\\\t100\t200\n1.0\t2.0\trun\tfast\n"
    )
    with pytest.warns(
        KinemeWarning, match="left out, since they are shorter than a frame: 1 label"
    ):
        back = read_segments(tmp_path / "l.txt", fps=10)
    assert back.activities.label.tolist() == ["walk", "run fast"]
    assert "inferred from the end of the last label" in back.provenance["notes"][0]


def test_elan_names_the_video_of_the_recording(tmp_path: Path) -> None:
    source = {"input": {"path": str(tmp_path / "walk one.bvh")}}
    found = make_activities(30, provenance=source)

    def media() -> list[dict[str, str]]:
        write_segments(found, tmp_path / "walk.eaf")
        read_segments(tmp_path / "walk.eaf")
        root = ET.parse(tmp_path / "walk.eaf").getroot()
        return [each.attrib for each in root.iter("MEDIA_DESCRIPTOR")]

    assert media() == []
    (tmp_path / "walk one.mp4").touch()
    place = (tmp_path / "walk one.mp4").as_uri()
    named = {"MEDIA_URL": place, "MIME_TYPE": "video/mp4", "RELATIVE_MEDIA_URL": "./walk one.mp4"}
    assert media() == [named]
    video = {"path": str(tmp_path / "walk one.mp4"), "offset_s": 1.25}
    found = replace(found, provenance={**source, "video": video})
    assert media() == [{**named, "TIME_ORIGIN": "1250"}]


@pytest.mark.parametrize("row", ["1.5,3.0,walk", "1,5;3,0;walk", "1.5\t3.0\twalk"])
def test_an_elan_export_of_one_tier_without_its_name(tmp_path: Path, row: str) -> None:
    separator = max("\t;,", key=row.count)
    head = ["Begin Time - ss.msec", "End Time - ss.msec", "Annotation"]
    path = tmp_path / "walk.csv"
    path.write_text(f'"#file:///take.eaf"\n{separator.join(head)}\n{row}\n')
    (found,) = [row for row in read_segments(path, fps=100, n_frames=400).activities if row.label]
    assert (found.label, found.start_s, found.stop_s) == ("walk", 1.5, 3.0)


@pytest.mark.parametrize(
    "times",
    [
        ("1.500", "3.000"),
        ("1500", "3000"),
        ("1.500", "1500", "3.000", "3000"),
        ("1.500", "1500", "3.000", "3000", "1.500", "1500"),
        ("00:00:01.500", "1.500", "1500", "00:00:03.000", "3.000", "3000"),
    ],
)
def test_an_elan_export_without_names_of_columns(tmp_path: Path, times: tuple[str, ...]) -> None:
    path = tmp_path / "walk.txt"
    path.write_text("\t".join(["activity", "", *times, "walk"]) + "\n")
    row = read_segments(path, fps=100, n_frames=400).activities[1]
    assert (row.label, row.start_s, row.stop_s) == ("walk", 1.5, 3.0)
