"""Measure how much each constant of the method contributes.

    python -m benchmarks constants [--sources NAME ...] [--only NAME ...] [--every N] [--record]

Each constant is switched off as far as possible, decreased by 20 %, increased by 25 %, and set to
the value of the other preset (``kineme`` for bodies, ``sensors`` for signals). The table shows the
loss of the summary score (`sources.summarize`), averaged over sources and in the worst source;
negative values are gains. ``python -m benchmarks sources --free`` chooses values.
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
from _options import choose_size, find_data, make_parser
from _sources import SOURCES, Judged
from kineme.evaluation.score import pool_scores
from kineme.methods.kineme.preset import KINEME, OF_SENSORS, SENSORS, KinemePreset
from kineme.recordings import Signals
from sources import summarize

EVERY = {
    "hapt": 10, "hugadb": 12, "utkinect": 5, "uiprmd_sessions": 3, "uiprmd_incorrect_sessions": 3,
    "ipolgait": 8, "countix": 8, "msrc12": 6, "sparse_events": 10, "hdm05": 4, "uiprmd": 4,
    "uiprmd_incorrect": 4, "synthetic": 2, "barbell": 3, "subject_86": 1,
}  # fmt: skip
"""Every n-th recording of each source, slowest first."""
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
            "min_action", "two_movements", "border_shift",
            "noise_share", "centering", "same_cost", "event_scale", "event_velocity",
            "event_cost",
        )
    },
    **{name: {name: TINY} for name in ("chance_count", "chance_period", "event_cover")},
    "min_recurrence": {"min_recurrence": TINY},
    **{name: {name: NEVER} for name in ("part", "compared_within", "max_repetition")},
    "min_similarity": {"min_similarity": 1.0},
    "same_set": {"same_set": 2.0},
    **{name: {name: 1.0} for name in ("end_distance", "max_unexplained", "event_rest")},
    "end_scatter": {"end_scatter": 1000.0},
}  # fmt: skip
"""Values that switch a constant off; a number applies to each item of a tuple."""
NUDGES = {"x 0.8": 0.8, "x 1.25": 1.25}
HOW = ("off", *NUDGES, "the other's")
OWN = OF_SENSORS.keys() - ONE_VIEW.keys() - {"unit"}
"""Constants with different values for bodies and sensors."""
TOLD = ("offsets",)
"""Constants left out: the method does not read them."""
OF_EVENTS = ("min_recurrence",)
UNREAD = {
    KINEME.name: ("smoothing", "velocity_weight"),
    SENSORS.name: [
        name for name in SENSORS.parameters() if name in OF_EVENTS or name.startswith("event_")
    ],
}
"""Constants that have no effect on bodies, and on signals."""
NAMES = [
    "one view",
    *(
        known.name
        for known in KINEME.constants()
        if known.name not in TOLD and not known.name.startswith("unsure_")
    ),
]


class Change(NamedTuple):
    """A change of a constant."""

    name: str
    how: str

    def of(self, preset: KinemePreset) -> KinemePreset | None:
        """Return the changed preset; None if it is the same."""
        values: Mapping[str, Any] = {}
        if self.name in UNREAD[preset.name] and self.how != "the other's":
            return None
        if self.how == "off":
            values = {
                key: _repeat_value(preset, key, to) for key, to in OFF.get(self.name, {}).items()
            }
        elif self.how == "the other's" and self.name in OWN:
            values = {self.name: getattr(SENSORS if preset is KINEME else KINEME, self.name)}
        elif self.how in NUDGES and self.name != "one view":
            values = _scale_constant(preset, self.name, NUDGES[self.how])
        changed = preset.replace(**values)
        return None if changed == preset else changed


def _repeat_value(preset: KinemePreset, name: str, value: Any) -> Any:
    """Repeat a number for each item if the constant is a tuple."""
    own = getattr(preset, name)
    return (value,) * len(own) if isinstance(own, tuple) and np.isscalar(value) else value


def _scale_constant(preset: KinemePreset, name: str, factor: float) -> dict[str, Any]:
    """Multiply a constant by a factor, within its limits."""
    (known,) = (known for known in preset.constants() if known.name == name)

    def nudged(value: float) -> float:
        new = value * factor
        if known.limits is not None:
            new = min(max(new, known.limits.minimum), known.limits.maximum)
        return round(new) if isinstance(value, int) else new

    if isinstance(known.value, tuple):
        return {name: tuple(map(nudged, known.value))}
    return {name: nudged(known.value)}


class SourceFigures(NamedTuple):
    """Summary scores of a source, unchanged first; failed changes; seconds."""

    summaries: list[float]
    failed: list[str]
    seconds: float


def measure_source(source: str, every: int, changes: list[Change]) -> SourceFigures:
    """Segment a source with the unchanged preset and each change."""
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
            except Exception as error:  # noqa: BLE001 (a failure is a result)
                failed.add(f"{change.name} {change.how}: {type(error).__name__} {error}")
    summaries = [_summarize(judged) for judged in found]
    return SourceFigures(summaries, sorted(failed), perf_counter() - start)


def _summarize(judged: list[Judged]) -> float:
    names = judged[0] if judged else ()
    return summarize(
        {name: pool_scores([one[name] for one in judged if name in one]) for name in names}
    )


def show(changes: list[Change], lost: np.ndarray, sources: list[str]) -> None:
    """Print a row for each constant, that with the largest loss first."""
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
            record(f"constants.{_make_key(name)}.{_make_key(change.how)}", round(means[change], 4))


def _make_key(words: str) -> str:
    return words.replace("'", "").replace(" ", "_").replace(".", "")


def main() -> None:
    parser = make_parser(__doc__)
    parser.add_argument("--sources", nargs="+", choices=SOURCES)
    parser.add_argument("--only", nargs="+", choices=NAMES, default=choose_size(NAMES, NAMES[:3]))
    parser.add_argument(
        "--every", type=int, default=choose_size(1, 50), help="of those that are looked at"
    )
    parser.add_argument("--processes", type=int, default=2)
    add_option(parser)
    options = parser.parse_args()
    find_data("")
    sources = options.sources or choose_size(list(EVERY), ["uiprmd_incorrect", "ipolgait"])
    changes = [
        change
        for name in options.only
        for change in (Change(name, how) for how in HOW)
        if change.of(KINEME) or change.of(SENSORS)
    ]
    every = [EVERY.get(source, 8) * options.every for source in sources]
    found = []
    with ProcessPoolExecutor(options.processes, mp_context=get_context("spawn")) as pool:
        work = partial(measure_source, changes=changes)
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
