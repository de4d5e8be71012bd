"""What each constant of the method is good for: what is lost without it, and where it is nudged.

    python -m benchmarks constants [--sources NAME ...] [--only NAME ...] [--every N] [--record]

Each constant is switched off, as closely as its values allow, made 20 % smaller and 25 % larger,
and, where bodies and sensors have their own, given the value of the other. Shown is how much the
figures of a source (`sources.summary`) lose, in the mean over sources and in the one that loses
most; below 0 something is gained. Bodies are segmented by ``kineme``, signals by ``sensors``.
``python -m benchmarks sources --free`` chooses values with each source left out.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np

import kineme
from _figures import add_option, record
from _options import DATA, command_line, few, needed
from _sources import SOURCES, Judged
from kineme.evaluation.score import pool_scores
from kineme.methods.kineme.preset import KINEME, OF_SENSORS, SENSORS, KinemePreset
from kineme.recordings import Signals
from sources import summary

EVERY = {
    "hapt": 10, "hugadb": 12, "utkinect": 5, "uiprmd_sessions": 3, "uiprmd_incorrect_sessions": 3,
    "ipolgait": 8, "countix": 8, "msrc12": 6, "sparse_events": 10, "hdm05": 4, "uiprmd": 4,
    "uiprmd_incorrect": 4, "synthetic": 2, "barbell": 3, "subject_86": 1,
}  # fmt: skip
"""Every n-th recording of each source, those that take longest first."""
NEVER, TINY = 3600.0, 1e-6
ONE_VIEW = {name: getattr(KINEME, name) for name in ("shared", "weights", "restless_over")}
OFF: Mapping[str, Mapping[str, Any]] = {
    "one view": ONE_VIEW,
    "bands": {"bands": (0.3, 20.0)},
    "weights": {"weights": 0.0},
    "shared": {"shared": 1e4},
    "restless_over": {"restless_over": 0.0},
    "max_clusters": {"max_clusters": 1000},
    **{
        name: {name: 0.0}
        for name in (
            "velocity_weight", "segment_cost", "cluster_cost", "cluster_growth",
            "spread_share", "min_action", "min_explained", "two_movements", "border_shift",
            "noise_share", "centering", "length_cost", "same_cost", "event_scale", "event_velocity",
            "event_cost",
        )
    },
    **{name: {name: TINY} for name in ("chance_count", "chance_period", "event_cover")},
    "min_recurrence": {"min_recurrence": TINY},
    **{name: {name: NEVER} for name in ("part", "compared_within", "max_repetition")},
    "min_similarity": {"min_similarity": 1.0},
    "same_set": {"same_set": 2.0},
    **{name: {name: 1.0} for name in ("end_distance", "max_unexplained", "event_rest")},
    **{name: {name: 1000.0} for name in ("uneven", "end_scatter")},
}  # fmt: skip
"""What switches it off; a number stands for as many of it as a tuple has."""
NUDGES = {"x 0.8": 0.8, "x 1.25": 1.25}
HOW = ("off", *NUDGES, "the other's")
OWN = OF_SENSORS.keys() - ONE_VIEW.keys() - {"unit"}
"""What bodies and sensors have a value of their own of."""
TOLD = ("offsets", "link_weights", "border_weights", "count_weights", "cut_weights")
"""Not asked: what the method does not read, and what is learnt elsewhere."""
OF_EVENTS = ("min_recurrence",)
UNREAD = {
    KINEME.name: ("smoothing", "velocity_weight"),
    SENSORS.name: [
        name for name in SENSORS.parameters() if name in OF_EVENTS or name.startswith("event_")
    ],
}
"""What is not looked at of bodies, and of signals."""
NAMES = [
    "one view",
    *(
        known.name
        for known in KINEME.constants()
        if known.name not in TOLD and not known.name.startswith("unsure_")
    ),
]


class Change(NamedTuple):
    """A constant, and what becomes of it."""

    name: str
    how: str

    def of(self, preset: KinemePreset) -> KinemePreset | None:
        """The preset so changed; None where that changes nothing."""
        values: Mapping[str, Any] = {}
        if self.name in UNREAD[preset.name] and self.how != "the other's":
            return None
        if self.how == "off":
            values = {key: _as_many(preset, key, to) for key, to in OFF.get(self.name, {}).items()}
        elif self.how == "the other's" and self.name in OWN:
            values = {self.name: getattr(SENSORS if preset is KINEME else KINEME, self.name)}
        elif self.how in NUDGES and self.name != "one view":
            values = _times(preset, self.name, NUDGES[self.how])
        changed = preset.replace(**values)
        return None if changed == preset else changed


def _as_many(preset: KinemePreset, name: str, value: Any) -> Any:
    """A number for each that the preset has of it."""
    own = getattr(preset, name)
    return (value,) * len(own) if isinstance(own, tuple) and np.isscalar(value) else value


def _times(preset: KinemePreset, name: str, factor: float) -> dict[str, Any]:
    """A constant so many times, within its limits."""
    (known,) = (known for known in preset.constants() if known.name == name)

    def nudged(value: float) -> float:
        new = value * factor
        if known.limits is not None:
            new = min(max(new, known.limits.minimum), known.limits.maximum)
        return round(new) if isinstance(value, int) else new

    if isinstance(known.value, tuple):
        return {name: tuple(map(nudged, known.value))}
    return {name: nudged(known.value)}


class Figured(NamedTuple):
    """The figures of a source by change, as it is first; changes that failed; seconds."""

    summaries: list[float]
    failed: list[str]
    seconds: float


def figured(source: str, every: int, changes: list[Change]) -> Figured:
    """A source, read once, segmented as it is and with each change."""
    warnings.simplefilter("ignore")
    start = perf_counter()
    found: list[list[Judged]] = [[] for _ in range(1 + len(changes))]
    failed = set()
    for sample in SOURCES[source](every):
        preset = SENSORS if isinstance(sample.recording, Signals) else KINEME
        found[0].append(sample.judge(kineme.segment(sample.recording, preset=preset)))
        for judged, change in zip(found[1:], changes, strict=True):
            changed = change.of(preset)
            try:
                judged.append(
                    found[0][-1]
                    if changed is None
                    else sample.judge(kineme.segment(sample.recording, preset=changed))
                )
            except Exception as error:  # noqa: BLE001 (one that fails is a result)
                failed.add(f"{change.name} {change.how}: {type(error).__name__} {error}")
    summaries = [_summary(judged) for judged in found]
    return Figured(summaries, sorted(failed), perf_counter() - start)


def _summary(judged: list[Judged]) -> float:
    names = judged[0] if judged else ()
    return summary(
        {name: pool_scores([one[name] for one in judged if name in one]) for name in names}
    )


def show(changes: list[Change], lost: np.ndarray, sources: list[str]) -> None:
    """A row for each constant, the one of which most is lost first."""
    means = {change: float(row.mean()) for change, row in zip(changes, lost, strict=True)}
    names = sorted(
        dict.fromkeys(change.name for change in changes),
        key=lambda name: -max(means[change] for change in changes if change.name == name),
    )
    print(f"\n{'lost in the mean':20}" + "".join(f"{how:>12}" for how in HOW) + "  most")
    for name in names:
        own = [change for change in changes if change.name == name]
        cells = "".join(
            f"{means[change]:12.4f}" if change in means else f"{'':12}"
            for change in (Change(name, how) for how in HOW)
        )
        rows = np.array([lost[changes.index(change)] for change in own])
        at, source = np.unravel_index(int(rows.argmax()), rows.shape)
        most = f"{rows[at, source]:.3f} of {sources[source]}, {own[at].how}"
        print(f"{name:20}{cells}  {most}", flush=True)
        for change in own:
            record(f"constants.{_key(name)}.{_key(change.how)}", round(means[change], 4))


def _key(words: str) -> str:
    return words.replace("'", "").replace(" ", "_").replace(".", "")


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("--sources", nargs="+", choices=SOURCES)
    parser.add_argument("--only", nargs="+", choices=NAMES, default=few(NAMES, NAMES[:3]))
    parser.add_argument("--every", type=int, default=few(1, 50), help="of those that are looked at")
    parser.add_argument("--processes", type=int, default=2)
    add_option(parser)
    options = parser.parse_args()
    needed("", DATA)
    sources = options.sources or few(list(EVERY), ["uiprmd_incorrect", "ipolgait"])
    changes = [
        change
        for name in options.only
        for change in (Change(name, how) for how in HOW)
        if change.of(KINEME) or change.of(SENSORS)
    ]
    every = [EVERY.get(source, 8) * options.every for source in sources]
    found = []
    with ProcessPoolExecutor(options.processes, mp_context=get_context("spawn")) as pool:
        work = partial(figured, changes=changes)
        for source, one in zip(sources, pool.map(work, sources, every), strict=True):
            print(f"{source:28}{one.summaries[0]:.3f} as it is, {one.seconds:.0f} s", flush=True)
            for failure in one.failed:
                print(f"  fails: {failure}", flush=True)
            found.append(one.summaries)
    table = np.array(found).T
    show(changes, table[0] - table[1:], sources)


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
