"""What a library of many hours costs, and whether its index finds what an exact search finds.

    python -m benchmarks scale [costs] [search] [larger] [--hours 1000] [--examples 6] [--record]

``--library DIR`` keeps the simulated library there, or takes it from there.

``costs``: processor seconds for an hour of recording (subject 86, AMC, 120 frames a second): read,
segmented, described and kept; the bytes of it, and how many clusters it has, which
``vocabulary.py --growth`` joins. ``search``: a library of so many hours, whose recordings are takes
of six laboratories one after the other, each made slower or faster by up to 1.4, half of them
mirrored, all with noise of their own (the size of a body makes no difference to matching features);
six movements of 0.8 to 4 s searched in it, with the index, exactly, and as a command. It needs
10 MB of disk an hour. ``larger``: what follows from the recorded figures for more hours.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter, process_time
from unittest.mock import patch

import numpy as np
from numpy.typing import NDArray

from _corpora import corpora
from _figures import FILE as FIGURES
from _figures import add_option, record
from _libraries import joined
from _measure import kineme, verdict
from _options import command_line, few, needed
from kineme import Library, bundled_recording, read, segment
from kineme._interpolation import at_frames
from kineme.features.canonical import MATCHING_FPS, matching_features
from kineme.library import Settings
from kineme.library.descriptions import analysis_of
from kineme.library.searching import Example, Hit
from kineme.library.storage.analyses import Analysis, has_analysis, write_analysis
from kineme.library.storage.layout import ANALYSES, HEAD, TABLES
from kineme.library.vocabulary.words import places_in
from kineme.segments.table import SegmentTable

LASTS_S = few(1200.0, 120.0)
"""Of a simulated recording, seconds."""
FASTEST, NOISE = 1.4, (0.01, 0.05)
TOP = 50
LARGER = (10_000, 100_000)
GROWTH = (1000, 10_000)
"""Words whose joining ``vocabulary.py --growth 1000 10000 --record`` measured."""
EXAMPLES_S = (0.8, 1.2, 1.6, 2.2, 3.0, 4.0)
Features = NDArray[np.float32]


def costs() -> None:
    """Processor seconds and bytes for an hour of recording."""
    spent = dict.fromkeys(("read", "segment", "describe"), 0.0)
    segment(read(bundled_recording()))  # compiled code
    hours, words = 0.0, 0
    with TemporaryDirectory() as home:
        trials = sorted(needed("cmu86").glob("*.amc"))
        for path in few(trials, trials[:1]):
            ticks = [process_time()]
            recording = read(path)
            ticks.append(process_time())
            segment(recording)
            ticks.append(process_time())
            piece, features, _ = analysis_of(recording, Settings())
            write_analysis(Path(home), path.stem, piece, features)
            ticks.append(process_time())
            own = np.diff(ticks)
            for name, seconds in zip(spent, (own[0], own[1], own[2] - own[1]), strict=True):
                spent[name] += float(seconds)
            hours += recording.duration / 3600
            words += len(places_in(piece, 0))
        kept = sum(path.stat().st_size for path in Path(home).iterdir())
        parts = {
            "features": sum(p.stat().st_size for p in Path(home).glob("*.npy")) / 1e6 / hours,
            "windows": sum(p.stat().st_size for p in Path(home).glob("*.windows.npy")) / 1e6,
        }
    print(f"{hours:.2f} h of subject 86")
    for name, seconds in spent.items():
        print(f"{name}: {seconds / hours:.1f} s of processor time an hour")
        record(f"scale.{name}", round(seconds / hours, 1), unit="s")
    print(f"kept: {kept / 1e6 / hours:.1f} MB an hour, {parts['features']:.1f} of it arrays")
    print(f"{words / hours:.0f} clusters an hour")
    record("scale.words", round(words / hours))
    record("scale.total", round(sum(spent.values()) / hours), unit="s")
    record("scale.kept", round(kept / 1e6 / hours, 1), unit="MB")
    record("scale.windows", round(parts["windows"] / hours, 2), unit="MB")


def search(hours: float, kept: Path | None, most: int) -> None:
    """A library of so many hours, searched with its index and exactly."""
    with TemporaryDirectory() as home:
        folder = kept or Path(home) / "lib"
        if not (folder / HEAD).exists():
            simulated(folder, hours)
        library = Library(folder)
        named = folder / TABLES / library.head["tables"]
        index = sum(path.stat().st_size for path in named.glob("windows.*.npy"))
        print(f"{library.hours:.0f} h, {len(library)} recordings, index {index / 1e6:.0f} MB")
        searched(library, hours, most)
        like = ("--like", needed("cmu86/86_01.amc"), "--start", 2.0, "--stop", 3.2)
        taken = [kineme("library", "search", folder, *like, "--quiet") for _ in range(3)]
        clock, used, memory = min(taken)
        print(f"as a command {clock:.2f} s, {verdict(clock, 2.0)}; processor {used:.2f} s")
        print(f"memory {memory:.2f} GB")
        record("scale.search.command", round(used, 1), unit="s")
        record("scale.search.command.clock", round(clock, 1), unit="s")
        record("scale.search.memory", round(memory, 1), unit="GB")
        record("scale.search.index", round(index / 1e6 / hours, 2), unit="MB")


def searched(library: Library, hours: float, most: int) -> None:
    """How long it takes, and what the index misses."""
    clock, used, exact_used, recalls = [], [], [], []
    for example in islice(examples(), most):
        library.search(example, top=TOP)  # what the machine has read already counts as warm
        start, begun = perf_counter(), process_time()
        found = library.search(example, top=TOP)
        clock.append(perf_counter() - start)
        used.append(process_time() - begun)
        begun = process_time()
        with patch("kineme.library.finding.open_index", return_value=None):
            exact = library.search(example, top=TOP)
        exact_used.append(process_time() - begun)
        recalls.append(recall(found, exact))
        print(f"{used[-1]:.1f} s, exactly {exact_used[-1]:.1f} s, {recalls[-1]:.2f}", flush=True)
    most = 2.0 if hours > 10 else 0.2
    print(
        f"search: {median(clock):.2f} s ({max(clock):.2f} at most), {verdict(median(clock), most)}"
    )
    print(f"processor {median(used):.2f} s; exactly {median(exact_used):.2f} s")
    print("found of what an exact search finds:", " ".join(f"{each:.2f}" for each in recalls))
    print(f"mean {np.mean(recalls):.3f} (0.97 promised)")
    record("scale.search.processor", round(median(used), 1), unit="s")
    record("scale.search.clock", round(median(clock), 1), unit="s")
    record("scale.search.exact", round(1000 * median(exact_used) / hours, 1), unit="ms")
    record("scale.search.recall", round(float(np.mean(recalls)), 3))
    record("scale.search.hours", round(hours))


def recall(found: list[Hit], exact: list[Hit]) -> float:
    """The share of exact hits of which half lies in something that was found."""
    hits = 0
    for hit in exact:
        shared = (
            min(hit.stop_s, other.stop_s) - max(hit.start_s, other.start_s)
            for other in found
            if other.recording == hit.recording
        )
        hits += max(shared, default=0.0) >= (hit.stop_s - hit.start_s) / 2
    return hits / max(len(exact), 1)


def examples() -> Iterator[Example]:
    """Spans of takes of several laboratories."""
    takes = [take for name in corpora() for take in corpora()[name]]
    rng = np.random.default_rng(1)
    for lasts in EXAMPLES_S:
        while True:
            motion = takes[rng.integers(len(takes))].motion
            if motion.duration > lasts + 1:
                break
        start = round(float(rng.uniform(0, motion.duration - lasts)), 2)
        yield Example(motion, start, start + lasts)


def simulated(folder: Path, hours: float) -> None:
    """A library of recordings put together from takes of several laboratories."""
    (folder / ANALYSES).mkdir(parents=True, exist_ok=True)
    own = [
        matching_features(take.motion, mirrored=mirrored)
        for name in corpora()
        for take in corpora()[name]
        for mirrored in (False, True)
    ]
    n = round(LASTS_S * MATCHING_FPS)
    table, *_ = analysis_of(read(bundled_recording()), Settings())
    segments = nameless(table.table)
    keys = {}
    for number in range(round(hours * 3600 / LASTS_S)):
        key = keys[f"{number:05d}"] = f"{number:032x}"
        if has_analysis(folder / ANALYSES, key):  # of a run that was ended
            continue
        rng = np.random.default_rng(number)
        laid, lasts = [], 0
        while lasts < n:
            laid.append(shaken(faster(own[rng.integers(len(own))], rng), rng))
            lasts += len(laid[-1])
        facts = {
            "format": "", "fps": 120.0, "n_frames": round(120 * LASTS_S), "vocabulary": "bodies",
            "features_fps": MATCHING_FPS, "samples": n, "notes": [],
        }  # fmt: skip
        piece = Analysis(facts, segments, table.embeddings)
        write_analysis(folder / ANALYSES, key, piece, np.concatenate(laid)[:n])
    joined(folder, keys)


def larger() -> None:
    """What many hours take, from the figures that were recorded."""
    figures = json.loads(FIGURES.read_text(encoding="utf-8"))
    told = {name: entry["value"] for name, entry in figures.items()}
    parted, alone = (
        (
            told[f"vocabulary.growth.{GROWTH[1]}.{part}"]
            - told[f"vocabulary.growth.{GROWTH[0]}.{part}"]
        )
        / (GROWTH[1] - GROWTH[0])
        for part in ("seconds", "rest")
    )
    record("scale.join.word", round(1000 * parted, 1), unit="ms")
    record("scale.join.alone", round(1000 * alone, 2), unit="ms")
    for hours in LARGER:
        build, words = told["scale.total"] * hours / 3600, told["scale.words"] * hours / 3600
        values = {
            "build": build,
            "16_cores": build / 16,
            "128_cores": build / 128,
            "kept": told["scale.kept"] * hours / 1e6,
            **{f"join.{cores}": (parted / cores + alone) * words for cores in (1, 16, 128)},
        }
        print(f"{hours} h:", {name: float(f"{value:.2g}") for name, value in values.items()})
        for name, value in values.items():
            record(f"scale.{hours}.{name}", float(f"{value:.2g}"))


def nameless(table: SegmentTable) -> SegmentTable:
    """The segments in no cluster: their joining is measured by itself."""
    columns = dict(table.columns())
    columns["cluster"] = np.full(len(table), -1)
    columns["action"] = columns["cluster"]
    return SegmentTable(**columns)


def faster(features: Features, rng: np.random.Generator) -> Features:
    """The same slower or faster, at least two samples."""
    pace = FASTEST ** rng.uniform(-1, 1)
    at = np.linspace(0, len(features) - 1, max(2, round(len(features) / pace)))
    return at_frames(features.astype(np.float64), at).astype(np.float32)


def shaken(features: Features, rng: np.random.Generator) -> Features:
    """The same with noise of its own; unit vectors again."""
    moved = features + np.float32(rng.uniform(*NOISE)) * rng.standard_normal(
        features.shape, np.float32
    )
    scaled: Features = moved / np.linalg.norm(moved, axis=1, keepdims=True)
    return scaled


def main() -> None:
    options = command_line(__doc__)
    options.add_argument("parts", nargs="*", default=["costs", "search", "larger"])
    options.add_argument("--hours", type=float, default=few(1000.0, 1.0))
    options.add_argument("--examples", type=int, default=few(len(EXAMPLES_S), 2))
    options.add_argument("--library", type=Path, help="keep it here, or take it from here")
    add_option(options)
    given = options.parse_args()
    if "costs" in given.parts:
        costs()
    if "search" in given.parts:
        search(given.hours, given.library, given.examples)
    if "larger" in given.parts:
        larger()


if __name__ == "__main__":
    main()
