"""What a build leaves, whatever happens to it on the way."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from library_folders import contents, copy_takes, write_channels

import kineme
from kineme.errors import ReadError, WriteError
from kineme.formats import ReadOptions
from kineme.library import Library, build, gathering
from kineme.library.edits import read_edits
from kineme.methods.segmenter import SegmentOptions
from plugins import install_package


def test_one_bad_file_costs_itself_only(built: Path, takes: Path) -> None:
    library = Library(built)
    assert library.recordings["recording"] == ["jacks.bvh", "walk.bvh", "wrist.csv"]
    assert list(library.failed) == [str(takes / "broken.bvh")]
    assert "broken.bvh" in library.failed[str(takes / "broken.bvh")]


def test_a_name_that_no_table_holds_costs_its_file_only(tmp_path: Path) -> None:
    takes = tmp_path / "takes"
    takes.mkdir()
    write_channels(takes / "sound.csv")
    odd = takes / os.fsdecode(b"odd\xff.csv")
    try:
        write_channels(odd)
    except OSError:
        pytest.skip("this file system takes text for names only")
    made = build(takes, tmp_path / "library", jobs=1)
    assert "is not UTF-8" in made.failed[odd]
    library = Library(tmp_path / "library")
    assert library.recordings["recording"] == ["sound.csv"]
    assert list(library.failed) == [str(odd)]


def test_an_unchanged_library_is_left_as_it_is(folder: Path) -> None:
    before = {path: path.stat().st_mtime_ns for path in folder.rglob("*.*")}
    again = build((), folder)
    assert (again.new, again.removed) == (0, 0)
    assert {path: path.stat().st_mtime_ns for path in folder.rglob("*.*")} == before


def test_recordings_come_and_go(takes: Path, tmp_path: Path) -> None:
    own, folder = copy_takes(takes, tmp_path, a="wrist.csv"), tmp_path / "library"
    assert build(own, folder).new == 1
    os.utime(own / "a.csv", (1, 1))  # the content is the same
    assert build((), folder).new == 0
    shutil.copy(takes / "walk.bvh", own / "b.bvh")
    assert build((), folder).new == 1
    (own / "a.csv").unlink()
    gone = build((), folder)
    assert (gone.new, gone.removed) == (0, 1)
    assert Library(folder).recordings["recording"] == ["b.bvh"]
    assert len(list((folder / "pieces").glob("*.parquet"))) == 1


def test_another_skeleton_makes_another_recording(tmp_path: Path) -> None:
    motion = kineme.read(kineme.bundled_recording())[:200]
    kineme.write(motion, tmp_path / "take.amc")
    folder = tmp_path / "library"
    assert build(tmp_path / "take.amc", folder).new == 1
    skeleton = next(tmp_path.glob("*.asf"))
    skeleton.write_text(skeleton.read_text() + "\n# another one\n")
    assert build((), folder).new == 1


def test_options_stay_until_others_are_given(takes: Path, tmp_path: Path) -> None:
    folder = tmp_path / "library"
    said, method = ReadOptions(fps=25.0), SegmentOptions(constants={"bands": (0.5, 3.0)})
    given = {"read_options": said, "segment_options": method}
    assert build(takes / "wrist.csv", folder, **given).new == 1
    assert build((), folder).new == 0
    library = Library(folder)
    assert library.read_options == said
    assert library.segment_options.constants == method.constants
    assert build((), folder, read_options=ReadOptions()).new == 1
    assert Library(folder).segment_options.constants == method.constants
    assert build((), folder, segment_options=SegmentOptions()).new == 1


def test_a_library_keeps_segments_of_the_detail_asked_for(tmp_path: Path) -> None:
    folder = tmp_path / "library"
    asked = "select count(*) n from segments where level = 'activity'"
    found = kineme.segment(kineme.read(kineme.bundled_recording()))
    counts = []
    for detail in (0.2, 1.0):
        options = SegmentOptions(detail=detail)
        built = build(kineme.bundled_recording(), folder, segment_options=options)
        assert built.new == 1
        assert build((), folder).new == 0
        (row,) = Library(folder).query(asked).to_pylist()
        assert row["n"] == len(found.at_detail(detail).level("activity"))
        counts.append(row["n"])
    assert counts[0] < counts[1]


def test_a_source_that_is_gone_keeps_its_recordings_until_it_is_removed(
    takes: Path, tmp_path: Path
) -> None:
    own, folder = copy_takes(takes, tmp_path, wrist="wrist.csv"), tmp_path / "library"
    build(own, folder)
    own.rename(tmp_path / "elsewhere")
    kept = build((), folder)
    assert [path.name for path in kept.paths] == ["wrist.csv"]
    assert "recordings are kept" in kept.failed[own]
    build(tmp_path / "elsewhere", folder, remove=[own])
    assert Library(folder).recordings["path"] == [str(tmp_path / "elsewhere" / "wrist.csv")]


def test_a_mistyped_source_is_said_and_forgotten(folder: Path, tmp_path: Path) -> None:
    assert tmp_path / "takse" in build(tmp_path / "takse", folder).failed
    assert tmp_path / "takse" not in build((), folder).failed


def test_recordings_of_one_name_are_told_apart_and_keep_their_names(
    takes: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "library"
    for place in ("b", "a"):
        (tmp_path / place).mkdir()
        shutil.copy(takes / "wrist.csv", tmp_path / place)
        build(tmp_path / place, folder)
    paths = dict(zip(Library(folder).recordings["recording"], Library(folder).recordings["path"]))
    assert paths == {
        "wrist.csv": str(tmp_path / "b" / "wrist.csv"),
        "a/wrist.csv": str(tmp_path / "a" / "wrist.csv"),
    }


def test_the_number_of_processes_changes_no_byte(built: Path, takes: Path, tmp_path: Path) -> None:
    build(takes, tmp_path / "library", jobs=2)
    assert contents(tmp_path / "library") == contents(built)


class Backwards:
    """Works on the last task first."""

    def completed(self, work, tasks, *, workers=None):
        return ((task, work(task)) for task in reversed(tasks))


def test_channels_have_clusters_in_common_that_keep_number_and_name(tmp_path: Path) -> None:
    own, folder = tmp_path / "takes", tmp_path / "library"
    own.mkdir()
    for seed, name in enumerate("abc"):
        write_channels(own / f"{name}.csv", seed)

    def numbers(library: Library) -> dict[str, set[int]]:
        """Clusters of the slow movement, and of the fast one, over all recordings."""
        rows = [row for row in library.table("segments").to_pylist() if row["kind"] != "transition"]
        slow = {row["cluster"] for row in rows if row["stop_s"] < 19}
        return {"slow": slow, "fast": {row["cluster"] for row in rows if row["start_s"] > 21}}

    build([own / "a.csv", own / "b.csv"], folder)
    before = numbers(Library(folder))
    assert len(before["slow"]) == len(before["fast"]) == 1
    assert before["slow"] != before["fast"]
    Library(folder).name(*before["fast"], "fast")
    build(own / "c.csv", folder)
    assert numbers(Library(folder)) == before
    labels = {row["label"] for row in Library(folder).table("segments").to_pylist()}
    assert labels == {"", "fast"}
    build(own, tmp_path / "once")
    build(own, tmp_path / "backwards", client=Backwards())
    assert contents(tmp_path / "backwards") == contents(tmp_path / "once")


def write_moves(path: Path, seed: int) -> None:
    """A minute of four movements, between all of which there is no clear line."""
    random = np.random.default_rng(seed)
    parts = []
    for _ in range(4):
        size, lean = random.uniform(0.02, 1.5, 6), random.uniform(-0.2, 0.2, 6)
        wave = np.sin(2 * np.pi * random.uniform(0.4, 3) * np.arange(450) / 30)
        parts.append(lean + size * wave[:, None])
    values = np.concatenate(parts) + 0.05 * random.normal(size=(1800, 6))
    lines = [",".join(f"{x:.5f}" for x in (i / 30, *row)) for i, row in enumerate(values.tolist())]
    path.write_text("\n".join(["time_s,a,b,c,d,e,f", *lines]))


def test_clusters_of_channels_do_not_depend_on_names_of_files(tmp_path: Path) -> None:
    found = []
    for order in ("012345", "543210"):
        called = dict(zip("abcdef", order, strict=True))
        home = tmp_path / order
        home.mkdir()
        for name, seed in called.items():
            write_moves(home / f"{name}.csv", int(seed))
        build(home, home / "library")
        rows = Library(home / "library").table("segments").to_pylist()
        held = ("level", "start_frame", "cluster")
        found.append(sorted((called[r["recording"][0]], *(r[name] for name in held)) for r in rows))
    assert len({cluster for *_, cluster in found[0]}) > 5
    assert found[1] == found[0]


def test_clusters_whose_recordings_leave_and_come_back_keep_number_and_name(
    takes: Path, tmp_path: Path
) -> None:
    own, folder = copy_takes(takes, tmp_path, walk="walk.bvh"), tmp_path / "library"
    write_channels(own / "wrist.csv")
    build(own, folder)

    def clusters() -> dict[str, list[tuple[int, float, int]]]:
        found: dict[str, list[tuple[int, float, int]]] = {".csv": [], ".bvh": []}
        for row in Library(folder).table("segments").to_pylist():
            suffix = Path(row["recording"]).suffix
            found[suffix].append((row["segment"], row["start_s"], row["cluster"]))
        return found

    before = clusters()
    number = next(cluster for *_, cluster in before[".csv"] if cluster >= 0)
    Library(folder).name(number, "slow")
    (own / "wrist.csv").rename(tmp_path / "aside.csv")
    build((), folder)
    assert clusters() == {".csv": [], ".bvh": before[".bvh"]}
    write_channels(own / "other.csv", seed=8)
    build((), folder)  # takes numbers that nothing had
    (own / "other.csv").unlink()
    (tmp_path / "aside.csv").rename(own / "left_arm.csv")
    build((), folder)
    assert clusters() == before
    assert "slow" in {each.label for each in Library(folder).clusters()}
    (folder / "left.json").write_text('{"a": [[1], [2]]}')
    (own / "walk.bvh").unlink()
    with pytest.raises(ReadError, match=r"left.json: is damaged: remove it"):
        build((), folder)


@pytest.mark.parametrize(
    "change", ["rename", "shorten and restore", "exchange", "remove and restore", "rename back"]
)
def test_names_and_splits_follow_the_content_of_files(
    takes: Path, tmp_path: Path, change: str
) -> None:
    own = copy_takes(takes, tmp_path, walk="walk.bvh", jacks="jacks.bvh")
    folder, walk, jacks = tmp_path / "library", own / "walk.bvh", own / "jacks.bvh"
    build(own, folder)
    library = Library(folder)
    for each in library.clusters():
        library.name(each.cluster, f"movement {each.cluster}")
    shared = next(each.cluster for each in library.clusters() if each.recordings == 2)
    library.name(library.split(shared, ["jacks.bvh"]), "of one recording")
    before = [each._replace(example="") for each in library.clusters()]
    if change == "rename":
        jacks.rename(own / "jumps.bvh")
    elif change == "exchange":
        jacks.rename(own / "aside")
        walk.rename(jacks)
        (own / "aside").rename(walk)
    elif change in ("remove and restore", "rename back"):
        path, home = jacks, tmp_path if change == "remove and restore" else own
        for step in (home / "b.bvh", own / "c.bvh", jacks, own / "d.bvh"):
            path = path.rename(step)
            build((), folder)
    else:
        whole = jacks.read_bytes()
        kineme.write(kineme.read(jacks)[:500], jacks)
        build((), folder)
        jacks.write_bytes(whole)
    build((), folder)
    assert [each._replace(example="") for each in Library(folder).clusters()] == before
    names = {*Library(folder).table("recordings").column("recording").to_pylist()}
    assert all(names.issuperset(split.recordings) for split in read_edits(folder).splits)


def pieces_in(folder: Path) -> list[str]:
    """Those that are whole: what a killed worker was writing has another name."""
    return [name for name in contents(folder) if re.fullmatch(r"pieces/\w+\.parquet", name)]


def test_a_build_that_was_killed_goes_on_to_the_same_bytes(
    built: Path, takes: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "library"
    command = [sys.executable, "-m", "kineme", "library", "build", takes, "--into", folder]
    process = subprocess.Popen([*map(str, command), "--jobs", "2"], start_new_session=True)
    while process.poll() is None and not pieces_in(folder):
        time.sleep(0.01)
    os.kill(process.pid, signal.SIGKILL)  # its workers end by themselves
    process.wait()
    with pytest.raises(ReadError, match="is not a library"):
        Library(folder)
    made = len(pieces_in(folder))
    deadline = time.monotonic() + 60
    while made < 3:  # the worker may be at its next piece: it ends before or after it
        try:
            os.killpg(process.pid, 0)
        except ProcessLookupError:
            break
        assert time.monotonic() < deadline, "workers outlive the build"
        time.sleep(0.05)
    made = len(pieces_in(folder))
    assert build(takes, folder).new == 3 - made
    assert contents(folder) == contents(built)


DEADLY = """
import os
from kineme.formats import Format

