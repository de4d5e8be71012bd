"""Curves of the repetitions of a cluster, as measured by `kineme.cycles`.

Repetitions with the same name form one group, as in the output of ``kineme cycles``. They are cut
at equal phase, with borders between frames; mean and standard deviation are over inner repetitions.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from math import floor, log10
from threading import RLock

import numpy as np
from msgspec import structs
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme.cycles.channels import Channel, channels_of
from kineme.cycles.comparison import compare_curves, map_sides
from kineme.cycles.measure import cycles as measure_cycles
from kineme.cycles.measure import mark_excluded, measure_other_channels
from kineme.cycles.repetitions import convert_labels
from kineme.cycles.table import BY_HAND, Columns, Cycles
from kineme.recordings import Motion, Signals
from kineme.segments.annotation import NO_ANNOTATION
from kineme.segments.segmentation import Segmentation
from kineme.web.messages import ClusterCurves, CycleChannel, CycleCurve, OtherSession, ReportCurves

MAX_CYCLES = 150
"""Curves drawn of a group; the mean is over all."""
FARTHEST = 3
"""Cycles farthest from the mean that are always drawn."""
MIN_CYCLES = 6
"""Cycles of each group in a report for which room is reserved when channels are chosen."""
MAX_DEFAULT_CHANNELS = 16
"""Channels measured by default, from which the one with the largest range is shown."""
MAX_CHANNELS = 24
"""Channels cached in memory: 3 MB each for an hour at 120 Hz."""
DIGITS = 4
"""Significant digits of curves, relative to the range of the channel; means get one more."""
MAX_NUMBERS = 50_000
"""Numbers in the curves of a report, about 3 bytes each."""
MIN_CHANNELS = 4
"""Channels in a report, even if they exceed `MAX_NUMBERS`."""
MAX_FRAMES = 200_000
"""Frames of all tables of a report; measuring 100,000 takes half a second."""
EXCLUDED_BY_HAND = "left out by hand"
PLACE_NOTES = {
    "first": "the first of its activity",
    "last": "the last of its activity",
    "only": "the only one of its activity",
}
"""Why a cycle at this place in its activity does not count."""


class CycleCurves:
    """Curves of a recording's repetitions, measured on request.

    ``read`` returns the recording, ``beside`` its analog channels or None; neither is kept in
    memory. The cycles of the table used last are cached.
    """

    def __init__(
        self,
        read: Callable[[], Motion | Signals],
        beside: Callable[[], Signals | None] = lambda: None,
    ):
        self._read, self._beside = read, beside
        self._heads: dict[str, CycleChannel] = {}
        self._default_channels: list[str] = []
        self._values: OrderedDict[str, Channel] = OrderedDict()
        self._table: Segmentation | None = None
        self._cycles: Cycles | None = None
        self._common_cycles: tuple[tuple[Segmentation, Segmentation], Cycles] | None = None
        self._lock = RLock()

    def channels(self) -> list[CycleChannel]:
        """Return the channels that can be measured; those measured by default come first."""
        with self._lock:
            if not self._heads:
                recording, beside = self._read(), self._beside()
                all_channels = channels_of(recording, ["*"], beside=[beside] if beside else [])
                self._default_channels = [
                    channel.name for channel in channels_of(recording)[:MAX_DEFAULT_CHANNELS]
                ]
                opposite = map_sides(tuple(channel.name for channel in all_channels))
                # Those measured by default first; the sort is stable and keeps the rest in order.
                for channel in sorted(
                    all_channels, key=lambda one: one.name not in self._default_channels
                ):
                    self._heads[channel.name] = CycleChannel(
                        name=channel.name,
                        unit=channel.unit,
                        group=channel.group,
                        opposite=opposite.get(channel.name, ""),
                    )
            return list(self._heads.values())

    def make_curves(
        self, table: Segmentation, cluster: int, channel: str = ""
    ) -> ClusterCurves | None:
        """Return the curves of a cluster; None without repetitions or without such a channel.

        The default channel is the one with the largest range.
        """
        with self._lock:
            self.channels()  # fills `_heads` and `_default_channels`
            cycles = self._find_cycles(table)
            rows = _select_group(cycles, cluster)
            if not rows.any() or (channel and channel not in self._heads):
                return None
            measured = self._add_channels(cycles, [channel] if channel else self._default_channels)
            group = measured.select(rows)
            name = channel or _sort_channels_by_range(group, measured)[0]
            # First and last cycles of activities count only if there are no others.
            ends = _has_only_ends(group)
            mean = _compute_means(group, ends=ends)[name]
            return _make_message(group, name, MAX_CYCLES, mean, ends=ends)

    def compare_with(
        self,
        table: Segmentation,
        cluster: int,
        channel: str,
        other: CycleCurves,
        other_table: Segmentation,
    ) -> ClusterCurves | None:
        """Return the same curves with the mean of the group of that name in another recording.

        The repetitions of both recordings are cut at a common phase.
        """
        message = self.make_curves(table, cluster, channel)
        if message is None or message.channel not in {head.name for head in other.channels()}:
            return message
        cycles, other_cycles = self._find_common_cycles(table, other, other_table)
        group = cycles.select(_select_group(cycles, cluster))
        others = other_cycles.select(other_cycles.columns["group"] == group.columns["group"][0])
        if not len(others):
            return message
        # If either side has no inner cycle, ends count for both.
        name, ends = message.channel, _has_only_ends(group) or _has_only_ends(others)
        first, second = self._add_channels(group, [name]), other._add_channels(others, [name])
        compared = compare_curves(first, second, ends=ends)
        mean = _compute_means(first, ends=ends)[name]
        own_message = _make_message(first, name, MAX_CYCLES, mean, ends=ends)
        # One digit more than for single curves.
        digits = _choose_digits(_measure_range(first.curves)) + 1
        return structs.replace(
            own_message,
            beside=OtherSession(
                n=int(compared["second_n"][0]),
                total=len(others),
                mean=_round_values(compared["second_mean"], digits),
                sd=_round_values(compared["second_sd"], digits),
                differs=((compared["low"] > 0) | (compared["high"] < 0)).tolist(),
            ),
        )

    def make_report(self, table: Segmentation, others: Sequence[Segmentation] = ()) -> ReportCurves:
        """Return curves of all clusters for a report, limited to what fits into the page.

        ``others`` are the tables at other details, ignored for long recordings.
        """
        with self._lock:
            heads = {head.name: head for head in self.channels()}
            if table.n_frames * (1 + len(others)) > MAX_FRAMES:
                others = ()
            own_cycles = self._add_channels(self._find_cycles(table), self._default_channels)
            groups_by_key: dict[tuple[object, ...], Cycles] = {}
            tables: list[dict[str, int]] = []
            for detail_table in (table, *others):
                cycles = own_cycles if detail_table is table else self._find_cycles(detail_table)
                groups = {
                    k: cycles.select(_select_group(cycles, k)) for k in _list_clusters(cycles)
                }
                for group in groups.values():
                    # A group that is the same at several details is sent once.
                    groups_by_key.setdefault(_make_group_key(group), group)
                numbers = {key: number for number, key in enumerate(groups_by_key)}
                tables.append(
                    {str(k): numbers[_make_group_key(group)] for k, group in groups.items()}
                )
            names = self._choose_report_channels(own_cycles, len(groups_by_key))
            # How many curves fit, divided among the channels.
            max_curves = MAX_NUMBERS // (own_cycles.curves.shape[2] * len(names))
            max_cycles = _count_fitting_cycles(
                [len(group) for group in groups_by_key.values()], max_curves
            )
            return ReportCurves(
                channels=[
                    head if head.opposite in names else structs.replace(head, opposite="")
                    for head in (heads[name] for name in names)
                ],
                curves=[
                    self._make_report_curves(group, names, max_cycles, own_cycles)
                    for group in groups_by_key.values()
                ],
                tables=tables,
            )

    def _choose_report_channels(self, cycles: Cycles, n_groups: int) -> list[str]:
        """Return default channels with both sides, the largest range in a cluster first."""
        groups = (cycles.select(_select_group(cycles, k)) for k in _list_clusters(cycles))
        by_range = [_sort_channels_by_range(group, cycles)[0] for group in groups]
        sides = [
            side
            # Both sides of each channel, the largest range first; duplicates are removed below.
            for name in [*by_range, *self._default_channels]
            for side in (name, self._heads[name].opposite)
            if side in self._default_channels
        ]
        # Each channel needs at least mean, deviation and a few cycles of each group.
        min_numbers = max(n_groups, 1) * cycles.curves.shape[2] * (2 + MIN_CYCLES)
        return list(dict.fromkeys(sides))[: max(MAX_NUMBERS // min_numbers, MIN_CHANNELS)]

    def _make_report_curves(
        self, group: Cycles, names: Sequence[str], max_cycles: int, all_cycles: Cycles
    ) -> dict[str, ClusterCurves]:
        """Return the curves of a group by channel, the largest range first."""
        measured = group if group.channels else self._add_channels(group, names)
        ends = _has_only_ends(measured)
        means = _compute_means(measured, ends=ends)
        return {
            name: _make_message(measured, name, max_cycles, means[name], ends=ends)
            for name in _sort_channels_by_range(measured, all_cycles)
            if name in names
        }

    def _find_cycles(self, table: Segmentation) -> Cycles:
        """Return the cycles of a table without channels, cached while the segments are the same."""
        if self._cycles is None or not _have_same_segments([self._table], [table]):
            recording = self._read()
            measured = measure_cycles(recording, _rescale_table(table, recording), channels=[])
            self._table, self._cycles = table, _add_frames(measured, table)
        return mark_excluded(self._cycles, [table])

    def _find_common_cycles(
        self, table: Segmentation, other: CycleCurves, other_table: Segmentation
    ) -> tuple[Cycles, Cycles]:
        """Return the cycles of both recordings without channels, cut at a common phase."""
        tables = table, other_table
        with self._lock:
            if self._common_cycles is None or not _have_same_segments(
                self._common_cycles[0], tables
            ):
                recordings = self._read(), other._read()
                timed = [_rescale_table(*each) for each in zip(tables, recordings, strict=True)]
                self._common_cycles = tables, measure_cycles(recordings, timed, channels=[])
            common = mark_excluded(self._common_cycles[1], tables)
        # The name of the recording separates the rows of the two.
        first = common.columns["recording"] == common.columns["recording"][0]
        return _add_frames(common.select(first), table), common.select(~first)

    def _add_channels(self, cycles: Cycles, names: Sequence[str]) -> Cycles:
        """Return the cycles with curves of these channels."""
        with self._lock:
            missing = [name for name in names if name not in self._values]
            if missing:
                recording = self._read()
                # Only analog channels of a motion need the file to be read again.
                needed = isinstance(recording, Motion) and any(
                    self._heads[name].group == "channel" for name in missing
                )
                beside = self._beside() if needed else None
                for channel in channels_of(recording, ["*"], beside=[beside] if beside else []):
                    if channel.name in missing:
                        # Compute it now, so that the channel does not hold the recording.
                        compute = partial(np.asarray, channel.values())
                        self._values[channel.name] = replace(channel, compute=compute, gaps=())
            channels = [self._values[name] for name in names]
            for name in names:
                self._values.move_to_end(name)
            # Drop the least recently used channels.
            while len(self._values) > MAX_CHANNELS:
                self._values.popitem(last=False)
            return measure_other_channels(cycles, channels)


def _rescale_table(table: Segmentation, recording: Motion | Signals) -> Segmentation:
    """Return the table at the rate of the recording, without annotations."""
    return replace(table, fps=recording.fps, annotation=NO_ANNOTATION)


def _have_same_segments(before: Sequence[Segmentation | None], now: Sequence[Segmentation]) -> bool:
    """Return whether the tables have the same segments; annotations are ignored."""
    return all(
        old is new or (old is not None and (old.table, old.fps) == (new.table, new.fps))
        for old, new in zip(before, now, strict=True)
    )


def _add_frames(cycles: Cycles, table: Segmentation) -> Cycles:
    """Return the cycles with a column of the first frames of their segments."""
    # Cycles are in the order of the primitives.
    rows = convert_labels(table).primitives
    frames = [row.start_frame for row in rows if row.kind == "primitive"]
    columns = {**cycles.columns, "segment_frame": np.array(frames, np.int64)}
    return replace(cycles, columns=columns)


def _list_clusters(cycles: Cycles) -> list[int]:
    return sorted({cluster for cluster in cycles.columns["cluster"].tolist() if cluster >= 0})


def _make_group_key(cycles: Cycles) -> tuple[object, ...]:
    """Return everything that the curves of these cycles depend on."""
    names = ("start_s", "stop_s", "place", "excluded")
    return _count_turned(cycles), *(tuple(cycles.columns[name].tolist()) for name in names)


def _count_fitting_cycles(sizes: Sequence[int], max_curves: int) -> int:
    """Return how many cycles of each group can be drawn within this number of curves."""
    n = FARTHEST
    # Mean and deviation take two curves; one more cycle is added while all still fits.
    while n < MAX_CYCLES and sum(2 + min(size, n + 1) for size in sizes) <= max_curves:
        n += 1
    return n


def _select_group(cycles: Cycles, cluster: int) -> NDArray[np.bool_]:
    """Return a mask of the cycles in the group of a cluster: its own and those of the same name."""
    groups = cycles.columns["group"][cycles.columns["cluster"] == cluster]
    if cluster < 0 or len(groups) == 0:
        return np.zeros(len(cycles), bool)
    return np.asarray(cycles.columns["group"] == groups[0])


def _sort_channels_by_range(group: Cycles, all_cycles: Cycles) -> list[str]:
    """Return the channels, sorted by the range of their mean, the largest first.

    Ranges without a unit are relative to the range over all cycles.
    """
    means = _compute_means(group, ends=_has_only_ends(group))
    ranges = []
    for channel, unit in zip(group.channels, group.units, strict=True):
        curves = all_cycles.curves[:, all_cycles.channels.index(channel)]
        scale = 1 if unit else _measure_range(curves) or 1
        ranges.append(_measure_range(means[channel]["mean"]) / scale)
    return [group.channels[i] for i in np.argsort(-np.array(ranges), kind="stable")]


def _measure_range(values: Floats) -> float:
    """Return the difference of maximum and minimum; 0 without finite values."""
    finite = values[np.isfinite(values)]
    return float(np.ptp(finite)) if len(finite) else 0.0


def _compute_means(group: Cycles, *, ends: bool) -> dict[str, Columns]:
    """Return the mean curve of each channel."""
    # The table lists all points of a channel before those of the next one.
    table, points = group.mean_curves(ends=ends), group.curves.shape[2]
    return {
        channel: {name: table[name][i * points : (i + 1) * points] for name in table}
        for i, channel in enumerate(group.channels)
    }


def _has_only_ends(group: Cycles) -> bool:
    """Return whether all cycles are at the ends of activities, so that the mean is over all."""
    return not group.used().any()


def _make_message(
    group: Cycles, channel: str, max_cycles: int, mean: Columns, *, ends: bool
) -> ClusterCurves:
    """Return the message with the curves of a group."""
    index = group.channels.index(channel)
    curves, columns = group.curves[:, index], group.columns
    complete = np.isfinite(curves).all(axis=1)
    counts = group.used(ends=ends) & complete
    # Squared distances from the mean curve; nan if either is missing.
    squared = np.square(curves - mean["mean"])
    finite = np.isfinite(squared)
    # Root mean square over recorded points; nan without any.
    distance = np.sqrt(np.divide(
        np.where(finite, squared, 0).sum(axis=1), finite.sum(axis=1),
        out=np.full(len(group), np.nan), where=finite.any(axis=1),
    ))  # fmt: skip
    # Cycles that count come first, sorted by decreasing distance from the mean.
    order = sorted(range(len(group)), key=lambda i: (not counts[i], -np.nan_to_num(distance[i])))
    by_hand = set(np.flatnonzero(columns["excluded"] == BY_HAND).tolist())
    digits = _choose_digits(_measure_range(curves))
    drawn_cycles = [
        CycleCurve(
            start_frame=int(columns["segment_frame"][i]),
            start_s=float(columns["start_s"][i]),
            stop_s=float(columns["stop_s"][i]),
            counts=bool(counts[i]),
            note="" if counts[i] else _explain_exclusion(columns, i),
            distance=None if np.isnan(distance[i]) else round(float(distance[i]), digits),
            values=_round_values(curves[i], digits),
        )
        for i in _choose_cycles(order, max_cycles, by_hand)
    ]
    return ClusterCurves(
        channel=channel,
        unit=group.units[index],
        n=int(mean["n"][0]),
        total=len(group),
        ends=ends,
        left_out=len(by_hand),
        turned=_count_turned(group),
        mean=_round_values(mean["mean"], digits + 1),
        sd=_round_values(mean["sd"], digits + 1),
        cycles=drawn_cycles,
        beside=None,
    )


def _count_turned(group: Cycles) -> int:
    """Return how many activities of the group began at another phase than the rest."""
    key = group.columns["recording"][0], group.columns["group"][0]
    return sum(
        (activity["recording"], activity["group"]) == key for activity in group.provenance["turned"]
    )


def _round_values(values: Floats, digits: int) -> list[float | None]:
    return [value if np.isfinite(value) else None for value in values.round(digits).tolist()]


def _choose_digits(value_range: float) -> int:
    """Return the number of decimals that gives `DIGITS` significant digits of this range."""
    return DIGITS - 1 - floor(log10(value_range)) if value_range > 0 else DIGITS


def _choose_cycles(order: Sequence[int], max_cycles: int, required: set[int]) -> list[int]:
    """Return up to ``max_cycles`` of ``order``, which is sorted by decreasing distance.

    Keep the `FARTHEST` and as many ``required`` ones as fit, then an even sample of the rest.
    """
    if len(order) <= max_cycles:
        return list(order)
    kept = [i for i in order if i in order[:FARTHEST] or i in required][:max_cycles]
    rest, n = [i for i in order if i not in kept], max_cycles - len(kept)
    # An even sample over distances, since the rest is sorted by distance.
    others = {rest[i * len(rest) // n] for i in range(n)}
    return [i for i in order if i in kept or i in others]


def _explain_exclusion(columns: Columns, row: int) -> str:
    """Return why a cycle does not count in the mean."""
    excluded, place = str(columns["excluded"][row]), str(columns["place"][row])
    if excluded == BY_HAND:
        return EXCLUDED_BY_HAND
    return excluded or PLACE_NOTES.get(place, "some channels were not recorded")
