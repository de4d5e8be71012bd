"""Score all sources of recordings, and choose constants by leaving sources out.

    python -m benchmarks sources [SOURCE ...] [--every N] [--presets kineme sensors] [--record]
    python -m benchmarks sources --free NAME=VALUE,VALUE,... [--free ...] [--presets NAME]
    python -m benchmarks sources [SOURCE ...] --same [--record]

Sources (`_sources.py`) are bodies that people cut, tagged or counted, sensors that people labelled,
and synthetic recordings. ``--free`` tries every combination of values on every source. For each
source it shows the score of the shipped values, of the values that are best on all other sources,
and of those that are best on all. ``--same`` measures the agreement with variants of the same
movement: other rates, cut, with noise, turned, scaled, faster.
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
from _options import DATA, choose_size, make_parser, skip
from _sources import SOURCES, Judged
from _variants import make_variants, measure_agreement
from kineme.evaluation.score import pool_scores
from kineme.methods.base import Preset
from kineme.methods.presets import PRESETS

SMALLER_IS_BETTER = ("error",)
EVERY = {"hugadb": 4, "hdm05": 2, "sparse_events": 5, "ipolgait": 2}
"""Every n-th recording of large sources, for ``--free``."""

SAME = {"subject_86": 1, "hdm05": 13, "uiprmd": 12, "countix": 20, "hugadb": 60, "ipolgait": 20}
"""Every n-th recording of the sources for ``--same``."""

Figures = Mapping[str, float]


class Work(NamedTuple):
    """Every n-th recording of a source, to be segmented by presets.

    A preset given by name adapts to the recording: bodies or sensors.
    """

    source: str
    presets: tuple[str | Preset, ...]
    every: int


def score_source(work: Work) -> list[Figures]:
    """Return the scores of each preset on a source."""
    warnings.simplefilter("ignore")
    found: list[list[Judged]] = [[] for _ in work.presets]
    for sample in SOURCES[work.source](work.every):
        for judged, preset in zip(found, work.presets, strict=True):
            judged.append(sample.judge(kineme.segment(sample.recording, preset=preset)))
    return [
        {name: pool_scores([one[name] for one in judged if name in one]) for name in judged[0]}
        for judged in found
    ]


def score_sources(
    sources: Sequence[str],
    presets: Sequence[str | Preset],
    every: Mapping[str, int],
    processes: int,
) -> dict[str, list[Figures]]:
    """Return the scores of each preset, by source."""
    works = [Work(name, tuple(presets), every.get(name, 1)) for name in sources]
    with ProcessPoolExecutor(processes, mp_context=get_context("spawn")) as pool:
        return dict(zip(sources, pool.map(score_source, works), strict=True))


def summarize(figures: Figures) -> float:
    """Return the mean of all scores of a source, at most 1."""
    values = [1 - v if name in SMALLER_IS_BETTER else v for name, v in figures.items()]
    return float(np.mean([value / 100 if value > 1 else value for value in values]))


def show(title: str, figures: Figures) -> None:
    cells = "  ".join(f"{name} {value:.3f}" for name, value in figures.items())
    print(f"{title:40}{cells}", flush=True)


def choose(
    tried: Sequence[Preset], found: Mapping[str, list[Figures]], names: Sequence[str]
) -> None:
    """Print the score of each source with the values that are best on all others."""
    values = {name: np.array([summarize(one) for one in of]) for name, of in found.items()}
    everywhere = int(np.mean(list(values.values()), axis=0).argmax())
    print(f"\n{'source':30}{'shipped':>9}{'left out':>9}{'by all':>9}  chosen without it")
    for name, own in values.items():
        others = [other for source, other in values.items() if source != name]
        at = int(np.mean(others, axis=0).argmax()) if others else everywhere
        chosen = ", ".join(f"{key} {getattr(tried[at], key):g}" for key in names)
        print(f"{name:30}{own[0]:9.3f}{own[at]:9.3f}{own[everywhere]:9.3f}  {chosen}", flush=True)


def compare_variants(preset: str, sources: Sequence[str]) -> None:
    """Print and record the agreement with variants of the same movement."""
    shares: dict[str, list[float]] = {}
    chosen = {name: SAME.get(name, 1) for name in sources} or choose_size(SAME, {"subject_86": 5})
    place = ".".join(["sources.same", *sources, preset])
    for source, every in chosen.items():
        for sample in SOURCES[source](every):
            here = kineme.segment(sample.recording, preset=preset)
            for variant in make_variants(sample.recording):
                there = kineme.segment(variant.recording, preset=preset)
                shares.setdefault(variant.name, []).append(measure_agreement(here, there, variant))
    for name, values in shares.items():
        print(f"{preset}, {name:20}{np.mean(values):.3f} of {len(values)}")
        record(f"{place}.{name.replace(' ', '_')}", float(np.mean(values)))
    means = [float(np.mean(values)) for values in shares.values()]
    print(f"{preset}: {np.mean(means):.3f} in the mean, {min(means):.3f} at worst", flush=True)
    record(f"{place}.mean", float(np.mean(means)))


def parse_constant(text: str) -> tuple[str, list[float]]:
    """Parse ``NAME=V,V,...`` to a name and its values."""
    name, _, values = text.partition("=")
    try:
        return name, [float(value) for value in values.split(",")]
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not NAME=VALUE,VALUE,...") from None


def main() -> None:
    parser = make_parser(__doc__)
    parser.add_argument("sources", nargs="*", help=", ".join(SOURCES))
    parser.add_argument("--presets", nargs="+", default=["kineme", "sensors"])
    parser.add_argument("--free", action="append", type=parse_constant, help="NAME=VALUE,VALUE,...")
    parser.add_argument(
        "--every", type=int, default=choose_size(1, 1000), help="recordings of a source"
    )
    parser.add_argument("--processes", type=int, default=2)
    add_option(parser)
    parser.add_argument("--same", action="store_true", help="compare variants of the same movement")
    options = parser.parse_args()
    if not DATA.exists():
        skip("no recordings: set KINEME_DATA to their folder")
    sources = options.sources or choose_size(list(SOURCES), ["uiprmd_incorrect", "hapt"])
    if unknown := set(sources) - set(SOURCES):
        parser.error(f"no such source: {', '.join(sorted(unknown))}")
    if options.same:
        for name in options.presets:
            compare_variants(name, options.sources)
        return
    if options.free:
        names = [name for name, _ in options.free]
        first = PRESETS[options.presets[0]]
        tried = [first] + [
            first.replace(**dict(zip(names, values, strict=True)))
            for values in product(*(values for _, values in options.free))
        ]
        every = {name: max(options.every, EVERY.get(name, 1)) for name in sources}
        choose(tried, score_sources(sources, tried, every, options.processes), names)
        return
    every = dict.fromkeys(sources, options.every)
    for source, of in score_sources(sources, options.presets, every, options.processes).items():
        for name, figures in zip(options.presets, of, strict=True):
            show(f"{source}, {name}", figures)
            for key, value in figures.items():
                if not math.isnan(value):
                    record(f"sources.{source}.{name}.{key}", round(value, 4))


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
