"""``kineme evaluate`` as people run it: results, the benchmark, folders."""

from __future__ import annotations

import csv
import json
import sys
import time
import tomllib
from pathlib import Path

import pytest

import kineme as package
from kineme.datasets import bundled_recording, bundled_truth
from kineme.evaluation import folder
from kineme.evaluation.score import scores as all_scores
from plugins import install_package

REPRODUCTION = Path(__file__).parents[2] / "reproduction"


@pytest.fixture(scope="module")
def table(tmp_path_factory) -> Path:
    """A segment table of the recording that comes with the package."""
    path = tmp_path_factory.mktemp("found") / "exercises.csv"
    motion = package.read(bundled_recording())
    package.write_segments(package.segment(motion), path)
    return path


@pytest.fixture
def benchmark(tmp_path_factory, monkeypatch) -> None:
    """The part of the package that reproduces papers, as an installer leaves it."""
    project = tomllib.loads((REPRODUCTION / "pyproject.toml").read_text())["project"]
    site = tmp_path_factory.mktemp("site")
    lines = [
        line
        for group, points in project["entry-points"].items()
        for line in (f"[{group}]", *(f"{name} = {place}" for name, place in points.items()))
    ]
    install_package(site, "kineme_reproduction", "\n".join(lines))
    monkeypatch.syspath_prepend(str(site))


def scores(path: Path) -> list[dict[str, str]]:
    return list(csv.DictReader(path.read_text().splitlines()))


@pytest.mark.usefixtures("benchmark")
def test_the_benchmark_prints_a_table_per_trial_and_the_means(kineme, data_dir, tmp_path):
    ran = kineme(
        *("evaluate", "cmu86", "--data", data_dir, "--trial", "86_01", "--trial", "86_11"),
        *("--preset", "voegele2014", "--method", "uniform", "-o", "out.json", "--plot", "bars"),
    )
    titles = [line for line in ran.stdout.splitlines() if line.startswith(("86_", "mean"))]
    assert titles == ["86_01", "86_11", "mean of 2 trials"]
    assert "voegele2014" in ran.stdout
    assert ran.stdout.count("border F1") == 3
    content = json.loads((tmp_path / "out.json").read_text())["scores"]
    assert {(row["trial"], row["method"]) for row in content} == {
        (trial, method)
        for trial in ("86_01", "86_11", "mean")
        for method in ("voegele2014", "uniform")
    }
    assert sorted(path.name for path in (tmp_path / "bars").iterdir()) == ["86_01.png", "86_11.png"]


def test_a_found_table_against_own_intervals_with_counts(kineme, table, tmp_path):
    truth = package.read_segments(bundled_truth())
    rows = [
        (row.start_s, row.stop_s, row.label, int((truth.primitives.activity == i).sum()))
        for i, row in enumerate(truth.activities)
        if row.kind == "activity"
    ]
    rows[0] = (0.0, *rows[0][1:])
    rows[-1] = (rows[-1][0], truth.n_frames / truth.fps, *rows[-1][2:])
    lines = ["start_s,stop_s,label,count", *(",".join(map(str, row)) for row in rows)]
    (tmp_path / "labels.csv").write_text("\n".join(lines))
    ran = kineme("evaluate", table, "--against", "labels.csv", "-o", "out.csv")
    (row,) = scores(tmp_path / "out.csv")
    assert float(row["border_f1"]) > 0.5
    assert "count_error" in row
    assert "counted exactly" in ran.stdout


def test_json_of_a_result_goes_to_standard_output_alone(kineme, tmp_path):
    ran = kineme("evaluate", bundled_truth(), "--against", bundled_truth(), "--json", errors="")
    (row,) = json.loads(ran.stdout)["scores"]
    assert (row["result"], row["border_f1"]) == (Path(bundled_truth()).name, 1.0)


def test_a_plain_table_of_intervals_is_a_result_too(kineme, tmp_path):
    (tmp_path / "found.csv").write_text("start_s,stop_s,label\n0,5,a\n5,10,b\n")
    (tmp_path / "truth.tsv").write_text("start_s\tstop_s\tlabel\n0\t4.9\twalk\n5.3\t10\trun\n")
    kineme("evaluate", "found.csv", "--against", "truth.tsv", "-o", "out.csv")
    assert float(scores(tmp_path / "out.csv")[0]["border_f1"]) == 1.0


