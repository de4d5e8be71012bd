"""kineme cycles, kineme events: as people run them."""

from __future__ import annotations

import csv
import shutil
from pathlib import Path

import pytest

from kineme.datasets import bundled_recording, bundled_truth


@pytest.fixture
def take(tmp_path: Path) -> Path:
    path = tmp_path / "take.bvh"
    shutil.copy(bundled_recording(), path)
    shutil.copy(bundled_truth(), tmp_path / "truth.json")
    return path


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_cycles_are_measured_written_and_drawn(kineme, take: Path, tmp_path: Path) -> None:
    done = kineme(
        "cycles", "take.bvh", "--segments", "truth.json", "--channels", "knee_*", "-o", "c.csv",
        "--plot", "c.png", "--exclude", "6", "--sides", "sides.csv",
    )  # fmt: skip
    assert "squat" in done.stdout
    assert "inner repetitions" in done.stdout
    assert "1 cycle left out: by hand." in done.stdout
    rows = rows_of(tmp_path / "c.csv")
    assert [row["group"] for row in rows[5:9]] == ["squat"] * 4
    assert rows[6]["excluded"] == "by hand"
    assert float(rows[6]["knee_l.range"]) == pytest.approx(102, abs=3)
    assert (tmp_path / "c.png").stat().st_size > 5000
    sides = [row for row in rows_of(tmp_path / "sides.csv") if row["measure"] == "range"]
    assert {row["right_channel"] for row in sides} == {"knee_r"}


def test_several_recordings_are_measured_together(kineme, take: Path, tmp_path: Path) -> None:
    shutil.copy(take, tmp_path / "other.bvh")
    (tmp_path / "tables").mkdir()
    for name in ("take", "other"):
        shutil.copy(tmp_path / "truth.json", tmp_path / "tables" / f"{name}.json")
    kineme(
        "cycles", "take.bvh", "other.bvh", "--segments", "tables/{name}.json", "-o", "c.csv",
        "--channels", "knee_l", "-q", "--compare", "both.csv", "--plot", "both.png",
    )  # fmt: skip
    rows = rows_of(tmp_path / "c.csv")
    assert {row["recording"] for row in rows} == {"take", "other"}
    assert len({row["group"] for row in rows}) == 6
    compared = rows_of(tmp_path / "both.csv")
    assert (compared[0]["group"], compared[0]["measure"]) == ("walk", "duration_s")
    assert float(compared[0]["difference"]) == pytest.approx(0, abs=1e-9)
    assert (tmp_path / "both.curves.csv").exists()
    done = kineme(
        "cycles", "take.bvh", "other.bvh", "--segments", "tables/{name}.json",
        "--compare", "both.html",
    )  # fmt: skip
    squats = [line.split() for line in done.stdout.splitlines() if " squat " in line]
    assert [line[:4] for line in squats] == [
        ["take", "squat", "4", "2"],
        ["other", "squat", "4", "2"],
    ]
    assert "8 more channels measured" in done.stdout
    assert (tmp_path / "both.png").stat().st_size > 5000
    assert "<h1>take → other</h1>" in (tmp_path / "both.html").read_text(encoding="utf-8")
    kineme("cycles", "take.bvh", "--compare", "both.csv", code=2)
    unnamed = kineme(
        "cycles", "take.bvh", "other.bvh", "--compare", "both.csv", "--plot", "unnamed.png",
        "--channels", "knee_l",
        code=1,
    )  # fmt: skip
    assert "clusters the same names" in unnamed.stderr
    assert (tmp_path / "unnamed.png").exists()


def test_an_anchor_begins_each_cycle(kineme, take: Path) -> None:
    done = kineme("cycles", "take.bvh", "--segments", "truth.json", "--anchor", "knee_r max")
    assert "left out: no event follows it" in done.stdout


@pytest.mark.parametrize(
    ("options", "code", "said"),
    [
        (["--channels", "kne"], 1, "no channel 'kne'; there are knee_l, knee_r"),
        (["--anchor", "hop"], 1, "no event 'hop'; there are left foot strike"),
        (["--exclude", "999"], 1, "there is no cycle 999"),
        (["-o", "no/folder/c.csv"], 1, "c.csv"),
        (["-o", "c.doc"], 2, "--output"),
        (["--plot", "c.csv"], 2, "--plot"),
        (["--exclude", "some"], 2, "--exclude"),
    ],
)
def test_what_cannot_be_is_one_sentence(kineme, take: Path, options, code, said) -> None:
    done = kineme("cycles", "take.bvh", "--segments", "truth.json", *options, code=code)
    assert said in done.stderr
    assert code == 2 or done.stderr.count("\n") == 1


