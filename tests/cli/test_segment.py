"""``kineme segment`` and ``kineme demo`` from file to file, also of several takes."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

from matplotlib.image import imread

import kineme as package
from kineme.formats.scenes.fbx_writer import write_takes
from kineme.recordings.operations import cut


def test_the_table_counts_repetitions(kineme, recording: Path) -> None:
    done = kineme("segment", recording, "--preset", "krueger2017", errors="")
    rows = [line.split() for line in done.stdout.splitlines() if line.split()[1:2] == ["activity"]]
    result = package.segment(package.read(recording), preset="krueger2017")
    activities = [row for row in result.activities if row.kind == "activity"]
    assert len(rows) == len(activities)
    for cells, row in zip(rows, activities, strict=True):
        inside = result.primitives.activity == row.activity
        same = (result.primitives.cluster[inside] == row.cluster).sum()
        assert cells[2:6] == [
            f"{row.start_s:.2f}",
            f"{row.stop_s:.2f}",
            f"{row.start_frame}:{row.stop_frame}",
            str(same),
        ]
    assert f"{len(result.repetitions())} clusters." in done.stdout
    assert "note: unit cm inferred" in done.stdout


def test_a_warning_is_said_once(kineme_process, recording: Path) -> None:
    broken = recording.read_text().replace("Frames: 2898", "Frames: 2900")
    recording.write_text(broken)
    done = kineme_process("segment", recording)
    assert (done.stdout + done.stderr).count("2900") == 1
    (line,) = kineme_process("info", recording, "--json").stderr.splitlines()
    assert line.startswith(f"warning: {recording}")


def test_detail_gives_coarser_and_finer_segments(kineme, recording: Path, tmp_path: Path) -> None:
    whole = package.segment(package.read(recording))
    for detail in (0.3, 1, 8):
        table = tmp_path / f"{detail}.json"
        kineme("segment", recording, "--detail", detail, "--output", table, "--quiet", errors="")
        assert package.read_segments(table).table == whole.at_detail(detail).table
        assert package.read_segments(table).at_detail(1).table == whole.table
    refused = kineme("segment", recording, "--detail", 0, code=2)
    assert "detail must be a number above 0" in refused.stderr


def test_json_is_pure_and_is_what_the_library_gives(kineme, recording: Path) -> None:
    constants = ("--set", "radius=0.5", "--set", "growth-neighbors=none")
    options = ("--preset", "voegele2014", *constants)
    done = kineme("segment", recording, "--json", *options)
    data = json.loads(done.stdout)
    assert data["schema"] == "kineme.segments/2"
    assert data["provenance"]["parameters"]["radius"] == 0.5
    assert data["provenance"]["parameters"]["growth_neighbors"] is None
    result = package.segment(
        package.read(recording), preset="voegele2014", radius=0.5, growth_neighbors=None
    )
    assert [row["start_frame"] for row in data["segments"]] == result.table.start_frame.tolist()
    assert [row["cluster"] for row in data["segments"]] == result.table.cluster.tolist()


def test_what_was_written_is_said(kineme, recording: Path) -> None:
    done = kineme("segment", recording, "-o", "cuts", "--plot", "cuts.png")
    written = [line for line in done.stdout.splitlines() if line.startswith("written: ")]
    assert written == [f"written: {Path('cuts', 'exercises.csv')}", "written: cuts.png"]


def test_where_nothing_is_found_a_way_on_is_told(kineme, tmp_path: Path, recording: Path) -> None:
    motion = package.read(recording)
    package.write(cut(motion, 0, 20), tmp_path / "short.bvh")
    done = kineme("segment", "short.bvh", "--preset", "krueger2017")
    assert "note: no activity found" in done.stdout
    done = kineme("segment", "short.bvh")
    assert "1 activity, 0 transitions, 1 primitive" in done.stdout  # what happens once


def test_output_and_picture_are_written_quietly(kineme, tmp_path: Path, recording: Path) -> None:
    table, picture = tmp_path / "cuts.parquet", tmp_path / "cuts.png"
    done = kineme("segment", recording, "-q", "-o", table, "--plot", picture, errors="")
    assert done.stdout == ""
    written = package.read_segments(table)
    assert written.table == package.segment(package.read(recording)).table
    assert written.provenance["input"]["sha256"] == package.read(recording).provenance.sha256
    assert min(imread(picture).shape[:2]) > 1000


def test_several_files_go_into_a_folder_and_a_bad_one_stops_no_other(
    kineme, tmp_path: Path, recording: Path
) -> None:
    (tmp_path / "broken.bvh").write_text("HIERARCHY\nROOT Hips\n{\n")
    shutil.copy(recording, tmp_path / "again.bvh")
    done = kineme(
        "segment", "broken.bvh", "gone.bvh", "again.bvh", recording, "-o", "cuts", "-q", code=1
    )
    lines = done.stderr.splitlines()
    assert len(lines) == 2
    assert lines[0].startswith("error: broken.bvh")
    assert lines[1].startswith("error: gone.bvh: cannot be opened")
    tables = sorted(path.name for path in (tmp_path / "cuts").glob("*.csv"))
    assert tables == ["again.csv", "exercises.csv"]


def test_a_folder_stands_for_the_recordings_in_it(kineme, tmp_path: Path, recording: Path) -> None:
    folder = tmp_path / "takes"
    (folder / "deeper").mkdir(parents=True)
    short = cut(package.read(recording), 0, 300)
    for name in ("b.bvh", "a.trc", "deeper/c.bvh"):
        package.write(short, folder / name)
    (folder / "notes.txt").write_text("two takes")
    for _ in range(2):  # the second time the tables lie beside the recordings
        done = kineme("segment", "takes", recording, "-o", "takes")
        deeper = "skipped: takes: --recursive looks into its folders (deeper)\n"
        assert done.stderr == deeper
        told = [line.split()[0] for line in done.stdout.splitlines() if " at 60 Hz" in line]
        assert told == ["a.trc", "b.bvh", "exercises.bvh"]
    done = kineme("info", "takes", "--json")
    assert len(done.stdout.splitlines()) == 2
    done = kineme("report", "takes", "-o", "pages")
    assert {path.name for path in (tmp_path / "pages").iterdir()} == {"a.html", "b.html"}


def test_no_table_takes_the_place_of_a_recording(kineme, tmp_path: Path, recording: Path) -> None:
    package.write(package.read(recording), tmp_path / "take.csv")
    before = (tmp_path / "take.csv").read_bytes()
    for place in (".", "take.csv", tmp_path / "{name}.csv"):
        done = kineme("segment", "take.csv", "-o", place, code=2)
        assert "overwrite a recording" in " ".join(done.stderr.split())
    assert (tmp_path / "take.csv").read_bytes() == before


def test_a_folder_without_recordings_is_one_sentence(kineme, tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    (tmp_path / "empty" / "cuts.csv").write_text("start_s,stop_s,label\n0,1,walk\n")
    for command in (("segment",), ("info",), ("report", "-o", "pages")):
        done = kineme(*command, "empty", code=1)
        assert done.stdout == ""
        assert done.stderr == "error: empty: there is no recording in this folder\n"


def test_a_folder_that_is_a_recording_stays_one(kineme, tmp_path: Path) -> None:
    folder = tmp_path / "video"
    folder.mkdir()
    for number in range(40):
        keypoints = [value for point in range(25) for value in (point + 1, number / 9, 0.9)]
        frame = {"version": 1.3, "people": [{"pose_keypoints_2d": keypoints}]}
        (folder / f"video_{number:012}_keypoints.json").write_text(json.dumps(frame))
    done = kineme("info", "video", "--json", "--fps", 30)
    assert json.loads(done.stdout)["frames"] == 40


def test_the_demo_writes_table_and_picture(kineme, tmp_path: Path) -> None:
    done = kineme("demo", errors="")
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {"exercises.csv", "exercises.provenance.json", "exercises.png"}
    assert "exercises.png" in done.stdout
    assert len(package.read_segments(tmp_path / "exercises.csv")) > 20


def test_each_take_has_its_table_and_its_clips(kineme, tmp_path: Path) -> None:
    motion = package.read(package.bundled_recording())
    write_takes({"walk": motion[:240], "jump": motion[600:900]}, tmp_path / "two.fbx")
    kineme("segment", "two.fbx", "--take", "all", "-o", "tables", "-q", errors="")
    tables = sorted(path.name for path in (tmp_path / "tables").glob("*.csv"))
    assert tables == ["two_jump.csv", "two_walk.csv"]
    stops = [package.read_segments(tmp_path / "tables" / name).n_frames for name in tables]
    assert stops == [300, 240]
    tables = ("--take", "all", "--segments", "tables", "-q")
    kineme("split", "two.fbx", *tables, "-o", "clips.glb", errors="")
    assert sorted(path.name for path in tmp_path.glob("clips*")) == [
        "clips.glb",
        "clips.manifest.csv",
        "clips.manifest.json",
    ]
    takes = {name.split("_")[0] for name in package.formats.list_takes(tmp_path / "clips.glb")}
    assert takes == {"walk", "jump"}
