"""What a page draws of the repetitions of a cluster: what `kineme.cycles` measures, and no other.

Repetitions of one name are one group, as in the files of ``kineme cycles``: equal phase, borders
between two frames, mean and standard deviation over the inner ones.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Sequence
from dataclasses import replace
from math import floor, log10
from threading import RLock
from typing import TYPE_CHECKING

import numpy as np
from msgspec import structs
from numpy.typing import NDArray

from kineme._util.arrays import Floats
from kineme.recordings import Motion, Signals
from kineme.segments.annotation import NO_ANNOTATION
from kineme.segments.segmentation import Segmentation
from kineme.web.messages import (
    ClusterCurves,
    CycleChannel,
    CycleCurve,
    OtherSession,
    ReportCurves,
)

if TYPE_CHECKING:
    from kineme.cycles.channels import Channel
    from kineme.cycles.table import Columns, Cycles


MOST = 150
"""Curves that are drawn of a group; the mean is of all."""
FAR, FEWEST = 3, 6
"""Those farthest from the mean are among them; so many are in a report, if they fit."""
MOST_USUAL = 16
"""Channels of which the one that tells most is chosen, and that a report may hold."""
MOST_KEPT = 24
"""Channels whose numbers stay in memory: 3 MB each for an hour at 120 Hz."""
DIGITS = 4
"""Curves are rounded to so many, counted from the first of what a channel spans; means to one more.
"""
MOST_NUMBERS = 50_000
"""In the curves of a report, some 3 bytes each."""
FEWEST_CHANNELS = 4
MOST_FRAMES = 200_000
"""Of all tables of a report together: half a second for a hundred thousand."""
OUT = "left out by hand"
PLACES = {
    "first": "the first of its activity",
    "last": "the last of its activity",
    "only": "the only one of its activity",
}


class CycleCurves:
    """Curves of a recording's repetitions, measured when they are asked for.

    ``read`` gives the recording, ``beside`` the channels of the same time, if there are any:
    neither is held. Cycles are those of the table asked for last.
    """

    def __init__(
        self,
        read: Callable[[], Motion | Signals],
        beside: Callable[[], Signals | None] = lambda: None,
    ):
        self._read, self._beside = read, beside
        self._heads: dict[str, CycleChannel] = {}
        self._usual: list[str] = []
        self._values: OrderedDict[str, Channel] = OrderedDict()
        self._table: Segmentation | None = None
        self._cycles: Cycles | None = None
        self._both: tuple[tuple[Segmentation, Segmentation], Cycles] | None = None
        self._lock = RLock()

    def channels(self) -> list[CycleChannel]:
        """What can be measured: those that are measured where nobody says which come first."""
        from kineme.cycles.channels import channels_of
        from kineme.cycles.comparison import pair_sides

        with self._lock:
            if not self._heads:
                recording, beside = self._read(), self._beside()
                every = channels_of(recording, ["*"], beside=[] if beside is None else [beside])
                self._usual = [each.name for each in channels_of(recording)[:MOST_USUAL]]
                pairs = pair_sides(tuple(each.name for each in every))
                opposite = dict(pairs) | {right: left for left, right in pairs}
                # Those measured by default first; the sort is stable and keeps the rest in order.
                for each in sorted(every, key=lambda one: one.name not in self._usual):
                    self._heads[each.name] = CycleChannel(
                        name=each.name,
                        unit=each.unit,
                        group=each.group,
                        opposite=opposite.get(each.name, ""),
                    )
            return list(self._heads.values())

    def of(self, table: Segmentation, cluster: int, channel: str = "") -> ClusterCurves | None:
        """Return the curves of a cluster.

        None where there are no such repetitions, or no such channel.

        Without ``channel`` that one which goes farthest in them.
        """
        with self._lock:
            self.channels()
            cycles = self._of_table(table)
            rows = _select_group(cycles, cluster)
            if not rows.any() or (channel and channel not in self._heads):
                return None
            measured = self._measured(cycles, [channel] if channel else self._usual)
            group = measured.select(rows)
            name = channel or _sort_channels_by_range(group, measured)[0]
            ends = _has_only_ends(group)
            return _make_message(
                group, name, MOST, _compute_means(group, ends=ends)[name], ends=ends
            )

    def beside(
        self,
        table: Segmentation,
        cluster: int,
        channel: str,
        other: CycleCurves,
        other_table: Segmentation,
    ) -> ClusterCurves | None:
        """Return the same with the mean of what has the same name in another recording, if it has.

        Both are measured together, and so from one phase.
        """
        from kineme.cycles.comparison import compare_curves

        alone = self.of(table, cluster, channel)
        if alone is None or alone.channel not in {head.name for head in other.channels()}:
            return alone
        cycles, other_cycles = self._together(table, other, other_table)
        group = cycles.select(_select_group(cycles, cluster))
        others = other_cycles.select(other_cycles.columns["group"] == group.columns["group"][0])
        if not len(others):
            return alone
        # If either side has no inner cycle, ends count for both.
        name, ends = alone.channel, _has_only_ends(group) or _has_only_ends(others)
        first, second = self._measured(group, [name]), other._measured(others, [name])
        compared = compare_curves(first, second, ends=ends)
        drawn = _make_message(first, name, MOST, _compute_means(first, ends=ends)[name], ends=ends)
        # One digit more than for single curves.
        digits = _choose_digits(_measure_range(first.curves)) + 1
        return structs.replace(
            drawn,
            beside=OtherSession(
                n=int(compared["second_n"][0]),
                total=len(others),
                mean=_round_values(compared["second_mean"], digits),
                sd=_round_values(compared["second_sd"], digits),
                differs=((compared["low"] > 0) | (compared["high"] < 0)).tolist(),
            ),
        )

    def report(self, table: Segmentation, others: Sequence[Segmentation] = ()) -> ReportCurves:
        """Return the curves of all clusters, of as many channels and cycles as fit into a page.

        ``others`` are the tables at other details, of which long recordings have none.
        """
        with self._lock:
            heads = {head.name: head for head in self.channels()}
            if table.n_frames * (1 + len(others)) > MOST_FRAMES:
                others = ()
            shown = self._measured(self._of_table(table), self._usual)
            found: dict[tuple[object, ...], Cycles] = {}
            tables: list[dict[str, int]] = []
            for each in (table, *others):
                cycles = shown if each is table else self._of_table(each)
                groups = {
                    k: cycles.select(_select_group(cycles, k)) for k in _list_clusters(cycles)
                }
                for group in groups.values():
                    # Groups with equal spans at several details are sent once.
                    found.setdefault(_make_group_key(group), group)
                # Numbers of groups in the order in which they were found.
                numbers = {spans: number for number, spans in enumerate(found)}
                tables.append(
                    {str(k): numbers[_make_group_key(group)] for k, group in groups.items()}
                )
            names = self._report_channels(shown, len(found))
            # How many curves fit, divided among the channels.
            room = MOST_NUMBERS // (shown.curves.shape[2] * len(names))
            most = _count_fitting_cycles([len(group) for group in found.values()], room)
            return ReportCurves(
                channels=[_add_opposite(heads[name], names) for name in names],
                curves=[self._of_report(group, names, most, shown) for group in found.values()],
                tables=tables,
            )

    def _report_channels(self, cycles: Cycles, n_groups: int) -> list[str]:
        """Return the usual channels: those with the largest range in a cluster, with both sides."""
        lively = [_sort_channels_by_range(cycles.select(_select_group(cycles, cluster)), cycles)[0]
                  for cluster in _list_clusters(cycles)]  # fmt: skip
        sides = [
            side
            # Both sides of each channel, the liveliest first; duplicates go below.
            for name in [*lively, *self._usual]
            for side in (name, self._heads[name].opposite)
            if side in self._usual
        ]
        # Numbers that each channel needs at least: mean, deviation and a few cycles of each group.
        least = max(n_groups, 1) * cycles.curves.shape[2] * (2 + FEWEST)
        return list(dict.fromkeys(sides))[: max(MOST_NUMBERS // least, FEWEST_CHANNELS)]

    def _of_report(
        self, group: Cycles, names: Sequence[str], most: int, every: Cycles
    ) -> dict[str, ClusterCurves]:
        """By channel, that one first which goes farthest."""
        measured = group if group.channels else self._measured(group, names)
        ends = _has_only_ends(measured)
        means = _compute_means(measured, ends=ends)
        return {
            name: _make_message(measured, name, most, means[name], ends=ends)
            for name in _sort_channels_by_range(measured, every)
            if name in names
        }

    def _of_table(self, table: Segmentation) -> Cycles:
        """Its cycles, without channels; measured once for all that people say of its segments."""
        from kineme.cycles.measure import cycles, mark_excluded

        if self._cycles is None or not _have_same_segments([self._table], [table]):
            recording = self._read()
            found = cycles(recording, _rescale_table(table, recording), channels=[])
            self._table, self._cycles = table, _add_frames(found, table)
        return mark_excluded(self._cycles, [table])

    def _together(
        self, table: Segmentation, other: CycleCurves, other_table: Segmentation
    ) -> tuple[Cycles, Cycles]:
        """Return the cycles of both, without channels; movements of one name begin at one phase."""
        from kineme.cycles.measure import cycles, mark_excluded

        tables = table, other_table
        with self._lock:
            if self._both is None or not _have_same_segments(self._both[0], tables):
                recordings = self._read(), other._read()
                timed = [_rescale_table(*each) for each in zip(tables, recordings, strict=True)]
                self._both = tables, cycles(recordings, timed, channels=[])
            found = mark_excluded(self._both[1], tables)
        # The first recording's name; rows of the other one have another.
        first = found.columns["recording"] == found.columns["recording"][0]
        return _add_frames(found.select(first), table), found.select(~first)

    def _measured(self, cycles: Cycles, names: Sequence[str]) -> Cycles:
        """Return the cycles with these channels."""
        with self._lock:
            return self._with_channels(cycles, names)

    def _with_channels(self, cycles: Cycles, names: Sequence[str]) -> Cycles:
        from kineme.cycles.channels import channels_of
        from kineme.cycles.measure import measure_other_channels

        missing = [name for name in names if name not in self._values]
        if missing:
            recording = self._read()
            # Only channels beside a motion need the other file.
            needed = isinstance(recording, Motion) and any(
                self._heads[name].group == "channel" for name in missing
            )
            beside = self._beside() if needed else None
            for each in channels_of(recording, ["*"], beside=[] if beside is None else [beside]):
                if each.name in missing:
                    self._values[each.name] = _copy_numbers(each)
        channels = [self._values[name] for name in names]
        for name in names:
            self._values.move_to_end(name)
        # Drop the channel that was used longest ago.
        while len(self._values) > MOST_KEPT:
            self._values.popitem(last=False)
        return measure_other_channels(cycles, channels)


def _copy_numbers(channel: Channel) -> Channel:
    """Return the same channel with its numbers, without the recording that they come from."""
    values = channel.values()
    return replace(channel, compute=lambda: values, gaps=())


def _rescale_table(table: Segmentation, recording: Motion | Signals) -> Segmentation:
    """Return the table at the rate of its recording, without what people say of its segments."""
    return replace(table, fps=recording.fps, annotation=NO_ANNOTATION)


def _have_same_segments(before: Sequence[Segmentation | None], now: Sequence[Segmentation]) -> bool:
    """Return whether the tables have the same segments, whatever people say of them."""
    return all(
        old is new or (old is not None and (old.table, old.fps) == (new.table, new.fps))
        for old, new in zip(before, now, strict=True)
    )


def _add_frames(cycles: Cycles, table: Segmentation) -> Cycles:
    """Return the cycles of a table with the first frames of their segments."""
    # In the order of the cycles, which is that of the primitives.
    frames = [row.start_frame for row in table.primitives if row.kind == "primitive"]
    columns = {**cycles.columns, "segment_frame": np.array(frames, np.int64)}
    return replace(cycles, columns=columns)


def _list_clusters(cycles: Cycles) -> list[int]:
    return sorted({cluster for cluster in cycles.columns["cluster"].tolist() if cluster >= 0})


def _make_group_key(cycles: Cycles) -> tuple[object, ...]:
    """Return all that curves of these cycles depend on."""
    names = ("start_s", "stop_s", "place", "excluded")
    return _count_turned(cycles), *(tuple(cycles.columns[name].tolist()) for name in names)


def _count_fitting_cycles(sizes: Sequence[int], room: int) -> int:
    """How many cycles of each group can be drawn, if there is room for so many curves in all."""
    most = FAR
    # Mean and deviation take two curves; one more cycle is added while all still fits.
    while most < MOST and sum(2 + min(size, most + 1) for size in sizes) <= room:
        most += 1
    return most


def _add_opposite(head: CycleChannel, names: Sequence[str]) -> CycleChannel:
    opposite = head.opposite if head.opposite in names else ""
    return CycleChannel(name=head.name, unit=head.unit, group=head.group, opposite=opposite)


def _select_group(cycles: Cycles, cluster: int) -> NDArray[np.bool_]:
    """Return which cycles are of the group of a cluster: its own, and those with the same name."""
    groups = cycles.columns["group"][cycles.columns["cluster"] == cluster]
    if cluster < 0 or len(groups) == 0:
        return np.zeros(len(cycles), bool)
    return np.asarray(cycles.columns["group"] == groups[0])


def _sort_channels_by_range(group: Cycles, every: Cycles) -> list[str]:
    """Return the channels, the one whose mean goes farthest first.

    Without a unit, as a share of what the channel spans in all cycles.
    """
    means = _compute_means(group, ends=_has_only_ends(group))
    extents = [
        _measure_range(means[channel]["mean"])
        / (1 if unit else _measure_range(every.curves[:, every.channels.index(channel)]) or 1)
        for channel, unit in zip(group.channels, group.units, strict=True)
    ]
    return [group.channels[place] for place in np.argsort(-np.array(extents), kind="stable")]


def _measure_range(values: Floats) -> float:
    """From the least to the greatest number; 0 where there is none."""
    finite = values[np.isfinite(values)]
    return float(np.ptp(finite)) if len(finite) else 0.0


def _compute_means(group: Cycles, *, ends: bool) -> dict[str, Columns]:
    """By channel the mean curve."""
    # Curves of a group follow each other, channel by channel.
    tidy, points = group.mean_curves(ends=ends), group.curves.shape[2]
    return {
        channel: {name: tidy[name][place * points : (place + 1) * points] for name in tidy}
        for place, channel in enumerate(group.channels)
    }


def _has_only_ends(group: Cycles) -> bool:
    """Return whether the mean is of all cycles, as none is an inner one."""
    return not group.used().any()


def _make_message(
    group: Cycles, channel: str, most: int, mean: Columns, *, ends: bool
) -> ClusterCurves:
    """Return the message for the cycles of a group."""
    from kineme.cycles.table import BY_HAND

    place = group.channels.index(channel)
    curves, columns = group.curves[:, place], group.columns
    complete = np.isfinite(curves).all(axis=1)
    counts = group.used(ends=ends) & complete
    # Squared differences from the mean curve, nan where either is missing.
    apart = np.square(curves - mean["mean"])
    finite = np.isfinite(apart)
    # Root mean square over the points that were recorded; nan where none was.
    distance = np.sqrt(np.divide(
        np.where(finite, apart, 0).sum(axis=1), finite.sum(axis=1),
        out=np.full(len(group), np.nan), where=finite.any(axis=1),
    ))  # fmt: skip
    # Cycles that count first, the farthest from the mean first.
    order = sorted(range(len(group)), key=lambda i: (not counts[i], -np.nan_to_num(distance[i])))
    by_hand = set(np.flatnonzero(columns["excluded"] == BY_HAND).tolist())
    digits = _choose_digits(_measure_range(curves))
    drawn = [
        CycleCurve(
            start_frame=int(columns["segment_frame"][i]),
            start_s=float(columns["start_s"][i]),
            stop_s=float(columns["stop_s"][i]),
            counts=bool(counts[i]),
            note="" if counts[i] else OUT if i in by_hand else _explain_exclusion(columns, i),
            distance=None if np.isnan(distance[i]) else round(float(distance[i]), digits),
            values=_round_values(curves[i], digits),
        )
        for i in _choose_cycles(order, most, by_hand)
    ]
    return ClusterCurves(
        channel=channel,
        unit=group.units[place],
        n=int(mean["n"][0]),
        total=len(group),
        ends=ends,
        left_out=len(by_hand),
        turned=_count_turned(group),
        mean=_round_values(mean["mean"], digits + 1),
        sd=_round_values(mean["sd"], digits + 1),
        cycles=drawn,
        beside=None,
    )


def _count_turned(group: Cycles) -> int:
    """Return how many of its activities began at another phase than the others."""
    place = group.columns["recording"][0], group.columns["group"][0]
    return sum((each["recording"], each["group"]) == place for each in group.provenance["turned"])


def _round_values(values: Floats, digits: int) -> list[float | None]:
    return [value if np.isfinite(value) else None for value in values.round(digits).tolist()]


def _choose_digits(extent: float) -> int:
    """Return how many digits after the point numbers of this extent are told with."""
    # Counted from the first digit of the extent.
    return DIGITS - 1 - floor(log10(extent)) if extent > 0 else DIGITS


def _choose_cycles(order: Sequence[int], most: int, kept: set[int]) -> list[int]:
    """Return first ones, which are the farthest, those kept, and of the others evenly so many."""
    if len(order) <= most:
        return list(order)
    first = [i for place, i in enumerate(order) if place < FAR or i in kept][:most]
    rest, n = [i for i in order if i not in first], most - len(first)
    # Evenly spread over the rest, which is in the order of distance.
    others = {rest[i * len(rest) // n] for i in range(n)}
    return [i for i in order if i in first or i in others]


def _explain_exclusion(columns: Columns, row: int) -> str:
    """Why a cycle does not count in the mean."""
    excluded, place = str(columns["excluded"][row]), str(columns["place"][row])
    return excluded or PLACES.get(place, "something was not recorded")
