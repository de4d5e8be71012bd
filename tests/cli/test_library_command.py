"""``kineme library`` as people type it."""

from __future__ import annotations

import csv
import json
import shutil
import sys
import time
from pathlib import Path

import pytest

from kineme.datasets import bundled_recording


@pytest.fixture
def home(tmp_path: Path, kineme) -> Path:
    (tmp_path / "takes").mkdir()
    shutil.copy(bundled_recording(), tmp_path / "takes" / "take.bvh")
    (tmp_path / "takes" / "broken.bvh").write_text("HIERARCHY\nROOT hips\nROOT\n")
    built = kineme("library", "build", "takes", "--into", "lib", "--jobs", 1)
    assert built.stdout == "1 recording in lib, 1 new, 1 failed\n"
    assert built.stderr.startswith("skipped: ")
    assert built.stderr.count("broken.bvh") == 1
    return tmp_path


def test_from_a_folder_to_all_the_walks_in_it(home: Path, kineme) -> None:
    example = ("--like", "takes/take.bvh", "--start", 0.5, "--stop", 1.6)
    found = kineme("library", "search", "lib", *example, "--top", 5, "--json")
    hits = [json.loads(line) for line in found.stdout.splitlines()]
    assert len(hits) == 5
    assert list(hits[0]) == ["recording", "start_s", "stop_s", "distance", "cluster", "label"]
    (cluster,) = {hit["cluster"] for hit in hits}
    kineme("library", "name", "lib", cluster, "walk")
    named = kineme("library", "search", "lib", "--cluster", "walk", "--export", "clips")
    assert "walk" in named.stdout
    assert "clips in clips" in named.stdout
    assert (home / "clips" / "manifest.csv").is_file()
    asked = kineme(
        "library", "query", "lib", "--json",
        "select count(*) n from segments where label = 'walk' and level = 'primitive'",
    )  # fmt: skip
    assert json.loads(asked.stdout)["n"] >= 5
    kineme("library", "export", "lib", "--output", "table.csv")
    with (home / "table.csv").open(newline="") as file:
        assert {row["recording"] for row in csv.DictReader(file)} == {"take.bvh"}
    shown = kineme("library", "show", "lib")
    assert "1 recording, 0.01 h" in shown.stdout
    assert "walk" in shown.stdout
    assert "failed: " in shown.stdout
    facts = json.loads(kineme("library", "show", "lib", "--json").stdout)
    assert "walk" in [each["label"] for each in facts["clusters"]]


def test_clusters_are_merged_and_split(home: Path, kineme) -> None:
    shutil.copy(home / "takes" / "take.bvh", home / "takes" / "again.bvh")
    kineme("library", "build", "--into", "lib", "--jobs", 1)
    kineme("library", "merge", "lib", 0, 1)
    facts = json.loads(kineme("library", "show", "lib", "--json").stdout)
    assert 1 not in [each["cluster"] for each in facts["clusters"]]
    new = int(kineme("library", "split", "lib", 0, "again.bvh").stdout)
    facts = json.loads(kineme("library", "show", "lib", "--json").stdout)
    assert new in [each["cluster"] for each in facts["clusters"]]


SENSELESS = [
    (("build", "takes/none.bvh", "--into", "lib"), 1, "no such file"),
    (("build", "takes", "--into", "takes"), 1, "is not a library"),
    (("build", "takes", "--into", "lib", "--remove", "elsewhere"), 1, "is not a source"),
    (("build", "takes", "--into", "lib", "--preset", "none"), 2, "no preset"),
    (("search", "takes", "--like", "takes/take.bvh"), 1, "is not a library"),
    (("search", "lib", "--like", "nobody.bvh"), 1, "there is no file or recording"),
    (("search", "lib", "--like", "a.bvh", "--like", "b.bvh", "--start", "1"), 2, "single"),
    (("search", "lib", "--like", "take.bvh", "--threshold", "-1"), 1, "threshold"),
    (("query", "lib", "select nothing"), 1, "nothing"),
    (("merge", "lib", "0", "0"), 1, "'0' is the same cluster"),
    (("name", "lib", "99", "walk"), 1, "no cluster is called 99"),
]  # fmt: skip


def test_what_makes_no_sense_is_one_sentence(home: Path, kineme) -> None:
    for arguments, code, said in SENSELESS:
        done = kineme("library", *arguments, code=code)
        assert said in " ".join(done.stderr.replace("│", " ").split()), arguments
        assert "Traceback" not in done.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="needs signals to groups of processes")
def test_control_c_ends_a_build_quietly(interrupted, tmp_path: Path) -> None:
    text = bundled_recording().read_text(encoding="utf-8")
    for number in range(40):  # recordings for many seconds, each with a content of its own
        (tmp_path / f"{number}.bvh").write_text(text + "\n" * number, encoding="utf-8")

    def at_work(_: int) -> bool:
        begun = (tmp_path / "lib" / ".lock").exists()
        time.sleep(0.2 * begun)  # its processes are being started
        return begun

    assert interrupted(at_work, "library", "build", ".", "--into", "lib") == (130, "", "")


@pytest.mark.parametrize(
    ("sources", "reason"),
    [
        ([], "lib: nothing to build from: name recordings or folders"),
        (["missing"], "missing: there is no such file or folder"),
    ],
)
def test_a_build_from_nothing_leaves_nothing(
    tmp_path: Path, kineme, sources: list[str], reason: str
) -> None:
    built = kineme("library", "build", *sources, "--into", "lib", code=1)
    assert built.stderr == f"error: {reason}\n"
    assert not (tmp_path / "lib").exists()
