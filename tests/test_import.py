"""Importing the package is cheap, and all it promises is there."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import kineme
from kineme.datasets import bundled_truth
from kineme.recordings.operations import cut
from kineme.transfer import transfer_features

HEAVY = {
    "matplotlib", "numba", "numpy", "pandas", "pyarrow", "rich", "scipy", "sklearn", "typer",
}  # fmt: skip


def loaded_by(statement: str) -> set[str]:
    """Top-level modules in a fresh process after a statement."""
    code = f"import sys\n{statement}\nprint(*{{name.split('.')[0] for name in sys.modules}})"
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", code], capture_output=True, text=True, check=True
    )
    return set(done.stdout.split())


def test_listing_names_loads_nothing_heavy() -> None:
    assert not loaded_by("import kineme; assert set(kineme.__all__) <= set(dir(kineme))") & HEAVY


def test_errors_and_the_table_need_no_compiler() -> None:
    names = ("KinemeError", "Segmentation", "read", "Signals", "segment")
    statement = f"import kineme; {', '.join(f'kineme.{name}' for name in names)}"
    assert not loaded_by(statement) & {"numba", "matplotlib", "sklearn"}


@pytest.mark.parametrize("name", kineme.__all__)
def test_every_public_name_is_there(name: str) -> None:
    assert getattr(kineme, name) is not None


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="No kineme attribute segmentt"):
        _ = kineme.segmentt


WRONG = [
    "text", None, -1, float("nan"), [], [[1], [2, 3]], {"a": 1}, object(), np.zeros((2, 2, 2)),
    np.full((5, 3), np.nan),
]  # fmt: skip


def public_doors(folder: Path) -> list[tuple[Callable[..., object], list[Any], dict[str, Any]]]:
    """Public functions and classes, each with arguments that it takes."""
    x = np.random.default_rng(0).normal(size=(60, 3))
    whole = kineme.read(kineme.bundled_recording())
    truth = kineme.read_segments(bundled_truth())
    base = kineme.KnowledgeBase.from_recording(whole, truth)
    motion = cut(whole, 0, 90)
    found, graph = kineme.segment(motion), kineme.neighbor_graph(x, radius=1.0)
    fps, columns = motion.fps, found.table.columns()
    table, page, picture = folder / "a.csv", folder / "a.html", folder / "a.png"
    kineme.write_segments(found, table)
    np.savetxt(folder / "b.csv", x, delimiter=",", header="u,v,w", comments="")
    return [
        (kineme.Skeleton, [["a", "b"], [-1, 0], np.zeros((2, 3))], {"end_sites": [1]}),
        (kineme.Motion, [motion.skeleton, motion.positions, 30.0], {"rotations": None, "gaps": ()}),
        (kineme.Signals, [x, 30.0], {"names": ("u", "v", "w"), "gaps": ()}),
        (kineme.Segmentation, [found.table, 90, fps], {"provenance": {}, "timings": {}}),
        (kineme.Segmentation.from_columns, [columns], {"n_frames": 90, "fps": fps}),
        (kineme.read, [kineme.bundled_recording()], dict.fromkeys(("fps", "unit", "up"))),
        (kineme.write, [motion, folder / "a.bvh"], {}),
        (kineme.read_segments, [table], dict.fromkeys(("format", "fps", "n_frames"))),
        (kineme.write_segments, [found, table], dict.fromkeys(("format", "level"))),
        (kineme.read, [folder / "b.csv"], {"fps": 30.0, "columns": None}),
        (kineme.segment, [motion], {"preset": "voegele2014", "effectors": None, "radius": 0.6}),
        (kineme.segment, [motion], {"averaging": 2.0, "offsets": (0.0,), "max_clusters": 4}),
        (kineme.segment_and_found, [motion], {"preset": "krueger2017", "effectors": None}),
        (kineme.segment, [kineme.Signals(x, 30)], {"preset": "kineme", "smoothing": 0.1}),
        (kineme.analyze, [x, "krueger2017"], {}),
        (kineme.cycles, [whole, truth], {"channels": None, "anchor": None, "common": False}),
        (kineme.end_effectors, [motion], {"names": None}),
        (kineme.pose_features, [motion], {"effectors": None}),
        (kineme.mirror, [motion], {}),
        (kineme.mirror_features, [np.zeros((4, 15))], {}),
        (kineme.stack, [x, (0, 1)], {}),
        (kineme.bundle, [x], {"neighbors": 5, "variance": 0.9}),
        (kineme.resample, [motion, 30.0], {}),
        (kineme.neighbor_graph, [x], {"others": None, "radius": 1.0, "k": None, "max_lag": None}),
        (kineme.warping_paths, [graph, (0, 30), (30, 60)], {"steps": [(1, 1)], "zero_cost": 0.1}),
        (kineme.warping_paths, [graph, (0, 30), (30, 60)], {"skip_penalty": 0, "max_slope": 2}),
        (kineme.plot_segmentation, [found, motion, picture], {}),
        (kineme.write_report, [motion, found, page], {"name": None, "effectors": None}),
        (kineme.motion_graph, [[motion]], {"segmentations": None, "threshold": 0.1}),
        (kineme.synthesize, [kineme.motion_graph([motion]), [motion], [0]], {"start": None}),
        (kineme.KnowledgeBase.from_recording, [whole, truth], {}),
        (kineme.transfer_labels, [found, transfer_features(motion), base], {"threshold": 0.1}),
    ]


def test_public_doors_refuse_in_their_own_words(tmp_path: Path) -> None:
    foreign = []
    for door, given, options in public_doors(tmp_path):
        door(*given, **options)
        for slot in (*range(len(given)), *options):
            for wrong in WRONG:
                values = [wrong if slot == i else value for i, value in enumerate(given)]
                named = {k: wrong if slot == k else value for k, value in options.items()}
                try:
                    door(*values, **named)
                except (kineme.KinemeError, kineme.KinemeWarning):
                    pass
                except Exception as error:  # noqa: BLE001 (what else there is, is the question)
                    foreign.append(f"{door.__qualname__}, {slot}: {wrong!r:.30}: {error!r:.80}")
    assert not foreign


@pytest.mark.parametrize("name", ["formats", "interop.adapters", "interop.movement_dataset"])
def test_packages_of_the_docs_are_attributes(name: str) -> None:
    loaded = f"import kineme; from operator import attrgetter; attrgetter({name!r})(kineme)"
    assert "kineme" in loaded_by(loaded)


@pytest.mark.parametrize("first", ["kineme.cycles", "from kineme.cycles import Cycles"])
def test_cycles_is_one_thing_in_any_order(first: str) -> None:
    check = "kineme.cycles.foot_events and callable(kineme.cycles)"
    same = "pickle.loads(pickle.dumps(kineme.cycles)) is kineme.cycles"
    loaded_by(f"import kineme, pickle; {first}; assert {check} and {same}")