def test_right_borders_of_wrong_classes_are_explained(kineme, tmp_path):
    rows = "".join(f"{name},{5 * k},{5 * k + 5}\n" for k, name in enumerate("abcd"))
    (tmp_path / "truth.csv").write_text(f"label,start_s,stop_s\n{rows}")
    (tmp_path / "same.csv").write_text(f"label,start_s,stop_s\n{rows}")
    joined = rows.replace("c,", "a,").replace("d,", "b,")  # a cluster for two labels
    (tmp_path / "joined.csv").write_text(f"label,start_s,stop_s\n{joined}")
    right = kineme("evaluate", "same.csv", "--against", "truth.csv", "--fps", "30")
    wrong = kineme("evaluate", "joined.csv", "--against", "truth.csv", "--fps", "30")
    assert "borders are better than the classes" in wrong.stdout
    assert "borders are better than the classes" not in right.stdout


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (("cmu86", "-o", "scores.xlsx"), 2, ".json, .csv"),
        (("cmu86", "-o", "nowhere/scores.csv"), 1, "does not exist"),
        (("cmu86", "--against", "labels.csv"), 2, "has its own annotations"),
        (("found.csv",), 2, "--against LABELS is needed"),
        (("found.csv", "--against", "labels.csv"), 1, "found.csv: cannot be read"),
        (("labels.txt", "--against", "labels.csv"), 1, "give fps (--fps)"),
        (("nope", "--against", "labels.csv"), 1, "nope: there is no such file"),
        (("nope", "--labels", "labels.csv"), 1, "nope: there is no such folder"),
        (("folder",), 2, "--labels FILE or FOLDER is needed"),
        (("folder", "--labels", "nowhere.csv"), 1, "cannot be read"),
        (("folder", "--labels", "labels.csv", "--method", "kmeans"), 2, "no method 'kmeans'"),
    ],
)
def test_a_call_that_cannot_work_is_one_sentence(kineme, tmp_path, arguments, code, message):
    (tmp_path / "labels.txt").write_text("walk\n")
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder" / "a.csv").write_text("time,x\n0,1\n")
    ran = kineme("evaluate", *arguments, code=code)
    assert message in " ".join(ran.stderr.split())
    assert "Traceback" not in ran.stderr


@pytest.mark.usefixtures("benchmark")
@pytest.mark.parametrize(
    ("option", "code", "message"),
    [(("--method", "kmeans"), 2, "no method 'kmeans'"), (("--data", "."), 1, "kineme-cmu 86")],
)
def test_a_benchmark_that_cannot_run_is_one_sentence(kineme, option, code, message):
    ran = kineme("evaluate", "cmu86", *option, code=code)
    assert message in " ".join(ran.stderr.split())


def test_the_benchmark_that_is_not_installed_is_one_sentence(kineme, monkeypatch):
    monkeypatch.setattr("importlib.metadata.entry_points", lambda **_: ())
    ran = kineme("evaluate", "cmu86", code=1)
    assert ran.stderr.count("\n") == 1
    assert "pip install ./reproduction" in ran.stderr


@pytest.fixture
def in_one_process(monkeypatch: pytest.MonkeyPatch) -> None:
    """To start the others takes longer than what these tests want of them."""
    run_jobs = folder.run_jobs
    monkeypatch.setattr(folder, "run_jobs", lambda jobs, _: run_jobs(jobs, 1))


def test_the_command_scores_methods_side_by_side(kineme, corpus, tmp_path) -> None:
    table = (corpus / "labels.csv").read_text() + "\nghost,0,1,walk\n"
    (tmp_path / "labels.csv").write_text(table)
    ran = kineme(
        *("evaluate", corpus, "--labels", "labels.csv", "--methods", "kineme,uniform,gmm"),
        *("--without-columns", "emg*", "-o", "scores.csv"),
    )
    assert "recordings without labels, left out: unlabelled.csv" in ran.stderr
    assert "labels without a recording: ghost\n" in ran.stderr
    assert "broken.csv, kineme: " in ran.stderr
    assert "b.csv: overlapping others: 1 label" in ran.stderr
    for text in ("MoF", "Edit", "F1@50", "ARI", "NMI", "recordings scored", "2 of 3"):
        assert text in ran.stdout
    rows = scores(tmp_path / "scores.csv")
    overall = {row["method"]: float(row["mof"]) for row in rows if row["recording"] == "*"}
    assert overall["kineme"] > 0.8 > overall["uniform"]
    assert [row["recording"] for row in rows if row["method"] == "gmm"] == [
        "a.csv", "b.csv", "broken.csv", "*",
    ]  # fmt: skip


