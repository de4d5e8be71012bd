"""``kineme graph`` and ``kineme synthesize``: recordings to a new BVH, and what is refused."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

import kineme as package
from kineme.datasets import bundled_recording
from kineme.datasets.bundled import bundled_truth


@pytest.fixture(scope="module")
def made(kineme_in, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a graph of labelled primitives and its recording."""
    folder = tmp_path_factory.mktemp("made")
    shutil.copy(bundled_recording(), folder / "take.bvh")
    shutil.copy(bundled_truth(), folder / "take.json")
    done = kineme_in(folder, "graph", "take.bvh", "-o", "graph.json", "--segments", "{name}.json")
    assert "jump: 4 primitives, then walk, squat, arm circles, jump, run, kick" in done.stdout
    return folder


@pytest.fixture
def graph(made: Path, tmp_path: Path) -> Path:
    """The graph beside its recording, copies of one's own."""
    return shutil.copytree(made, tmp_path, dirs_exist_ok=True) / "graph.json"


def test_from_a_recording_to_a_new_one(kineme, graph: Path, tmp_path: Path) -> None:
    done = kineme("synthesize", "graph.json", "--actions", "walk*6,jump*4,run*7", "-o", "new.bvh")
    assert done.stdout[-8:] == "new.bvh\n"
    motion = package.read(tmp_path / "new.bvh", unit="cm")
    assert (
        motion.skeleton.names == package.read(graph.parent / "take.bvh", unit="cm").skeleton.names
    )
    cuts = json.loads(kineme("segment", "new.bvh", "--json").stdout)["segments"]
    runs = [row["activity"] for row in cuts if (row["level"], row["kind"]) == ("activity",) * 2]
    rows = [
        row["activity"] for row in cuts if (row["level"], row["kind"]) == ("primitive", "primitive")
    ]
    assert [rows.count(run) for run in runs] == [6, 4, 7]


def test_a_random_walk_and_a_picture(kineme, graph: Path, tmp_path: Path) -> None:
    kineme("graph", "take.bvh", "-o", "own.json", "--plot", "own.png", "--unit", "cm", errors="")
    assert (tmp_path / "own.png").stat().st_size > 10_000
    for name in ("a.bvh", "b.bvh"):
        done = kineme(
            "synthesize", "own.json", "--duration", "5", "--seed", "3", "-o", name, errors=""
        )
    assert (tmp_path / "a.bvh").read_bytes() == (tmp_path / "b.bvh").read_bytes()
    assert package.read(tmp_path / "a.bvh", unit="cm").duration >= 5
    kineme("graph", "take.bvh", "-o", "few.json", "--threshold", "0.05", "--unit", "cm")
    done = kineme("synthesize", "few.json", "--actions", "4,0", "-o", "c.bvh", code=1)
    assert "put another action between" in done.stderr
    assert "'0' is reached from" in done.stderr


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--actions", "wlak"], "no node is called 'wlak'; there are walk (9), squat (4)"),
        (["--actions", "walk*x"], "'walk*x' is not an action: give names with counts"),
        (["--duration", "-1"], "the duration must be above 0 and below 1e6 s, not -1"),
        ([], "give --actions, --path or both, or --duration"),
        (["--actions", "walk", "--duration", "3"], "--path or both, or --duration"),
        (["--path", "0,0"], "'0,0' is not a line on the floor: give two or more points x,z"),
        (["--path", "0,0;0,0.1"], "the line is 0.1 m long: it must have a length"),
        (["--path", "0,0;3,0", "--actions", "walk*3"], "with --path the line sets the length"),
        (["--path", "0,0;9,0", "--actions", "squat"], "m off the line near 8.7,0.0: give a line"),
    ],
)
def test_what_cannot_be_played_is_one_clear_error(
    kineme, graph: Path, tmp_path: Path, arguments: list[str], message: str
) -> None:
    done = kineme("synthesize", "graph.json", *arguments, "-o", "new.bvh", code=None)
    assert done.returncode in (1, 2)
    assert message in " ".join(done.stderr.replace("│", " ").split())
    assert not (tmp_path / "new.bvh").exists()


def test_graphs_that_cannot_be_used_are_one_clear_error(
    kineme, graph: Path, tmp_path: Path
) -> None:
    whole = json.loads(graph.read_text())

    def refused(text: str) -> str:
        (tmp_path / "bad.json").write_text(text)
        done = kineme("synthesize", "bad.json", "--actions", "walk", "-o", "new.bvh", code=1)
        assert len(done.stderr.splitlines()) == 1
        assert "bad.json" in done.stderr
        return done.stderr

    assert "not valid JSON or is truncated" in refused(graph.read_text()[:-50])
    assert "make one with kineme graph" in refused("[1, 2]")
    assert "reads 'kineme.motion-graph/1'" in refused('{"schema": "kineme.motion-graph/9"}')
    assert "damaged (no 'nodes')" in refused(json.dumps({**whole, "nodes": None}).replace(
        '"nodes": null, ', ""))  # fmt: skip
    for table, name, value in (
        ("edges", "head", 400),
        ("edges", "leave", -3),
        ("edges", "distance", "far"),
        ("nodes", "stop", 10**9),
        ("nodes", "source", 1),
        ("sources", "n_frames", 12.5),
    ):
        rows = [{**whole[table][0], name: value}, *whole[table][1:]]
        assert "is damaged (" in refused(json.dumps({**whole, table: rows}))


def test_sources_must_be_there_and_the_same(kineme, graph: Path, tmp_path: Path) -> None:
    take = tmp_path / "take.bvh"
    take.write_text(take.read_text() + "\n")
    done = kineme("synthesize", "graph.json", "--actions", "walk", "-o", "new.bvh", code=1)
    assert "take.bvh: has changed since the graph was built" in done.stderr
    take.unlink()
    done = kineme("synthesize", "graph.json", "--actions", "walk", "-o", "new.bvh", code=1)
    assert "take.bvh: is missing" in done.stderr
