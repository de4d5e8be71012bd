"""``kineme evaluate`` and ``kineme data`` as people run them."""

from __future__ import annotations

import csv
import json
import tomllib
from pathlib import Path

import pytest

import kineme as package
from kineme.datasets import bundled_recording, bundled_truth

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
    info = site / "kineme_reproduction-0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {project['name']}\nVersion: 0\n")
    lines = [
        line
        for group, points in project["entry-points"].items()
        for line in (f"[{group}]", *(f"{name} = {place}" for name, place in points.items()))
    ]
    (info / "entry_points.txt").write_text("\n".join(lines))
    monkeypatch.syspath_prepend(str(site))


@pytest.fixture(scope="module")
def seconds() -> float:
    return package.read_segments(bundled_truth()).activities.stop_s[-1]


def scores(path: Path) -> list[dict[str, str]]:
    return list(csv.DictReader(path.read_text().splitlines()))


@pytest.mark.usefixtures("benchmark")
def test_the_benchmark_prints_a_table_per_trial_and_the_means(kineme, data_dir, tmp_path):
    ran = kineme(
        *("evaluate", "cmu86", "--data", data_dir, "--trial", "86_01", "--trial", "86_11"),
        *("--preset", "voegele2014", "--method", "uniform", "-o", "out.json", "--plot", "bars"),
    )
    assert ran.returncode == 0, ran.stderr
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


def test_the_truth_against_itself_is_perfect(kineme, tmp_path):
    ran = kineme("evaluate", bundled_truth(), "--against", bundled_truth(), "-o", "out.csv")
    assert ran.returncode == 0, ran.stderr
    (row,) = scores(tmp_path / "out.csv")
    for name in ("one_to_one", "one_to_one_agreed", "rand_index", "border_f1"):
        assert float(row[name]) == pytest.approx(1.0), name


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
    assert ran.returncode == 0, ran.stderr
    (row,) = scores(tmp_path / "out.csv")
    assert float(row["border_f1"]) > 0.5
    assert "count_error" in row
    assert "counted exactly" in ran.stdout


def test_json_of_a_result_goes_to_standard_output_alone(kineme, tmp_path):
    ran = kineme("evaluate", bundled_truth(), "--against", bundled_truth(), "--json")
    assert (ran.returncode, ran.stderr) == (0, "")
    (row,) = json.loads(ran.stdout)["scores"]
    assert (row["result"], row["border_f1"]) == (Path(bundled_truth()).name, 1.0)


def test_one_label_per_frame_on_both_sides(kineme, tmp_path):
    for name, middle in (("found", 100), ("truth", 110)):
        lines = ["walk"] * middle + ["run"] * (200 - middle)
        (tmp_path / f"{name}.txt").write_text("\n".join(lines))
    ran = kineme("evaluate", "found.txt", "--against", "truth.txt", "--fps", 20, "-o", "out.csv")
    assert ran.returncode == 0, ran.stderr
    (row,) = scores(tmp_path / "out.csv")
    assert float(row["one_to_one"]) == pytest.approx(0.95)
    assert float(row["border_f1"]) == 0.0  # half a second is too far


def test_a_plain_table_of_intervals_is_a_result_too(kineme, tmp_path):
    (tmp_path / "found.csv").write_text("start_s,stop_s,label\n0,5,a\n5,10,b\n")
    (tmp_path / "truth.tsv").write_text("start_s\tstop_s\tlabel\n0\t4.9\twalk\n5.3\t10\trun\n")
    ran = kineme("evaluate", "found.csv", "--against", "truth.tsv", "-o", "out.csv")
    assert ran.returncode == 0, ran.stderr
    assert float(scores(tmp_path / "out.csv")[0]["border_f1"]) == 1.0


def test_right_borders_of_wrong_classes_are_explained(kineme, tmp_path):
    rows = "".join(f"{name},{5 * k},{5 * k + 5}\n" for k, name in enumerate("abcd"))
    (tmp_path / "truth.csv").write_text(f"label,start_s,stop_s\n{rows}")
    (tmp_path / "same.csv").write_text(f"label,start_s,stop_s\n{rows}")
    joined = rows.replace("c,", "a,").replace("d,", "b,")  # a cluster for two labels
    (tmp_path / "joined.csv").write_text(f"label,start_s,stop_s\n{joined}")
    right = kineme("evaluate", "same.csv", "--against", "truth.csv", "--fps", "30")
    wrong = kineme("evaluate", "joined.csv", "--against", "truth.csv", "--fps", "30")
    assert right.returncode == wrong.returncode == 0, wrong.stderr
    assert "borders are better than the classes" in wrong.stdout
    assert "borders are better than the classes" not in right.stdout