@pytest.mark.usefixtures("in_one_process")
def test_json_of_a_folder_goes_to_standard_output_alone(kineme, corpus) -> None:
    ran = kineme(
        *("evaluate", corpus, "--labels", corpus / "labels.csv", "--json"),
        *("--method", "uniform", "--columns", "gyro*", "--mapping", "folder"),
    )
    content = json.loads(ran.stdout)
    assert content["mapping"] == "folder"
    recordings = content["methods"]["uniform"]["recordings"]
    assert [one["recording"] for one in recordings] == ["a.csv", "b.csv", "broken.csv"]
    assert recordings[2]["error"]
    assert set(content["methods"]["uniform"]["scores"]) >= set(all_scores())


@pytest.mark.usefixtures("in_one_process")
def test_constants_of_the_methods_can_be_set(kineme, corpus) -> None:
    def told(*options: str) -> object:
        ran = kineme("evaluate", corpus, "--labels", corpus / "labels.csv", "--json", *options)
        found = json.loads(ran.stdout)["methods"]["kineme"]["scores"]
        return {name: value for name, value in found.items() if name != "seconds_per_hour"}

    assert told() == told("--set", "segment_cost=0.15")
    assert told() != told("--set", "segment_cost=5", "--set", "cluster_cost=20")
    ran = kineme(
        "evaluate", corpus, "--labels", corpus / "labels.csv", "--set", "segment_price=5", code=2
    )
    assert "has no parameter 'segment_price'; did you mean segment_cost?" in ran.stderr


@pytest.mark.usefixtures("in_one_process")
def test_a_pattern_that_no_column_fits_is_said(kineme, corpus) -> None:
    ran = kineme(
        *("evaluate", corpus, "--labels", corpus / "labels.csv", "--method", "uniform"),
        *("--without-columns", "emgg*"),
    )
    assert "a.csv: has no column like 'emgg*'" in ran.stderr
    assert "b.csv: has no column like 'emgg*'; overlapping" in ran.stderr


@pytest.mark.skipif(sys.platform != "linux", reason="looks for processes where Linux lists them")
def test_control_c_ends_it_quietly(interrupted, corpus) -> None:
    def at_work(process: int) -> bool:
        begun = bool(Path(f"/proc/{process}/task/{process}/children").read_text())
        time.sleep(0.3 * begun)  # its processes are being started
        return begun

    command = ("evaluate", corpus, "-q", "--labels", corpus / "labels.csv")
    assert interrupted(at_work, *command, "--methods", "kineme,ppca,gmm") == (130, "", "")


def test_several_labels_tell_how_far_people_agree(kineme, corpus, tmp_path) -> None:
    labels = (corpus / "labels.csv").read_text()
    (tmp_path / "anna.csv").write_text(labels)
    (tmp_path / "ben.csv").write_text(labels.replace("b,20,40", "b,26,40"))
    people = ("evaluate", corpus, "--labels", "anna.csv", "--labels", "ben.csv")
    ran = kineme(*people, "-o", "agreement.csv")
    assert "broken.csv: " in ran.stderr
    for text in ("agreement of 2 annotators, by names", "Cohen's kappa", "anna, ben"):
        assert text in ran.stdout
    rows = scores(tmp_path / "agreement.csv")
    assert [row["recording"] for row in rows] == ["*", "*", "a.csv", "b.csv"]
    assert float(rows[2]["fleiss_kappa"]) == 1 > float(rows[0]["cohen_kappa"]) > 0.5
    content = json.loads(kineme(*people, "--json").stdout)
    said = [each["labels"] for each in content["recordings"][1]["differences"]]
    assert said == [["fast", "slow"], ["fast", ""]]
    ran = kineme(*people, "--method", "uniform", code=2)
    assert "several --labels compare annotators" in ran.stderr
