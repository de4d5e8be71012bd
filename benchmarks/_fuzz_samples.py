"""Small sound files of every kind that the package reads, and what reads each of them.

A file lies in a folder that is called after its kind; what lies beside it stays sound while
it is damaged.
"""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import _fbx
import kineme
from kineme import formats, labels
from kineme._util.files import CORRECTED
from kineme.datasets import bundled_recording, bundled_truth
from kineme.errors import MissingDependencyError
from kineme.evaluation.inputs import is_annotation_file, read_trials
from kineme.formats.listing import scan_folder
from kineme.labels.collections import find_labels
from kineme.library import Library, build
from kineme.library.storage.layout import STATES
from kineme.recordings import Motion
from kineme.segments import editing
from kineme.segments.editing.annotating import find_marked
from kineme.segments.segmentation import Segmentation
from kineme.studio.storage.journal import Journal
from kineme.studio.storage.listed_recording import ListedRecording
from kineme.studio.storage.sidecars import (
    list_recordings,
    list_sidecar_problems,
    make_video_message,
    read_saved_options,
    read_shared_labels,
    write_reading,
    write_shared_labels,
    write_video_offset,
)
from kineme.studio.storage.tables import find_saved_table
from kineme.synthesis import motion_graph
from kineme.synthesis.graph import load_sources, read_graph, write_graph

LARGEST = 100_000
"""Bytes of a sample from KINEME_DATA; of longer texts the beginning is taken."""

TEXTS = (".bvh", ".amc", ".trc", ".mot", ".txt")

TAKE, CUT = Path("studio/walk.bvh"), Path("graphs/cut.bvh")
"""What side files and a graph are of; damage to them is that to a recording."""

SIDE_FILES = ("labels.json", "walk.bvh.video.json", "walk.bvh.reading.json")

Door = Callable[[Path], object]


@dataclass(frozen=True)
class Case:
    """A file that is damaged, and what reads it, given the folder of all kinds."""

    path: Path
    sound: bytes
    doors: tuple[Door, ...]


def write_samples(root: Path) -> list[Case]:
    """Small sound files in folders of their kinds; every one of them as a case."""
    motion = formats.read_motion(bundled_recording())
    truth = kineme.read_segments(bundled_truth())
    for write in (_recordings, _labels, _pairs, _tables, _others, _benchmark, _library, _studio):
        write(root, motion, truth)
    paths = sorted(path.relative_to(root) for path in root.rglob("*") if path.is_file())
    read = [path for path in paths if path not in (TAKE, CUT)]
    cases = [Case(path, (root / path).read_bytes(), doors_of(path)) for path in read]
    return [case for case in cases if case.sound]  # locks are empty


def doors_of(path: Path) -> tuple[Door, ...]:
    """What reads a file, by the folder that it lies in."""
    table = "cuts.csv" if path.name.startswith("cuts") else "pair_events.tsv"
    return {
        "recordings": (
            lambda root: kineme.read(root / path),
            lambda root: kineme.read(root / path, fps=60),
            lambda root: kineme.read(root / path, columns=[]),
            lambda root: formats.sketch(root / path, formats.ReadOptions(), 5),
            lambda root: scan_folder((root / path).parent),
        ),
        "labels": (
            lambda root: kineme.read_segments(root / path, format=path.stem, fps=60),
            lambda root: kineme.read_segments(root / path),
            lambda root: _write_on(root, path),
        ),
        "tables": (lambda root: _labels_of_many(root / path),),
        "benchmark": (
            lambda root: is_annotation_file(root / path),
            lambda root: read_trials(root / path),
        ),
        "pairs": (lambda root: kineme.read_segments(root / "pairs" / table),),
        "knowledge": (lambda root: kineme.KnowledgeBase.load(root / path),),
        "graphs": (lambda root: load_sources(read_graph(root / path)),),
        "library": (_ask_library, _search_library, _export_library)
        + ((_build_library,) if path.name == STATES else ()),
        "studio": (_read_beside,) if path.name in SIDE_FILES else (_open_studio,),
    }[path.parts[0]]


def _recordings(root: Path, motion: Motion, _: Segmentation) -> None:
    folder = _made(root / "recordings")
    for known in formats.supported_formats():
        for suffix in known.suffixes if known.write else ():
            with suppress(MissingDependencyError):
                formats.write(motion[:40], folder / f"motion{suffix}")
    rng = np.random.default_rng(0)
    signals = kineme.Signals(rng.normal(size=(80, 3)), 50, ["a", "b", "c"])
    for suffix in (".csv", ".parquet"):
        formats.write(signals, folder / f"signals{suffix}")
    for name, scene in (("packed", _fbx.walker().binary()), ("text", _fbx.walker().text())):
        (folder / f"{name}.fbx").write_bytes(scene)
    (folder / "wide.fbx").write_bytes(_fbx.walker().binary(7700, packed=False))
    np.save(folder / "array.npy", np.asarray(motion.positions[:20]))
    data = Path(os.environ.get("KINEME_DATA", "/nowhere"))
    for path in sorted([*data.glob("*formats/*"), *data.glob("timeseries/*")]):
        if not path.is_file():
            continue
        if path.suffix in TEXTS:
            start = path.read_bytes()[:LARGEST]
            (folder / path.name).write_bytes(start[: start.rfind(b"\n") + 1])
        elif path.stat().st_size < 2 * LARGEST:
            (folder / path.name).write_bytes(path.read_bytes())