def test_events_are_told_and_written(kineme, take: Path, tmp_path: Path) -> None:
    done = kineme("events", "take.bvh", "-o", "e.csv", "--gait", "g.csv", "--labels", "e.TextGrid")
    assert "left foot: from LeftFoot and LeftToeBase" in done.stdout
    assert "stride_s" in done.stdout
    rows = rows_of(tmp_path / "e.csv")
    assert {row["event"] for row in rows} == {
        f"{side} foot {what}" for side in ("left", "right") for what in ("strike", "off")
    }
    mean = rows_of(tmp_path / "g.csv")[0]
    assert mean["measure"] == "stride_s"
    strides = [row for row in rows_of(tmp_path / "g.strides.csv") if row["foot"] == "left"]
    assert len(strides) == int(mean["left_n"])
    lengths = [float(row["stride_s"]) for row in strides]
    assert sum(lengths) / len(lengths) == pytest.approx(float(mean["left_mean"]))
    assert "left foot strike" in (tmp_path / "e.TextGrid").read_text()


def test_a_recording_without_feet_is_one_sentence(kineme, tmp_path: Path) -> None:
    lines = ["time_s,x,y", *(f"{i / 50},{i % 7},{i % 5}" for i in range(100))]
    (tmp_path / "s.csv").write_text("\n".join(lines))
    done = kineme("events", "s.csv", code=1)
    assert "no foot found" in done.stderr


@pytest.mark.filterwarnings("ignore::kineme.KinemeWarning")
def test_force_plates_of_a_c3d_are_measured_at_their_own_rate(
    kineme, data_dir: Path, tmp_path: Path
) -> None:
    trial = data_dir / "formats" / "Eb015pi.c3d"
    kineme("cycles", trial, "--channels", "FZ1,RFT1.speed", "-o", "c.csv")
    rows = rows_of(tmp_path / "c.csv")
    assert all(row["FZ1.range"] for row in rows if row["excluded"] == "")
    assert "FZ1" in kineme("info", "--channels", trial).stdout
    shutil.copy(trial, tmp_path / "again.c3d")
    kineme("cycles", trial, "again.c3d", "--channels", "FZ1,RFT1.speed", "-o", "both.csv", "-q")
    both = [row["FZ1.range"] for row in rows_of(tmp_path / "both.csv")]
    assert both == [row["FZ1.range"] for row in rows] * 2


def test_where_no_repetition_is_an_inner_one_it_says_what_to_do(kineme, take: Path) -> None:
    lines = ["start_s,stop_s,label,level", "0,5.5,walk,activity", "0,2.7,walk,primitive"]
    lines.append("2.7,5.5,walk,primitive")
    Path("two.csv").write_text("\n".join(lines) + "\n")
    command = "cycles", "take.bvh", "--segments", "two.csv", "--channels", "knee_l"
    done = kineme(*command, "--plot", "c.png", "-o", "c.csv")
    assert "c.png: no inner repetitions to draw: --ends" in done.stderr
    assert Path("c.csv").exists()
    kineme(*command, "--plot", "c.png", code=1)
    assert not Path("c.png").exists()
    assert "walk: no inner repetitions; --ends includes the first and last" in done.stdout


def test_rows_of_a_person_are_the_cycles_to_the_frame(kineme, take: Path) -> None:
    rows = ["0.1,1.2,stride", "1.2,2.3,stride", "2.4,3.6,stride", "3.6,4.7,stride"]
    for level in ("", "primitive,"):
        header = f"{'level,' if level else ''}start_s,stop_s,label"
        Path("cut.csv").write_text("\n".join([header, *(f"{level}{row}" for row in rows)]))
        done = kineme(
            "cycles", "take.bvh", "--segments", "cut.csv", "--channels", "knee_l", "-o", "c.csv"
        )
        starts = [float(row["start_frame"]) for row in rows_of(Path("c.csv"))]
        assert starts == [6, 72, 144, 216]
        assert " stride        4   4 " in done.stdout
    kineme("cycles", "take.bvh", "--segments", "cut.csv", "--refine", "-q", "-o", "c.csv")
    assert float(rows_of(Path("c.csv"))[1]["start_frame"]) != 72
    Path("none.csv").write_text("start_s,stop_s,label\n0,4,transition\n")
    none = kineme("cycles", "take.bvh", "--segments", "none.csv", "-q", code=1)
    assert "Give a table with a row for each" in none.stderr


def test_a_recording_of_other_channels_costs_itself_alone(
    kineme, take: Path, tmp_path: Path
) -> None:
    shutil.copy(take, tmp_path / "other.bvh")
    (tmp_path / "truth.json").unlink()
    rows = "".join(f"{i / 50},{i % 40}\n" for i in range(900))
    (tmp_path / "wrist.csv").write_text(f"time,acc_x\n{rows}", encoding="utf-8")
    together = kineme("cycles", ".", "-o", "out.csv")
    assert "wrist.csv: does not have the channels of the others" in together.stderr
    assert {row["recording"] for row in rows_of(tmp_path / "out.csv")} == {"take", "other"}
    kineme("cycles", "take.bvh", "other.bvh", "wrist.csv", code=1)
