"""Write small intact files of every kind that the package reads, with functions that read them.

Each kind of file has a folder. While one file is damaged, the others stay intact.
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

LARGEST = 100_000
"""Maximum bytes of a sample from KINEME_DATA; longer texts are cut."""

TEXTS = (".bvh", ".amc", ".trc", ".mot", ".txt")

TAKE, CUT = Path("studio/walk.bvh"), Path("graphs/cut.bvh")
"""Recordings of the side files and of the graph; not damaged, as other recordings are."""

SIDE_FILES = ("labels.json", "walk.bvh.video.json", "walk.bvh.reading.json")

Reader = Callable[[Path], object]


@dataclass(frozen=True)
class Case:
    """A file to damage, and functions that read it, given the root folder."""

    path: Path
    sound: bytes
    readers: tuple[Reader, ...]


def write_samples(root: Path) -> list[Case]:
    """Write small intact files and return each as a case."""
    motion = formats.read_motion(bundled_recording())
    truth = kineme.read_segments(bundled_truth())
    for write in (
        _write_recordings,
        _write_labels,
        _write_pairs,
        _write_tables,
        _write_others,
        _write_benchmark,
        _write_library,
        _write_studio,
    ):
        write(root, motion, truth)
    paths = sorted(path.relative_to(root) for path in root.rglob("*") if path.is_file())
    read = [path for path in paths if path not in (TAKE, CUT)]
    cases = [Case(path, (root / path).read_bytes(), list_readers(path)) for path in read]
    return [case for case in cases if case.sound]  # lock files are empty


def list_readers(path: Path) -> tuple[Reader, ...]:
    """Return the functions that read a file, by its folder."""
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
            lambda root: _convert_labels(root, path),
        ),
        "tables": (lambda root: _read_collection(root / path),),
        "benchmark": (
            lambda root: is_annotation_file(root / path),
            lambda root: read_trials(root / path),
        ),
        "pairs": (lambda root: kineme.read_segments(root / "pairs" / table),),
        "knowledge": (lambda root: kineme.KnowledgeBase.load(root / path),),
        "graphs": (lambda root: load_sources(read_graph(root / path)),),
        "library": (_read_library, _search_library, _export_library)
        + ((_build_library,) if path.name == STATES else ()),
        "studio": (_read_side_files,) if path.name in SIDE_FILES else (_open_studio,),
    }[path.parts[0]]


def _write_recordings(root: Path, motion: Motion, _: Segmentation) -> None:
    folder = _make_folder(root / "recordings")
    for known in formats.supported_formats():
        for suffix in known.suffixes if known.write else ():
            with suppress(MissingDependencyError):
                formats.write(motion[:40], folder / f"motion{suffix}")
    rng = np.random.default_rng(0)
    signals = kineme.Signals(rng.normal(size=(80, 3)), 50, ["a", "b", "c"])
    for suffix in (".csv", ".parquet"):
        formats.write(signals, folder / f"signals{suffix}")
    for name, scene in (
        ("packed", _fbx.make_walker().binary()),
        ("text", _fbx.make_walker().text()),
    ):
        (folder / f"{name}.fbx").write_bytes(scene)
    (folder / "wide.fbx").write_bytes(_fbx.make_walker().binary(7700, packed=False))
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


def _write_labels(root: Path, _: Motion, truth: Segmentation) -> None:
    folder = _make_folder(root / "labels")
    for known in labels.label_formats().values():
        if known.write and not known.folder:
            path = folder / f"{known.name}{known.written_suffix}"
            labels.write_segments(truth, path, format=known.name)


def _write_pairs(root: Path, _: Motion, truth: Segmentation) -> None:
    folder = _make_folder(root / "pairs")
    kineme.write_segments(truth, folder / "cuts.csv")
    kineme.write_segments(truth, folder / "pair_events.tsv")


def _write_tables(root: Path, _: Motion, __: Segmentation) -> None:
    rows = ["recording,start_s,stop_s,label", "a.bvh,0,2,walk", "a.bvh,2,3.5,jump", "b,0,1,walk"]
    for name, mark in (("commas.csv", ","), ("tabs.tsv", "\t"), ("semicolons.csv", ";")):
        text = "\n".join(row.replace(",", mark) for row in rows)
        (_make_folder(root / "tables") / name).write_text(text + "\n")


def _write_benchmark(root: Path, _: Motion, __: Segmentation) -> None:
    folder = _make_folder(root / "benchmark")
    marks = (("walk", 90, 100, 110), ("jump", 190, 200, 210), ("walk", 300, 300, 300))
    names = ("label", "end_earliest", "end_mean", "end_latest")
    trials = {"86_01": [dict(zip(names, row, strict=True)) for row in marks]}
    (folder / "annotations.json").write_text(json.dumps({"trials": trials}))
    (folder / "mocap.txt").write_text(
        "\n".join(["86_01", *(" ".join(map(str, row)) for row in marks)])
    )


def _write_others(root: Path, motion: Motion, truth: Segmentation) -> None:
    kineme.KnowledgeBase.from_recording(motion, truth).save(
        _make_folder(root / "knowledge") / "base.npz"
    )
    graph = kineme.MotionGraph((), (), (), 60.0, 0.1, 0.3)
    write_graph(graph, _make_folder(root / "graphs") / "empty.json")
    cut = motion[:900]
    formats.write(cut, root / CUT)
    cut = formats.read_motion(root / CUT)
    graph = motion_graph([cut], [kineme.segment(cut)])
    write_graph(graph, root / "graphs" / "graph.json")


def _write_library(root: Path, motion: Motion, _: Segmentation) -> None:
    takes = _make_folder(root.parent / "takes")
    for name, part in (("walk.bvh", motion[:300]), ("jacks.bvh", motion[2400:2640])):
        formats.write(part, takes / name)
    folder = root / "library"
    build(takes, folder)
    Library(folder).name(0, "walk").merge(0, 1).split(0, ["walk.bvh"])


def _write_studio(root: Path, motion: Motion, truth: Segmentation) -> None:
    folder = _make_folder(root / "studio")
    formats.write(motion[:60], root / TAKE)
    said = formats.ReadOptions(fps=30.0, unit="cm", up="y")
    write_reading(root / TAKE, said, ["Anna", "Bob"])
    write_video_offset(root / TAKE, 1.5)
    write_shared_labels(folder, ["walk", "jump"])
    saved = folder / f"walk{CORRECTED}"
    journal = Journal(saved, truth)

    for fps in (59.0, 60.0):
        table = Segmentation.from_columns(truth.table.columns(), n_frames=truth.n_frames, fps=fps)
        change = journal.make_change(table, None, replaced=True)
        journal.write(change, saved.write_bytes, revision=1, name=f"at {fps:g} Hz")


def _convert_labels(root: Path, path: Path) -> object:
    """Write the labels in formats that hold more than the table, such as comments."""
    found = kineme.read_segments(root / path, format=path.stem, fps=60)
    folder = _make_folder(root.parent / "written")
    for name in ("boris", "babel", "clips", "csv"):
        known = labels.label_formats()[name]
        kineme.write_segments(found, folder / f"{name}{known.written_suffix}", format=name)
    return find_marked(found, "checked"), editing.cluster_names(found), editing.comments(found)


def _read_collection(path: Path) -> object:
    sources = find_labels([Path("a.bvh"), Path("b.bvh")], path)
    return [source.of(n_frames=240, fps=60.0) for source in sources.values()]


def _build_library(root: Path) -> object:
    folder = root.parent / "rebuilt"
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(root / "library", folder)
    return build((), folder)


def _read_side_files(root: Path) -> object:
    take = root / TAKE
    said = list_sidecar_problems(take)
    found = kineme.read(take, **vars(read_saved_options(take))), list_recordings([take])
    return found, make_video_message(take), read_shared_labels(take.parent), said


def _read_library(root: Path) -> object:
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
        ListedRecording(folder / "walk.bvh"), lambda _: True, set(), lambda _: False
    )
    if table is None:
        return notes
    journal = Journal(file.path, table)
    kept = [journal.table(number) for number in journal.versions()]
    before = journal.undo_or_redo(undo=True) if journal.can_undo else None
    return kept, before, journal.knows("x")


def _make_folder(folder: Path) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    return folder