def _labels(root: Path, _: Motion, truth: Segmentation) -> None:
    folder = _made(root / "labels")
    for known in labels.label_formats().values():
        if known.write and not known.folder:
            path = folder / f"{known.name}{known.written_suffix}"
            labels.write_segments(truth, path, format=known.name)


def _pairs(root: Path, _: Motion, truth: Segmentation) -> None:
    folder = _made(root / "pairs")
    kineme.write_segments(truth, folder / "cuts.csv")
    kineme.write_segments(truth, folder / "pair_events.tsv")


def _tables(root: Path, _: Motion, __: Segmentation) -> None:
    rows = ["recording,start_s,stop_s,label", "a.bvh,0,2,walk", "a.bvh,2,3.5,jump", "b,0,1,walk"]
    for name, mark in (("commas.csv", ","), ("tabs.tsv", "\t"), ("semicolons.csv", ";")):
        text = "\n".join(row.replace(",", mark) for row in rows)
        (_made(root / "tables") / name).write_text(text + "\n")


def _benchmark(root: Path, _: Motion, __: Segmentation) -> None:
    folder = _made(root / "benchmark")
    marks = (("walk", 90, 100, 110), ("jump", 190, 200, 210), ("walk", 300, 300, 300))
    names = ("label", "end_earliest", "end_mean", "end_latest")
    trials = {"86_01": [dict(zip(names, row, strict=True)) for row in marks]}
    (folder / "annotations.json").write_text(json.dumps({"trials": trials}))
    (folder / "mocap.txt").write_text(
        "\n".join(["86_01", *(" ".join(map(str, row)) for row in marks)])
    )


def _others(root: Path, motion: Motion, truth: Segmentation) -> None:
    kineme.KnowledgeBase.from_recording(motion, truth).save(_made(root / "knowledge") / "base.npz")
    graph = kineme.MotionGraph((), (), (), 60.0, 0.1, 0.3)
    write_graph(graph, _made(root / "graphs") / "empty.json")
    cut = motion[:900]
    formats.write(cut, root / CUT)
    cut = formats.read_motion(root / CUT)
    graph = motion_graph([cut], [kineme.segment(cut)])
    write_graph(graph, root / "graphs" / "graph.json")


def _library(root: Path, motion: Motion, _: Segmentation) -> None:
    takes = _made(root.parent / "takes")
    for name, part in (("walk.bvh", motion[:300]), ("jacks.bvh", motion[2400:2640])):
        formats.write(part, takes / name)
    folder = root / "library"
    build(takes, folder)
    Library(folder).name(0, "walk").merge(0, 1).split(0, ["walk.bvh"])


def _studio(root: Path, motion: Motion, truth: Segmentation) -> None:
    folder = _made(root / "studio")
    formats.write(motion[:60], root / TAKE)
    said = formats.ReadOptions(fps=30.0, unit="cm", up="y")
    write_reading(root / TAKE, said, ["Anna", "Bob"])
    write_video_offset(root / TAKE, 1.5)
    write_shared_labels(folder, ["walk", "jump"])
    saved = folder / f"walk{CORRECTED}"
    journal = Journal(saved, truth)

    for fps in (59.0, 60.0):
        table = Segmentation.from_columns(truth.table.columns(), n_frames=truth.n_frames, fps=fps)
        journal.write(
            journal.make_change(table, None, replaced=True), saved.write_bytes, revision=1
        )


def _write_on(root: Path, path: Path) -> object:
    """What was read, in formats that tell more than the table: where it came from, and notes."""
    found = kineme.read_segments(root / path, format=path.stem, fps=60)
    folder = _made(root.parent / "written")
    for name in ("boris", "babel", "clips", "csv"):
        known = labels.label_formats()[name]
        kineme.write_segments(found, folder / f"{name}{known.written_suffix}", format=name)
    return find_marked(found, "checked"), editing.cluster_names(found), editing.comments(found)


def _labels_of_many(path: Path) -> object:
    sources = find_labels([Path("a.bvh"), Path("b.bvh")], path)
    return [source.of(n_frames=240, fps=60.0) for source in sources.values()]


def _build_library(root: Path) -> object:
    folder = root.parent / "rebuilt"
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(root / "library", folder)
    return build((), folder)


def _read_beside(root: Path) -> object:
    take = root / TAKE
    said = list_sidecar_problems(take)
    found = kineme.read(take, **vars(read_saved_options(take))), list_recordings([take])
    return found, make_video_message(take), read_shared_labels(take.parent), said


def _ask_library(root: Path) -> object:
    library = Library(root / "library")
    tables = [
        library.table(name) for name in ("segments", "recordings", "local_clusters", "embeddings")
    ]
    options = library.read_options, library.segment_options
    return options, library.failed, repr(library), library.clusters(), tables


def _search_library(root: Path) -> object:
    library = Library(root / "library")
    number = next((cluster.cluster for cluster in library.clusters()), 0)
    return library.unsure(), library.search(cluster=number, top=5)


def _export_library(root: Path) -> object:
    library = Library(root / "library")
    library.export(root.parent / "exported.csv")
    return library.query("select count(*) from segments join recordings using (recording)")


def _open_studio(root: Path) -> object:
    folder = root / "studio"
    file, table, notes = find_saved_table(
        ListedRecording(folder / "walk.bvh"), lambda _: True, set()
    )
    if table is None:
        return notes
    journal = Journal(file.path, table)
    kept = [journal.table(number) for number in journal.versions()]
    before = journal.make_undo() if journal.can_undo else None
    return kept, before, journal.knows("x")


def _made(folder: Path) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    return folder