def read(content, options):
    os._exit(1)

FORMAT = Format("DEADLY", (".deadly",), lambda head: False, read)
"""


def test_a_worker_that_dies_costs_its_recording_only(takes: Path, tmp_path: Path) -> None:
    site = tmp_path / "site"
    install_package(site, "deadly", "[kineme.formats]\ndeadly = deadly:FORMAT\n")
    (site / "deadly.py").write_text(DEADLY)
    own = copy_takes(takes, tmp_path, a="wrist.csv", c="wrist.csv", d="wrist.csv")
    for number, path in enumerate(own.iterdir()):
        with path.open("a") as file:
            file.write("\n" * number)
    (own / "b.deadly").write_text("b")
    ours = Path(kineme.__file__).parents[1]
    done = subprocess.run(
        [sys.executable, "-m", "kineme", "library", "build", str(own), "--into",
         str(tmp_path / "library"), "--jobs", "2"],
        capture_output=True, text=True, check=False,
        env={**os.environ, "PYTHONPATH": f"{site}{os.pathsep}{ours}"},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "3 recordings" in done.stdout
    assert "b.deadly: the process that read it died" in done.stderr


def test_a_full_disk_ends_the_build_and_leaves_what_was_there(
    folder: Path, takes: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = contents(folder)

    def full(*_: object) -> None:
        raise WriteError(folder, "cannot be written: No space left on device")

    monkeypatch.setattr(gathering, "write_analysis", full)
    with pytest.raises(WriteError, match="No space left"):
        build((), folder, segment_options=SegmentOptions(constants={"min_action": 3.0}))
    assert contents(folder) == before
    assert len(Library(folder)) == 3


def test_one_build_at_a_time(folder: Path) -> None:
    from kineme.library.storage.layout import lock_for_writing

    with lock_for_writing(folder, "build"), pytest.raises(WriteError, match="another process"):
        build((), folder)


def test_copies_are_worked_on_once_and_each_is_named(takes: Path, tmp_path: Path) -> None:
    own = copy_takes(takes, tmp_path, **dict.fromkeys("abc", "wrist.csv"))
    for name in "abc":
        shutil.copy(takes / "broken.bvh", own / f"{name}.bvh")
    made = build(own, tmp_path / "library", jobs=1)
    assert made.new == 1
    assert all(f"{path.name}: " in said for path, said in made.failed.items())
    assert len(made.failed) == 3
    assert Library(tmp_path / "library").recordings["recording"] == ["a.csv", "b.csv", "c.csv"]
