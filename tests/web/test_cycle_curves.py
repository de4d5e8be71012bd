"""The curves of repetitions on the pages: the numbers of ``kineme cycles``, and no others."""

from __future__ import annotations

import base64
import csv
import json
import re
import zlib
from pathlib import Path

import numpy as np
import pytest

import kineme
from kineme.cycles import channels_of, compare_curves, write_cycles
from kineme.datasets import Action, bundled_recording, bundled_truth, synthesize
from kineme.recordings import Signals
from kineme.report.page import write_report
from kineme.segments.editing import exclude, name_cluster
from kineme.web.cycle_curves import CycleCurves
from kineme.web.messages import ClusterCurves

MOTION = kineme.read(bundled_recording())
TRUTH = kineme.read_segments(bundled_truth())


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> dict[tuple[str, str], np.ndarray]:
    """n, mean and sd of each group and channel, as ``kineme cycles`` writes them."""
    folder = tmp_path_factory.mktemp("cycles")
    write_cycles(kineme.cycles(MOTION, TRUTH), folder / "all.csv")
    rows: dict[tuple[str, str], list[list[float]]] = {}
    with (folder / "all.curves.csv").open(newline="") as file:
        for row in csv.DictReader(file):
            numbers = [float(row[name]) for name in ("n", "mean", "sd")]
            rows.setdefault((row["group"], row["channel"]), []).append(numbers)
    return {key: np.array(numbers).T for key, numbers in rows.items()}


@pytest.fixture(scope="module")
def measured() -> CycleCurves:
    return CycleCurves(lambda: MOTION)


GROUPS = dict(zip(
    *(kineme.cycles(MOTION, TRUTH, channels=[]).columns[name].tolist()
      for name in ("cluster", "group")), strict=True,
))  # fmt: skip


def same(curves: ClusterCurves, written: np.ndarray) -> None:
    n, mean, sd = written
    unit = 10.0 ** np.floor(np.log10(max(np.ptp(mean), 1e-3)))
    assert curves.n == n[0]
    np.testing.assert_allclose(np.array(curves.mean, float), mean, atol=1e-3 * unit)
    np.testing.assert_allclose(np.array(curves.sd, float), sd, atol=1e-3 * unit)


@pytest.mark.parametrize("channel", ["knee_l", "hip_r", "trunk_lean", "shoulder_r"])
def test_a_page_shows_the_numbers_of_the_table(
    channel: str, measured: CycleCurves, written: dict[tuple[str, str], np.ndarray]
) -> None:
    for cluster, group in GROUPS.items():
        same(measured.make_curves(TRUTH, cluster, channel), written[group, channel])


def test_a_report_holds_the_same(
    tmp_path: Path, written: dict[tuple[str, str], np.ndarray]
) -> None:
    write_report(MOTION, TRUTH, tmp_path / "out.html")
    page = (tmp_path / "out.html").read_text(encoding="utf-8")
    text = re.search(r'id="kineme-cycles">([^<]*)</script>', page)[1]
    held = json.loads(zlib.decompress(base64.b64decode(text)))
    assert held["tables"][0].keys() == {str(cluster) for cluster in GROUPS}
    for cluster, number in held["tables"][0].items():
        assert held["curves"][number].keys() == {each["name"] for each in held["channels"]}
        for channel, curves in held["curves"][number].items():
            n, mean, _ = written[GROUPS[int(cluster)], channel]
            assert curves["n"] == n[0]
            np.testing.assert_allclose(np.array(curves["mean"], float), mean, atol=0.01)


def test_channels_are_those_that_the_command_lists(measured: CycleCurves) -> None:
    heads = measured.channels()
    usual = [each.name for each in channels_of(MOTION)]
    assert [head.name for head in heads[: len(usual)]] == usual
    assert {head.name for head in heads} == {each.name for each in channels_of(MOTION, ["*"])}
    opposite = {head.name: head.opposite for head in heads}
    assert (opposite["knee_l"], opposite["knee_r"], opposite["trunk_lean"]) == (
        "knee_r", "knee_l", "",
    )  # fmt: skip


