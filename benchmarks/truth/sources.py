"""All kinds of recordings in one run, and constants chosen with each source left out.

    python -m benchmarks sources [SOURCE ...] [--every N] [--presets kineme sensors] [--record]
    python -m benchmarks sources --free NAME=VALUE,VALUE,... [--free ...] [--presets NAME]
    python -m benchmarks sources [SOURCE ...] --same [--record]

Sources (`_sources.py`) are bodies that people cut, tagged or counted, sensors that people labelled,
and recordings that are made, HuGaDB once more with the files of each person joined. The second
form tries every combination of values, on every source; for each source it then takes the one that
is best in the mean of all others, and tells what that gives there, beside what is shipped and the
choice by all of them: what was left out decides. The third asks whether the same movement gives
the same answer: at other rates, cut, with noise, turned, larger, faster, as poses of a video.
"""

from __future__ import annotations

import argparse
import math
import warnings
from collections.abc import Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from itertools import product
from multiprocessing import get_context
from typing import NamedTuple

import numpy as np

import kineme
from _figures import add_option, record
from _guises import agreement, guises
from _options import DATA, command_line, few, skip
from _sources import SOURCES, Judged
from kineme.evaluation.score import pool_scores
from kineme.methods.base import Preset
from kineme.methods.presets import PRESETS

SMALLER_IS_BETTER = ("error",)
EVERY = {"hugadb": 4, "hdm05": 2, "sparse_events": 5, "ipolgait": 2}
"""Of large sources, where constants are tried: every n-th recording."""

SAME = {"subject_86": 1, "hdm05": 13, "uiprmd": 12, "countix": 20, "hugadb": 60, "ipolgait": 20}
"""Sources that are segmented in other guises: every n-th recording."""

Figures = Mapping[str, float]


class Work(NamedTuple):
    """A source that is segmented by presets: every n-th recording of it.

    By name a preset stands for what suits the recording, bodies or sensors.
    """

    source: str
    presets: tuple[str | Preset, ...]
    every: int


def figures_of(work: Work) -> list[Figures]:
    """The figures of a source, of each preset."""
    warnings.simplefilter("ignore")
    found: list[list[Judged]] = [[] for _ in work.presets]
    for sample in SOURCES[work.source](work.every):
        for judged, preset in zip(found, work.presets, strict=True):
            judged.append(sample.judge(kineme.segment(sample.recording, preset=preset)))
    return [
        {name: pool_scores([one[name] for one in judged if name in one]) for name in judged[0]}
        for judged in found
    ]


def all_figures(
    sources: Sequence[str],
    presets: Sequence[str | Preset],
    every: Mapping[str, int],
    processes: int,
) -> dict[str, list[Figures]]:
    """By source: the figures of each preset."""
    works = [Work(name, tuple(presets), every.get(name, 1)) for name in sources]
    with ProcessPoolExecutor(processes, mp_context=get_context("spawn")) as pool:
        return dict(zip(sources, pool.map(figures_of, works), strict=True))


def summary(figures: Figures) -> float:
    """One number for a source: the mean of its figures, 1 at best."""
    values = [1 - v if name in SMALLER_IS_BETTER else v for name, v in figures.items()]
    return float(np.mean([value / 100 if value > 1 else value for value in values]))


def show(title: str, figures: Figures) -> None:
    cells = "  ".join(f"{name} {value:.3f}" for name, value in figures.items())
    print(f"{title:40}{cells}", flush=True)


def choose(
    tried: Sequence[Preset], found: Mapping[str, list[Figures]], names: Sequence[str]
) -> None:
    """What each source gets where constants are chosen on all others."""
    values = {name: np.array([summary(one) for one in of]) for name, of in found.items()}
    everywhere = int(np.mean(list(values.values()), axis=0).argmax())
    print(f"\n{'source':30}{'shipped':>9}{'left out':>9}{'by all':>9}  chosen without it")
    for name, own in values.items():
        others = [other for source, other in values.items() if source != name]
        at = int(np.mean(others, axis=0).argmax()) if others else everywhere
        chosen = ", ".join(f"{key} {getattr(tried[at], key):g}" for key in names)
        print(f"{name:30}{own[0]:9.3f}{own[at]:9.3f}{own[everywhere]:9.3f}  {chosen}", flush=True)


def same_answers(preset: str, sources: Sequence[str]) -> None:
    """How far the answer to the same movement is the same, by guise."""
    shares: dict[str, list[float]] = {}
    chosen = {name: SAME.get(name, 1) for name in sources} or few(SAME, {"subject_86": 5})
    place = ".".join(["sources.same", *sources, preset])
    for source, every in chosen.items():
        for sample in SOURCES[source](every):
            here = kineme.segment(sample.recording, preset=preset)
            for guise in guises(sample.recording):
                there = kineme.segment(guise.recording, preset=preset)
                shares.setdefault(guise.name, []).append(agreement(here, there, guise))
    for name, values in shares.items():
        print(f"{preset}, {name:20}{np.mean(values):.3f} of {len(values)}")
        record(f"{place}.{name.replace(' ', '_')}", float(np.mean(values)))
    means = [float(np.mean(values)) for values in shares.values()]
    print(f"{preset}: {np.mean(means):.3f} in the mean, {min(means):.3f} at worst", flush=True)
    record(f"{place}.mean", float(np.mean(means)))


def constant(text: str) -> tuple[str, list[float]]:
    """``NAME=V,V,...`` as a name and its values."""
    name, _, values = text.partition("=")
    try:
        return name, [float(value) for value in values.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not NAME=VALUE,VALUE,...") from None


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("sources", nargs="*", help=", ".join(SOURCES))
    parser.add_argument("--presets", nargs="+", default=["kineme", "sensors"])
    parser.add_argument("--free", action="append", type=constant, help="NAME=VALUE,VALUE,...")
    parser.add_argument("--every", type=int, default=few(1, 1000), help="recordings of a source")
    parser.add_argument("--processes", type=int, default=2)
    add_option(parser)
    parser.add_argument("--same", action="store_true", help="the same movement in other guises")
    options = parser.parse_args()
    if not DATA.exists():
        skip("no recordings: set KINEME_DATA to their folder")
    sources = options.sources or few(list(SOURCES), ["uiprmd_incorrect", "hapt"])
    if unknown := set(sources) - set(SOURCES):
        parser.error(f"no such source: {', '.join(sorted(unknown))}")
    if options.same:
        for name in options.presets:
            same_answers(name, options.sources)
        return
    if options.free:
        names = [name for name, _ in options.free]
        first = PRESETS[options.presets[0]]
        tried = [first] + [
            first.replace(**dict(zip(names, values, strict=True)))
            for values in product(*(values for _, values in options.free))
        ]
        every = {name: max(options.every, EVERY.get(name, 1)) for name in sources}
        choose(tried, all_figures(sources, tried, every, options.processes), names)
        return
    every = dict.fromkeys(sources, options.every)
    for source, of in all_figures(sources, options.presets, every, options.processes).items():
        for name, figures in zip(options.presets, of, strict=True):
            show(f"{source}, {name}", figures)
            for key, value in figures.items():
                if not math.isnan(value):
                    record(f"sources.{source}.{name}.{key}", round(value, 4))


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
