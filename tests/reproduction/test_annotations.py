"""Annotations of the benchmark, from JSON and from the authors' text."""

from __future__ import annotations

import json

import numpy as np
import pytest

from kineme.errors import ReadError
from kineme_reproduction.annotations import read_trials

SOUND = {"label": "walk", "end_earliest": 10, "end_mean": 20, "end_latest": 30}
TEXT = """86_01 two actions
walk 500 550 600
jump up 1100 1150 1200
walk 1930 1930 1930

86_02
punch 700 700 700
"""


def write(tmp_path, text, name="mocap.txt"):
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
    text, stored = read_trials(write(tmp_path, "\n".join(lines))), read_trials(source)
    assert list(text) == list(stored)
    for name, truth in stored.items():
        assert text[name].labels == truth.labels
        for marks in ("earliest", "mean", "latest"):
            np.testing.assert_array_equal(getattr(text[name], marks), getattr(truth, marks))


def test_marks_become_frames_from_0_halves_up(tmp_path):
    truth = read_trials(write(tmp_path, TEXT))["86_01"]
    assert truth.labels == ("walk", "jump up", "walk")
    assert truth.earliest.tolist() == [124, 274]
    assert truth.mean.tolist() == [137, 287]  # 550 / 4 = 137.5 is 138 from 1
    assert truth.latest.tolist() == [149, 299]
    assert truth.frames == 483
    assert read_trials(tmp_path / "mocap.txt", fps=120)["86_01"].latest.tolist() == [599, 1199]


def test_known_errors_are_corrected(tmp_path):
    rows = ["walk 970 1019 1100", "stretch 2180 2250 2295", "punch 3368 3440 3500",
            "stand 4000 4074 4130", "walk 4060 5050 5090", "walk 10078 10078 10078"]  # fmt: skip
    path = write(tmp_path, "\n".join(["86_04", *rows]))
    truth = read_trials(path, fps=120)["86_04"]
    assert (truth.earliest[-1], truth.mean[-1], truth.latest[-1]) == (5051, 5051, 5091)
    path = write(tmp_path, "86_06\nstand 1540 1690 1685\nwalk 2000 2000 2000")
    truth = read_trials(path, fps=120)["86_06"]
    assert (truth.earliest[0], truth.mean[0], truth.latest[0]) == (1539, 1689, 1689)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "contains no trial"),
        ("86_01\n", "trial 86_01 has no rows"),
        ("86_01\nwalk 1 2\n", "line 2: expected the name of a trial or"),
        (f"86_01\nwalk 1 2 {'9' * 5000}\n", "line 2: expected the name of a trial or"),
        ("86_01\nwalk 500 550 600\nrun 400 420 440\nsit 900 900 900\n", "would last"),
        ("86_01\nwalk 500 550 600\nrun 580 580 580\n", "is not before the end"),
    ],
)
def test_broken_texts_are_one_clear_error(tmp_path, text, words):
    with pytest.raises(ReadError, match=words):
        read_trials(write(tmp_path, text))


@pytest.mark.parametrize(
    "row",
    [SOUND | {"label": 3}, SOUND | {"end_mean": 1e300}, SOUND | {"end_latest": -1}, {}, None],
    ids=str,
)
def test_damaged_json_is_one_clear_error(tmp_path, row):
    path = tmp_path / "annotations.json"
    for rows in ([SOUND, row], []):
        path.write_text(json.dumps({"trials": {"86_01": rows}}))
        with pytest.raises(ReadError, match="has unexpected content"):
            read_trials(path)
