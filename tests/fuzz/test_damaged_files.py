"""Damaged files are read, or refused in one sentence: those beside recordings, and real recordings.

`--hypothesis-profile=thorough` damages ten times as many files. Recordings and labels that kineme
writes are damaged in `formats/test_damage.py` and `labels/test_bad_labels.py`.
"""

from __future__ import annotations

import json
import shutil
import warnings
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from test_hostile_folders import alarm

import kineme
from _damage import damage_bytes
from _restructure import change_structure
from kineme import formats
from kineme._util.files import CORRECTED
from kineme.datasets import bundled_recording, bundled_truth
from kineme.errors import KinemeError, KinemeWarning
from kineme.formats.listing import scan_folder
from kineme.labels.collections import find_labels
from kineme.library import Library, build
from kineme.segments.segmentation import Segmentation
from kineme.studio.storage.sidecars import (
    ListedRecording,
    list_recordings,
    list_sidecar_problems,
    make_video_message,
    read_saved_options,
    read_shared_labels,
    write_reading,
    write_shared_labels,
    write_video_offset,
)
from kineme.studio.storage.tables import Journal, find_saved_table
from kineme.synthesis import motion_graph
from kineme.synthesis.graph import load_sources, read_graph, write_graph
from kineme_reproduction.annotations import read_trials

LARGEST = 100_000
"""Maximum bytes of a real recording; longer texts are cut."""
TEXTS = (".bvh", ".amc", ".trc", ".mot", ".txt")
HANGS_AFTER_S = 60
KEPT_INTACT = ("walk.bvh", "cut.bvh")
"""Recordings of side files and graphs."""


def copy_recordings(data: Path, folder: Path) -> None:
    for path in sorted([*data.glob("*formats/*"), *data.glob("timeseries/*")]):
        if path.suffix in TEXTS:
            start = path.read_bytes()[:LARGEST]
            (folder / path.name).write_bytes(start[: start.rfind(b"\n") + 1])
        elif path.is_file() and path.stat().st_size < 2 * LARGEST:
            shutil.copy(path, folder)


def write_labels(folder: Path) -> None:
    rows = ["recording,start_s,stop_s,label", "a.bvh,0,2,walk", "a.bvh,2,3.5,jump", "b,0,1,walk"]
    for name, mark in (("commas.csv", ","), ("tabs.tsv", "\t"), ("semicolons.csv", ";")):
        (folder / name).write_text("\n".join(row.replace(",", mark) for row in [*rows, ""]))


def write_annotations(folder: Path) -> None:
    marks = (("walk", 90, 100, 110), ("jump", 190, 200, 210), ("walk", 300, 300, 300))
    names = ("label", "end_earliest", "end_mean", "end_latest")
    trials = {"86_01": [dict(zip(names, row)) for row in marks]}
    (folder / "annotations.json").write_text(json.dumps({"trials": trials}))
    lines = ["86_01", *(" ".join(map(str, row)) for row in marks)]
    (folder / "mocap.txt").write_text("\n".join(lines))


def write_pairs(folder: Path) -> None:
    """Write tables of segments that have a second file beside them."""
    truth = kineme.read_segments(bundled_truth())
    kineme.write_segments(truth, folder / "cuts.csv")
    kineme.write_segments(truth, folder / "pair_events.tsv")


def write_knowledge(folder: Path) -> None:
    motion, truth = kineme.read(bundled_recording()), kineme.read_segments(bundled_truth())
    kineme.KnowledgeBase.from_recording(motion, truth).save(folder / "base.npz")


def write_graphs(folder: Path) -> None:
    write_graph(kineme.MotionGraph((), (), (), 60.0, 0.1, 0.3), folder / "empty.json")
    kineme.write(kineme.read(bundled_recording())[:900], folder / "cut.bvh")
    cut = kineme.read(folder / "cut.bvh")
    write_graph(motion_graph([cut], [kineme.segment(cut)]), folder / "graph.json")


def write_library(folder: Path) -> None:
    motion, takes = kineme.read(bundled_recording()), folder.parent / "takes"
    takes.mkdir()
    for name, part in (("walk.bvh", motion[:300]), ("jacks.bvh", motion[2400:2640])):
        kineme.write(part, takes / name)
    build(takes, folder)
    Library(folder).name(0, "walk").merge(0, 1).split(0, ["walk.bvh"])


def write_studio(folder: Path) -> None:
    take = folder / "walk.bvh"
    kineme.write(kineme.read(bundled_recording())[:60], take)
    write_reading(take, formats.ReadOptions(fps=30.0, unit="cm", up="y"), ["Anna", "Bob"])
    write_video_offset(take, 1.5)
    write_shared_labels(folder, ["walk", "jump"])
    truth, saved = kineme.read_segments(bundled_truth()), folder / f"walk{CORRECTED}"
    journal = Journal(saved, truth)
    for fps in (59.0, 60.0):
        table = Segmentation.from_columns(truth.table.columns(), n_frames=truth.n_frames, fps=fps)
        change = journal.make_change(table, None, replaced=True)
        journal.write(change, saved.write_bytes, revision=1, name=f"at {fps:g} Hz")