def test_the_farthest_comes_first_and_what_does_not_count_says_why(measured: CycleCurves) -> None:
    cluster = next(row.cluster for row in TRUTH.primitives if row.kind == "primitive")
    curves = measured.make_curves(TRUTH, cluster)
    counted = [each for each in curves.cycles if each.counts]
    assert curves.cycles[: curves.n] == counted
    assert [each.distance for each in counted] == sorted(
        (each.distance for each in counted), reverse=True
    )
    others = curves.cycles[curves.n :]
    assert {each.note for each in others} == {
        "the first of its activity", "the last of its activity",
    }  # fmt: skip
    starts = {row.start_frame for row in TRUTH.primitives if row.cluster == cluster}
    assert {each.start_frame for each in curves.cycles} == starts


def test_without_inner_repetitions_all_are_in_the_mean() -> None:
    columns = {
        "level": ["activity", "primitive"], "kind": ["activity", "primitive"],
        "start_frame": [0, 0], "stop_frame": [MOTION.n_frames] * 2, "cluster": [-1, 0],
    }  # fmt: skip
    table = kineme.Segmentation.from_columns(columns, n_frames=MOTION.n_frames, fps=MOTION.fps)
    curves = CycleCurves(lambda: MOTION).make_curves(table, 0, "knee_l")
    assert (curves.ends, curves.n, curves.total) == (True, 1, 1)
    assert curves.sd == [None] * 101


def test_what_people_left_out_is_in_no_mean_and_can_be_found(measured: CycleCurves) -> None:
    cluster = next(row.cluster for row in TRUTH.primitives if row.kind == "primitive")
    before = measured.make_curves(TRUTH, cluster, "knee_l")
    farthest = before.cycles[0]
    table = exclude(TRUTH, [farthest.start_frame], excluded=True)
    after = CycleCurves(lambda: MOTION).make_curves(table, cluster, "knee_l")
    assert (after.n, after.total, after.left_out) == (before.n - 1, before.total, 1)
    found = next(each for each in after.cycles if each.start_frame == farthest.start_frame)
    assert (found.counts, found.note, found.values) == (
        False, "left out by hand", farthest.values,
    )  # fmt: skip
    written = kineme.cycles(MOTION, table, channels=["knee_l"]).mean_curves()
    of_group = written["group"] == GROUPS[cluster]
    same(after, np.array([written[name][of_group] for name in ("n", "mean", "sd")]))


def test_another_session_is_the_one_that_the_command_compares_with() -> None:
    made = [synthesize([Action("squat", 7, amplitude=amplitude)], fps=60, seed=seed)
            for amplitude, seed in ((1.0, 3), (0.8, 4))]  # fmt: skip
    motions, tables = [each.motion for each in made], [each.truth for each in made]
    first, second = (CycleCurves(lambda motion=motion: motion) for motion in motions)
    cluster = next(row.cluster for row in tables[0].primitives if row.kind == "primitive")
    found = first.compare_with(tables[0], cluster, "knee_l", second, tables[1])
    both = kineme.cycles(motions, tables, channels=["knee_l"])
    before = both.columns["recording"] == both.columns["recording"][0]
    compared = compare_curves(both.select(before), both.select(~before))
    for told, session in ((found, "first"), (found.beside, "second")):
        same(told, np.array([compared[f"{session}_{name}"] for name in ("n", "mean", "sd")]))
    assert found.beside.total == 7
    differs = (compared["low"] > 0) | (compared["high"] < 0)
    assert found.beside.differs == differs.tolist()
    assert any(differs)
    unnamed = name_cluster(tables[1], tables[1].primitives.cluster.max(), "")
    assert first.compare_with(tables[0], cluster, "knee_l", second, unnamed).beside is None
    assert first.make_curves(tables[0], cluster, "knee_l").beside is None


def test_signals_and_gaps() -> None:
    times = np.arange(3000) / 100
    values = np.column_stack([0.01 * np.sin(6 * times), 5 * np.cos(6 * times)])
    signals = Signals(values, 100.0, gaps=[(1500, 1510)])
    table = kineme.segment(signals)
    cluster = next(row.cluster for row in table.primitives if row.cluster >= 0)
    curves = CycleCurves(lambda: signals).make_curves(table, cluster)
    missing = [each for each in curves.cycles if None in each.values]
    assert missing
    assert not any(each.counts for each in missing)
    assert all(each.note for each in missing)
