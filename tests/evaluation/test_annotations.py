"""Annotations are read as written, known errors mended, others refused with a reason."""

from __future__ import annotations

import json

import numpy as np
import pytest

from kineme.errors import KinemeWarning, ReadError
from kineme.evaluation import TRANSITION, read_frame_labels, read_intervals, read_trials

TEXT = """86_01 two actions
walk 500 550 600
jump up 1100 1150 1200
walk 1930 1930 1930

86_02
punch 700 700 700
"""


def write(tmp_path, text, name="labels.csv"):
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return path


def test_text_and_json_of_the_benchmark_say_the_same(tmp_path, data_dir):
    source = data_dir / "cmu86" / "annotations.json"
    lines = []
    for name, rows in json.loads(source.read_text())["trials"].items():
        lines.append(f"{name} {len(rows)}")
        lines += [
            f"{r['label']}\t{r['end_earliest']} {r['end_mean']} {r['end_latest']}" for r in rows
        ]
    text, stored = read_trials(write(tmp_path, "\n".join(lines), "m.txt")), read_trials(source)
    assert list(text) == list(stored)
    for name, truth in stored.items():
        assert text[name].labels == truth.labels
        for marks in ("earliest", "mean", "latest"):
            np.testing.assert_array_equal(getattr(text[name], marks), getattr(truth, marks))


def test_lengths_at_30_fps_are_those_of_the_resampled_recordings(data_dir):
    truths = read_trials(data_dir / "cmu86" / "annotations.json")
    lengths = [truths[t].frames for t in ("86_01", "86_09", "86_10", "86_11", "86_14")]
    assert lengths == [1145, 1199, 1896, 1419, 1514]
    assert len(truths) == 14


def test_marks_become_frames_from_0_halves_up(tmp_path):
    truth = read_trials(write(tmp_path, TEXT, "mocap.txt"))["86_01"]
    assert truth.labels == ("walk", "jump up", "walk")
    assert truth.earliest.tolist() == [124, 274]
    assert truth.mean.tolist() == [137, 287]  # 550 / 4 = 137.5 is 138 from 1
    assert truth.latest.tolist() == [149, 299]
    assert truth.frames == 483
    assert read_trials(tmp_path / "mocap.txt", fps=120)["86_01"].latest.tolist() == [599, 1199]


def test_known_errors_are_mended_and_told(tmp_path):
    rows = ["walk 970 1019 1100", "stretch 2180 2250 2295", "punch 3368 3440 3500",
            "stand 4000 4074 4130", "walk 4060 5050 5090", "walk 10078 10078 10078"]  # fmt: skip
    path = write(tmp_path, "\n".join(["86_04", *rows]), "mocap.txt")
    with pytest.warns(KinemeWarning, match="86_04, row 5 .*mended to \\(5052, 5052, 5092\\)"):
        truth = read_trials(path)["86_04"]
    assert truth.latest[-1] == 1272
    path = write(tmp_path, "86_06\nstand 1540 1690 1685\nwalk 2000 2000 2000", "mocap.txt")
    with pytest.warns(
        KinemeWarning, match="\\(1540, 1690, 1685\\) mended to \\(1540, 1690, 1690\\)"
    ):
        read_trials(path)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "holds no trial"),
        ("86_01\n", "trial 86_01 has no rows"),
        ("86_01\nwalk 1 2\n", "line 2: neither a trial's name nor"),
        ("86_01\nwalk 500 550 600\nrun 400 420 440\nsit 900 900 900\n", "would last"),
        ("86_01\nwalk 500 550 600\nrun 580 580 580\n", "is not before the end"),
    ],
)
def test_broken_texts_are_one_clear_error(tmp_path, text, words):
    with pytest.raises(ReadError, match=words):
        read_trials(write(tmp_path, text, "mocap.txt"))


@pytest.mark.parametrize("text", ["[]", "{", '{"trials": {"86_01": [{"label": "walk"}]}}'])
def test_other_json_is_one_clear_error(tmp_path, text):
    with pytest.raises(ReadError, match="no annotations.json of the benchmark"):
        read_trials(write(tmp_path, text, "a.json"))


@pytest.mark.parametrize("separator", [",", "\t"])
def test_a_table_of_ones_own_with_gap_transition_and_counts(tmp_path, separator):
    rows = ["start_s,stop_s,label,count", "0,2,walk,4", "2.5,4,jump,", "4,4.4,transition,",
            "4.4,6,walk,3"]  # fmt: skip
    path = write(tmp_path, "\n".join(rows).replace(",", separator))
    truth = read_intervals(path, frames=60, fps=10)
    assert truth.labels == ("walk", "jump", "walk")
    assert truth.earliest.tolist() == [20, 40]
    assert truth.mean.tolist() == [23, 42]
    assert truth.latest.tolist() == [25, 44]
    assert truth.counts == (4, None, 3)
    assert truth.labelling().labels == ("walk", TRANSITION, "jump", TRANSITION, "walk")


def test_the_activities_of_a_segment_table_are_a_truth(tmp_path):
    text = (
        "level,kind,start_s,stop_s,label\nactivity,activity,0,2,walk\n"
        "activity,transition,2,3,\nactivity,activity,3,6,run\nprimitive,activity,0,1,x\n"
    )
    truth = read_intervals(write(tmp_path, text), frames=60, fps=10)
    assert (truth.labels, truth.latest.tolist()) == (("walk", "run"), [30])


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        ("0,3,a\n2,6,b", "line 3: starts at 2 s, while the row before stops at 3 s"),
        ("3,1,a", "line 2: runs backwards, from 3 s to 1 s"),
        ("0,9,a", "stops at 9.000 s, the recording lasts 6.000 s"),
        ("0,3,a", "stops at 3.000 s, the recording lasts 6.000 s"),
        ("0,x,a", "line 2: stop_s must be a number from 0 on, not 'x'"),
        ("0,nan,a", "not 'nan'"),
        ("0", "not ''"),
        ("", "holds no interval"),
    ],
)
def test_broken_tables_are_one_clear_error(tmp_path, rows, words):
    with pytest.raises(ReadError, match=words):
        read_intervals(write(tmp_path, f"start_s,stop_s,label\n{rows}\n"), frames=60, fps=10)


def test_a_table_without_labels_or_with_odd_counts_is_refused(tmp_path):
    with pytest.raises(ReadError, match="a column 'label' is needed"):
        read_intervals(write(tmp_path, "start_s,stop_s\n0,6\n"), frames=60, fps=10)
    path = write(tmp_path, "start_s,stop_s,label,count\n0,6,a,many\n")
    with pytest.raises(ReadError, match="line 2: count must be a whole number, not 'many'"):
        read_intervals(path, frames=60, fps=10)
    with pytest.raises(ReadError, match="cannot be read"):
        read_intervals(tmp_path / "none.csv", frames=60, fps=10)


def test_one_label_per_frame(tmp_path):
    path = write(tmp_path, "walk\n" * 30 + "transition\n" * 10 + "run\n" * 20, "l.txt")
    truth = read_frame_labels(path, frames=60, fps=10)
    assert (truth.labels, truth.mean.tolist()) == (("walk", "run"), [35])
    half = read_frame_labels(path, frames=30, fps=5, labels_fps=10)
    assert (half.earliest.tolist(), half.latest.tolist()) == ([15], [20])
    with pytest.raises(ReadError, match="cover 6.000 s .* the recording lasts 9.000 s"):
        read_frame_labels(path, frames=90, fps=10)
    with pytest.raises(ReadError, match="line 2: no label"):
        read_frame_labels(write(tmp_path, "a\n\nb\n", "l.txt"), frames=3, fps=10)