def read_labels(path: Path) -> None:
    for source in find_labels([Path("a.bvh"), Path("b.bvh")], path).values():
        source.of(n_frames=240, fps=60.0)


def read_pair(path: Path) -> None:
    table = "cuts.csv" if path.name.startswith("cuts") else "pair_events.tsv"
    kineme.read_segments(path.with_name(table))


def find_folder(path: Path, name: str) -> Path:
    return next(folder for folder in path.parents if folder.name == name)


def open_library(path: Path) -> Library:
    return Library(find_folder(path, "library"))


def read_tables(path: Path) -> None:
    library = open_library(path)
    for name in ("segments", "recordings", "local_clusters", "embeddings"):
        library.table(name)
    library.query("select count(*) from segments join recordings using (recording)")


def search_library(path: Path) -> None:
    library = open_library(path)
    library.unsure()
    for cluster in library.clusters()[:1]:  # a damaged table may have none
        library.search(cluster=cluster.cluster, top=5)


def build_library(path: Path) -> None:
    folder = find_folder(path, "library")
    copy = folder.parent / "rebuilt"
    shutil.rmtree(copy, ignore_errors=True)
    build((), shutil.copytree(folder, copy))


def read_side_files(path: Path) -> None:
    take = find_folder(path, "studio") / "walk.bvh"
    list_sidecar_problems(take)
    list_recordings([take])
    make_video_message(take)
    read_shared_labels(take.parent)
    kineme.read(take, **vars(read_saved_options(take)))


def read_journal(path: Path) -> None:
    take = ListedRecording(find_folder(path, "studio") / "walk.bvh")
    file, table, _ = find_saved_table(take, lambda _: True, set(), lambda _: False)
    if table is not None:
        journal = Journal(file.path, table)
        for number in journal.versions():
            journal.table(number)
        if journal.can_undo:
            journal.undo_or_redo(undo=True)


READERS: dict[str, tuple[Callable[[Path], object], ...]] = {
    "recordings": (
        kineme.read,
        lambda path: kineme.read(path, fps=60),
        lambda path: kineme.read(path, columns=[]),
        lambda path: formats.sketch(path, formats.ReadOptions(), 5),
        lambda path: scan_folder(path.parent),
    ),
    "labels": (read_labels,),
    "annotations": (read_trials,),
    "pairs": (read_pair,),
    "knowledge": (kineme.KnowledgeBase.load,),
    "graphs": (lambda path: load_sources(read_graph(path)),),
    "library": (
        read_tables,
        search_library,
        build_library,
        lambda path: open_library(path).export(path.parent / "exported.csv"),
    ),
    "studio": (read_side_files, read_journal),
}
"""Functions that read a file of each kind."""
WRITERS: dict[str, Callable[[Path], None]] = {
    "labels": write_labels,
    "annotations": write_annotations,
    "pairs": write_pairs,
    "knowledge": write_knowledge,
    "graphs": write_graphs,
    "library": write_library,
    "studio": write_studio,
}
"""Functions that write the files of a kind to a folder."""


@pytest.fixture(scope="module", params=READERS)
def kind(request: pytest.FixtureRequest) -> str:
    return request.param


@pytest.fixture(scope="module")
def pick(
    kind: str, tmp_path_factory: pytest.TempPathFactory, request: pytest.FixtureRequest
) -> Callable[[int], tuple[Path, bytes]]:
    """Write intact files of a kind; return a function that returns one of them with its bytes."""
    folder = tmp_path_factory.mktemp("samples") / kind
    folder.mkdir()
    if kind == "recordings":
        copy_recordings(request.getfixturevalue("data_dir"), folder)
    else:
        WRITERS[kind](folder)
    paths = (path for path in sorted(folder.rglob("*")) if path.is_file())
    found = [(path, path.read_bytes()) for path in paths if path.name not in KEPT_INTACT]
    intact = [(path, data) for path, data in found if data]  # locks are empty
    # Hypothesis prints arguments of failures: a function is short, all bytes are not.
    return lambda turn: intact[turn % len(intact)]


@pytest.mark.slow
@given(turn=st.integers(0, 999), seed=st.integers(0, 2**32 - 1), meaning=st.booleans())
def test_damaged_files(
    pick: Callable[[int], tuple[Path, bytes]], kind: str, turn: int, seed: int, meaning: bool
) -> None:
    path, sound = pick(turn)
    path.write_bytes(change_structure(path, sound, seed) if meaning else damage_bytes(sound, seed))
    try:
        for read in READERS[kind]:
            check_survival(read, path)
    finally:
        path.write_bytes(sound)


def check_survival(read: Callable[[Path], object], path: Path) -> None:
    with warnings.catch_warnings(), alarm(HANGS_AFTER_S):
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", KinemeWarning)
        try:
            read(path)
        except KinemeError as error:
            assert "\n" not in str(error)
