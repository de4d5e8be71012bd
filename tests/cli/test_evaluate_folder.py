"""``kineme evaluate FOLDER`` as people run it."""

from __future__ import annotations

import csv
import json
import sys
import time
from pathlib import Path

import pytest

from kineme.evaluation import folder
from kineme.evaluation.score import scores


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
    assert ran.returncode == 0, ran.stderr
    assert "recordings without labels, left out: unlabelled.csv" in ran.stderr
    assert "labels without a recording: ghost\n" in ran.stderr
    assert "broken.csv, kineme: " in ran.stderr
    assert "b.csv: overlapping others: 1 label" in ran.stderr
    for text in ("MoF", "Edit", "F1@50", "ARI", "NMI", "recordings scored", "2 of 3"):
        assert text in ran.stdout
    rows = list(csv.DictReader((tmp_path / "scores.csv").read_text().splitlines()))
    overall = {row["method"]: float(row["mof"]) for row in rows if row["recording"] == "*"}
    assert overall["kineme"] > 0.8 > overall["uniform"]
    assert [row["recording"] for row in rows if row["method"] == "gmm"] == [
        "a.csv", "b.csv", "broken.csv", "*",
    ]  # fmt: skip


@pytest.mark.usefixtures("in_one_process")
def test_json_goes_to_standard_output_alone(kineme, corpus) -> None:
    ran = kineme(
        *("evaluate", corpus, "--labels", corpus / "labels.csv", "--json"),
        *("--method", "uniform", "--columns", "gyro*", "--mapping", "folder"),
    )
    content = json.loads(ran.stdout)
    assert content["mapping"] == "folder"
    recordings = content["methods"]["uniform"]["recordings"]
    assert [one["recording"] for one in recordings] == ["a.csv", "b.csv", "broken.csv"]
    assert recordings[2]["error"]
    assert set(content["methods"]["uniform"]["scores"]) >= set(scores())


@pytest.mark.usefixtures("in_one_process")
def test_counts_of_a_table_are_compared(kineme, corpus, tmp_path) -> None:
    rows = ["recording,start_s,stop_s,label,count", "a,0,20,slow,10", "a,20,40,fast,"]
    (tmp_path / "labels.csv").write_text("\n".join(rows))
    ran = kineme("evaluate", corpus, "--labels", "labels.csv", "--method", "uniform")
    lines = ran.stdout.splitlines()
    (head,) = (line for line in lines if line.split()[:2] == ["MoF", "Edit"])
    (first,) = (line for line in lines if line.split()[:1] == ["a.csv"])
    assert head.split()[-2:] == ["count", "error"]
    assert float(first.split()[-1]) > 0
    assert "counted exactly" in ran.stdout


@pytest.mark.usefixtures("in_one_process")
def test_constants_of_the_methods_can_be_set(kineme, corpus) -> None:
    def told(*options: str) -> object:
        ran = kineme("evaluate", corpus, "--labels", corpus / "labels.csv", "--json", *options)
        assert ran.returncode == 0, ran.stderr
        found = json.loads(ran.stdout)["methods"]["kineme"]["scores"]
        return {name: value for name, value in found.items() if name != "seconds_per_hour"}

    assert told() == told("--set", "segment_cost=0.15")
    assert told() != told("--set", "segment_cost=5", "--set", "cluster_cost=20")
    ran = kineme("evaluate", corpus, "--labels", corpus / "labels.csv", "--set", "segment_price=5")
    assert ran.returncode == 2
    assert "has no parameter 'segment_price'; did you mean segment_cost?" in ran.stderr


@pytest.mark.usefixtures("in_one_process")
def test_a_pattern_that_no_column_fits_is_said(kineme, corpus) -> None:
    ran = kineme(
        *("evaluate", corpus, "--labels", corpus / "labels.csv", "--method", "uniform"),
        *("--without-columns", "emgg*"),
    )
    assert "a.csv: has no column like 'emgg*'" in ran.stderr
    assert "b.csv: has no column like 'emgg*'; overlapping" in ran.stderr


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--labels", "labels.csv", "--method", "kmeans"), "no method 'kmeans'"),
        ((), "--labels FILE or FOLDER is needed"),
        (("--labels", "nowhere.csv"), "cannot be read"),
    ],
)
def test_a_call_that_cannot_work_is_one_sentence(kineme, corpus, arguments, message) -> None:
    given = [corpus / a if str(a) == "labels.csv" else a for a in arguments]
    ran = kineme("evaluate", corpus, *given)
    assert ran.returncode != 0
    assert message in " ".join(ran.stderr.split())
    assert "Traceback" not in ran.stderr


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
    assert ran.returncode == 0, ran.stderr
    assert "broken.csv: " in ran.stderr
    for text in ("agreement of 2 annotators, by names", "Cohen's kappa", "anna, ben"):
        assert text in ran.stdout
    rows = list(csv.DictReader((tmp_path / "agreement.csv").read_text().splitlines()))
    assert [row["recording"] for row in rows] == ["*", "*", "a.csv", "b.csv"]
    assert float(rows[2]["fleiss_kappa"]) == 1 > float(rows[0]["cohen_kappa"]) > 0.5
    content = json.loads(kineme(*people, "--json").stdout)
    said = [each["labels"] for each in content["recordings"][1]["differences"]]
    assert said == [["fast", "slow"], ["fast", ""]]
    ran = kineme(*people, "--method", "uniform")
    assert ran.returncode == 2
    assert "several --labels compare annotators" in ran.stderr