def test_the_benchmarks_own_annotations_know_the_trial_by_the_recordings_name(
    kineme, data_dir, tmp_path
):
    annotations = data_dir / "cmu86" / "annotations.json"
    recording = data_dir / "cmu86" / "86_11.amc"
    assert (
        kineme("segment", recording, "--preset", "voegele2014", "-o", "found.json", "-q").returncode
        == 0
    )
    ran = kineme("evaluate", "found.json", "--against", annotations, "-o", "out.csv", "-q")
    assert ran.returncode == 0, ran.stderr
    assert ran.stdout == ""
    row = scores(tmp_path / "out.csv")[0]
    assert float(row["border_f1"]) > 0.5
    wrong = kineme("evaluate", "found.json", "--against", annotations, "--trial", "86_01")
    assert wrong.returncode == 1
    assert "covers 38.17 s, but the result lasts 47.30 s" in wrong.stderr


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        ("0,20,a\n10,LAST,b", "'b' starts at frame 600, before the previous label stops (1200)"),
        ("0,20,a\n30,25,b\n30,LAST,c", "'b' stops at 25.0, before 30.0"),
        ("0,20,a\n20,1000,b", "cover 1000.000 s (60000 frames at 60 fps), but the recording lasts"),
        ("0,LAST,transition", "at least one action"),
        ("zero,LAST,a", "start_s must be a number, not 'zero'"),
    ],
)
def test_annotations_that_overlap_run_backwards_or_pass_the_end(
    kineme, table, seconds, tmp_path, rows, message
):
    text = rows.replace("LAST", str(seconds))
    (tmp_path / "labels.csv").write_text(f"start_s,stop_s,label\n{text}\n")
    ran = kineme("evaluate", table, "--against", "labels.csv", "-o", "out.csv")
    assert ran.returncode == 1
    assert ran.stderr.startswith("error: ")
    assert ran.stderr.count("\n") == 1
    assert "labels.csv" in ran.stderr
    assert message in ran.stderr
    assert not (tmp_path / "out.csv").exists()


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (("cmu86", "-o", "scores.xlsx"), 1, ".json or .csv"),
        (("cmu86", "-o", "nowhere/scores.csv"), 1, "does not exist"),
        (("cmu86", "--against", "labels.csv"), 2, "has its own annotations"),
        (("found.csv",), 2, "--against LABELS is needed"),
        (("found.csv", "--against", "labels.csv"), 1, "found.csv: cannot be read"),
        (("labels.txt", "--against", "labels.csv"), 1, "give fps (--fps)"),
        (("nope", "--against", "labels.csv"), 1, "nope: there is no such file"),
        (("nope", "--labels", "labels.csv"), 1, "nope: there is no such folder"),
    ],
)
def test_a_call_that_cannot_work_is_one_sentence(kineme, tmp_path, arguments, code, message):
    (tmp_path / "labels.txt").write_text("walk\n")
    ran = kineme("evaluate", *arguments)
    assert ran.returncode == code
    assert message in " ".join(ran.stderr.split())
    assert "Traceback" not in ran.stderr


@pytest.mark.usefixtures("benchmark")
@pytest.mark.parametrize(
    ("option", "code", "message"),
    [
        (("--method", "kmeans"), 2, "no method 'kmeans'"),
        (("--data", "."), 1, "kineme data cmu 86"),
    ],
)
def test_a_benchmark_that_cannot_run_is_one_sentence(kineme, option, code, message):
    ran = kineme("evaluate", "cmu86", *option)
    assert ran.returncode == code
    assert message in " ".join(ran.stderr.split())


def test_the_benchmark_that_is_not_installed_is_one_sentence(kineme, monkeypatch):
    monkeypatch.setattr("importlib.metadata.entry_points", lambda **_: ())
    ran = kineme("evaluate", "cmu86")
    assert ran.returncode == 1
    assert ran.stderr.count("\n") == 1
    assert "pip install ./reproduction" in ran.stderr


def test_another_length_of_labels_names_both(kineme, table, seconds, tmp_path):
    (tmp_path / "labels.txt").write_text("walk\n" * 600)
    ran = kineme("evaluate", table, "--against", "labels.txt", "--fps", 60)
    assert ran.returncode == 1
    assert f"cover 10.000 s (600 frames at 60 fps), but the recording lasts {seconds:.3f}"[:60] in (
        ran.stderr
    )


def test_data_says_what_it_took_or_why_not(kineme, data_dir, tmp_path):
    pytest.importorskip("pooch")
    folder = tmp_path / "cache" / "cmu86"
    folder.mkdir(parents=True)
    for name in ("86.asf", "86_01.amc"):
        (folder / name).symlink_to(data_dir / "cmu86" / name)
    (folder / "mocap.txt").write_text("86_01\nwalk 500 510 520\njump 4579 4579 4579\n")
    ran = kineme("data", "cmu", 86, "--trials", 1, KINEME_CACHE=str(tmp_path / "cache"))
    assert ran.returncode == 0, ran.stderr
    assert "86_01.amc: 4579 frames, 3.7 MB, there already" in ran.stderr
    assert "3 files in" in ran.stdout
    ran = kineme(
        *("data", "cmu", 7, "--timeout", 0.1),
        KINEME_CACHE=str(tmp_path / "cache"),
        KINEME_CMU_SITE="http://127.0.0.1:9",
    )
    assert ran.returncode == 1
    assert "gave up after 5 failed attempts" in ran.stderr


@pytest.mark.parametrize("trials", ["one", "0", "", "3-1", "1,3-1", "3-"])
def test_trials_that_are_no_numbers_are_refused(kineme, trials):
    ran = kineme("data", "cmu", 86, "--trials", trials)
    assert ran.returncode == 2
    assert "--trials" in ran.stderr
