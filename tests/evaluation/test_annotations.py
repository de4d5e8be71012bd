"""Annotations are read as written; known errors are corrected, others rejected with a reason."""

from __future__ import annotations

import json

import numpy as np
import pytest

from kineme.errors import KinemeWarning, ReadError
from kineme.evaluation.inputs import read_trials

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
    with pytest.warns(KinemeWarning, match="86_04, row 5 .*corrected to \\(5052, 5052, 5092\\)"):
        truth = read_trials(path)["86_04"]
    assert truth.latest[-1] == 1272
    path = write(tmp_path, "86_06\nstand 1540 1690 1685\nwalk 2000 2000 2000", "mocap.txt")
    with pytest.warns(
        KinemeWarning, match="\\(1540, 1690, 1685\\) corrected to \\(1540, 1690, 1690\\)"
    ):
        read_trials(path)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "contains no trial"),
        ("86_01\n", "trial 86_01 has no rows"),
        ("86_01\nwalk 1 2\n", "line 2: expected the name of a trial or"),
        ("86_01\nwalk 500 550 600\nrun 400 420 440\nsit 900 900 900\n", "would last"),
        ("86_01\nwalk 500 550 600\nrun 580 580 580\n", "is not before the end"),
    ],
)
def test_broken_texts_are_one_clear_error(tmp_path, text, words):
    with pytest.raises(ReadError, match=words):
        read_trials(write(tmp_path, text, "mocap.txt"))
