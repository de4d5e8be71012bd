"""``kineme cycles``: measure each repetition, with summaries and mean curves."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from math import floor, isfinite, log10
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple

import typer
from rich.table import Table
from rich.text import Text

from kineme._util.checks import format_count
from kineme._util.files import PAGES, PICTURES, atomic_write
from kineme.cli.files import Batch, Files, Recursive, SegmentTable, check_suffix
from kineme.cli.help import OUTPUT, option, output_option
from kineme.cli.options import ALL, READING, SEGMENTING, Quiet, add_options
from kineme.cli.segment import read_and_segment
from kineme.cli.tables import make_table, show_written
from kineme.cli.terminal import Console, print_skipped
from kineme.cycles import (
    Cycles,
    channels_of,
    compare_curves,
    compare_sessions,
    compare_sides,
    write_cycles,
    write_table,
)
from kineme.cycles.channels import make_contact_channels
from kineme.cycles.comparison import map_sides, pair_sides
from kineme.cycles.events import OFF, STRIKE, normalize_event_name
from kineme.cycles.export import SUFFIXES, TABLE_SUFFIXES
from kineme.cycles.measure import cycles as measure_cycles
from kineme.cycles.repetitions import is_event
from kineme.cycles.table import INNER
from kineme.errors import ParameterError
from kineme.formats import read_analog
from kineme.formats.options import ReadOptions
from kineme.methods.segmenter import SegmentOptions
from kineme.recordings import Motion, Signals
from kineme.segments.segmentation import Segmentation

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MEASUREMENT = "Measured"
FAR, UNSURE = "far", "unsure"
MAX_CHANNELS = 4
"""Channels whose ranges are printed."""
PLAIN_RANGE = 1e-3, 1e5
"""Numbers outside this range are printed in scientific notation."""
AXES_PER_COLUMN = 4
"""Axes in one column of a plot; above, there are two columns, left and right."""


@add_options(READING | SEGMENTING)
def cycles(
    files: Files,
    read_options: ReadOptions,
    segment_options: SegmentOptions,
    output: Annotated[
        Path | None,
        output_option("Write cycles, summary and curves: .xlsx, .csv, .parquet, .mat or .nc."),
    ] = None,
    plot: Annotated[Path | None, option(OUTPUT, "Draw mean curves: .png, .pdf or .svg.")] = None,
    compare: Annotated[
        Path | None, option(OUTPUT, "Write two recordings side by side: .csv, .parquet, .html.")
    ] = None,
    sides: Annotated[
        Path | None, option(OUTPUT, "Write left beside right (.csv, .parquet); --plot draws it.")
    ] = None,
    channels: Annotated[
        str | None,
        option(
            MEASUREMENT,
            "Channels to measure, such as knee_*,trunk_lean; see kineme info --channels.",
            metavar="NAME,NAME,…",
        ),
    ] = None,
    anchor: Annotated[
        str | None,
        option(
            MEASUREMENT,
            'Start of each cycle: "knee_r max", "knee_r > 40", left_foot_strike, '
            "or an event of the file; by default at equal phase.",
            metavar="EVENT",
        ),
    ] = None,
    align: Annotated[
        Literal["linear", "landmarks", "warp"],
        option(
            MEASUREMENT,
            "Align curves: linear, landmarks or warp.",
            metavar="HOW",
            show_default=False,
        ),
    ] = "linear",
    exclude: Annotated[
        list[str] | None,
        option(
            MEASUREMENT,
            "Exclude rows from the means: row numbers, far (all far from the mean) or "
            "unsure (all with an uncertain start).",
            metavar="ROW|RULE",
        ),
    ] = None,
    ends: Annotated[
        bool, option(MEASUREMENT, "Include first and last repetitions in the means.", "--ends")
    ] = False,
    common: Annotated[
        bool,
        option(
            MEASUREMENT,
            "Treat equal cluster numbers in --segments tables as the same movement.",
            "--common",
        ),
    ] = False,
    refine: Annotated[
        bool,
        option(
            MEASUREMENT,
            "Move borders of labels in --segments to equal phase; by default they stay.",
            "--refine",
        ),
    ] = False,
    segments: SegmentTable = None,
    recursive: Recursive = False,
    quiet: Quiet = False,
) -> None:
    """Measure each repetition: duration, ranges, mean curves.

    Borders are moved to equal phase. Several recordings are measured together. Labels in --segments
    without a level of repetitions are measured one by one.
    """
    batch = Batch(files, recursive=recursive, quiet=quiet)
    names = None if channels is None else [name.strip() for name in channels.split(",")]
    _check_targets(output, plot, compare, sides)
    if compare is not None and len(batch.paths) != 2 and read_options.person != ALL:
        raise typer.BadParameter("takes two recordings", param_hint="--compare")
    if common and segments is None:
        reason = "needs tables that share cluster numbers: give them with --segments"
        raise typer.BadParameter(reason, param_hint="--common")
    parts: list[_SegmentedRecording] = []
    batch.tables("--segments", segments)  # fail early if there are none

    def read_one(path: Path, options: ReadOptions, table: Path | None) -> None:
        """Read and segment one recording (of one person), and append it to ``parts``."""
        with batch.progress(path) as stage:
            recording, found = read_and_segment(path, options, table, segment_options, stage)
            # Analog channels in the file of a motion, such as force plates, can be measured, too.
            is_motion = isinstance(recording, Motion)
            beside = read_analog(path, options) if names and is_motion else None
            analog = [] if beside is None else [beside]
            listed = channels_of(recording, names, beside=analog) if len(batch.paths) > 1 else ()
        channel_names = tuple(channel.name for channel in listed)
        parts.append(_SegmentedRecording(path, recording, found, analog, channel_names))

    for path in batch.paths:
        batch.run_each_person(path, read_options, read_one, tables=("--segments", segments))
    parts = _keep_common_channels(parts, batch)
    recordings, tables = [part.recording for part in parts], [part.segments for part in parts]
    if recordings:
        with batch.catch_result_errors():
            analog = [part.analog for part in parts]
            if sides is not None:
                names = _choose_channels(recordings, names)
                anchor = _leave_out_side(anchor)
            result = measure_cycles(
                recordings, tables, channels=names, anchor=anchor, beside=analog, common=common,
                refine=refine or None, align=align,
            )  # fmt: skip
            if len(result) == 0:
                raise ParameterError(_explain_nothing(anchor, has_table=segments is not None))
            # Cycles between events and those cut by hand are complete: the ends count as well.
            ends |= bool((result.columns["place"] == INNER).all())
            result = _exclude_cycles(result, exclude or [])
            # The cycles of each recording that has some.
            owners = result.columns["recording"]
            named = dict.fromkeys(owners.tolist()) if compare is not None else ()
            sessions = [result.select(owners == name) for name in named]
            plot = _drop_empty_plot(
                plot, result, ends=ends, alone=output is compare is sides is None
            )
            targets = output, plot, compare, sides
            _write_results(result, sessions, *targets, ends=ends)
            if not quiet:
                _show(result, sessions, has_channels=channels is not None, ends=ends)
                show_written(Console(highlight=False), [*targets])
    batch.exit()


class _SegmentedRecording(NamedTuple):
    path: Path
    recording: Motion | Signals
    segments: Segmentation
    analog: list[Signals]
    channels: tuple[str, ...]


def _keep_common_channels(
    parts: list[_SegmentedRecording], batch: Batch
) -> list[_SegmentedRecording]:
    """Keep recordings with the most common set of channels; report the others."""
    counts = Counter(part.channels for part in parts)
    most_common = counts.most_common(1)[0][0] if counts else ()
    for part in parts:
        if part.channels != most_common:
            differences = ", ".join(sorted({*most_common} ^ {*part.channels})[:4])
            reason = f"does not have the channels of the others ({differences})"
            batch.leave_out(part.path, f"{reason}: choose with --channels")
    return [part for part in parts if part.channels == most_common]


def _check_targets(
    output: Path | None, plot: Path | None, compare: Path | None, sides: Path | None
) -> None:
    """Raise typer.BadParameter for files that cannot be written, before any work is done."""
    check_suffix("--output", output, SUFFIXES)
    check_suffix("--plot", plot, PICTURES)
    check_suffix("--compare", compare, (*TABLE_SUFFIXES, *PAGES))
    check_suffix("--sides", sides, TABLE_SUFFIXES)


def _exclude_cycles(cycles: Cycles, rules: list[str]) -> Cycles:
    for rule in rules:
        if rule == FAR:
            cycles = cycles.exclude_far()
        elif rule == UNSURE:
            cycles = cycles.exclude_unsure()
        else:
            try:
                rows = [int(row) for row in rule.split(",")]
            except ValueError:
                raise typer.BadParameter(
                    f"{rule!r} is neither a row nor a rule: give row numbers, {FAR} or {UNSURE}",
                    param_hint="--exclude",
                ) from None
            cycles = cycles.exclude(rows)
    return cycles


def _explain_nothing(anchor: str | None, *, has_table: bool) -> str:
    """Return why there are no cycles, and what to do."""
    if anchor is not None and is_event(anchor):
        return f"nothing to measure: no two events {anchor!r} follow one another; see kineme events"
    if has_table:
        return (
            "nothing to measure: the segments given have no repetitions. Give a table with a row "
            "for each (start_s, stop_s, label)"
        )
    return (
        "nothing repeats in this recording: give the repetitions with --segments (a table of "
        "start_s, stop_s, label) or an event with --anchor, such as left_foot_strike"
    )


def _leave_out_side(anchor: str | None) -> str | None:
    """Return the contact of either foot, from which each side has cycles of its own."""
    contact = normalize_event_name(anchor or "").partition(" ")[2]
    return contact if contact in (STRIKE, OFF) else anchor


def _write_results(
    cycles: Cycles,
    sessions: list[Cycles],
    output: Path | None,
    plot: Path | None,
    compare: Path | None,
    sides: Path | None,
    *,
    ends: bool,
) -> None:
    """Write the requested files: the table, the picture, comparisons of sessions and of sides."""
    if output is not None:
        write_cycles(cycles, output, ends=ends)
    if plot is not None:
        _draw(cycles, sessions, plot, ends=ends, sides=sides is not None)
    if compare is not None:
        _compare(sessions, compare, ends=ends)
    if sides is not None:
        write_table(compare_sides(cycles, ends=ends), sides)


def _compare(sessions: list[Cycles], path: Path, *, ends: bool) -> None:
    """Write the changes from the first recording to the second, and curves beside them."""
    if len(sessions) < 2:
        raise ParameterError("two recordings with repetitions are needed to compare them")
    first, second = sessions
    if path.suffix.lower() in PAGES:
        from kineme.report.sessions import write_sessions

        write_sessions(first, second, path, ends=ends)
        return
    write_table(compare_sessions(first, second, ends=ends), path)
    curves = compare_curves(first, second, ends=ends)
    write_table(curves, path.with_suffix(f".curves{path.suffix}"))


def _choose_channels(
    recordings: list[Motion | Signals], names: list[str] | None
) -> list[str] | None:
    """Return the channels to measure, with foot contacts if all recordings have them."""
    stances = [[each.name for each in make_contact_channels(recording)] for recording in recordings]
    if min(map(len, stances)) < 2:
        return names
    chosen = names or [channel.name for channel in channels_of(recordings[0])]
    return [*chosen, *stances[0]]


def _drop_empty_plot(plot: Path | None, cycles: Cycles, *, ends: bool, alone: bool) -> Path | None:
    """Return the path of the plot, or None after a message if there are no mean curves to draw.

    Raise ParameterError if the plot is ``alone``, that is, the only result.
    """
    values = _tabulate_measures(cycles, ends=ends)
    if plot is None or any(values[group, "duration_s"][0] for group in cycles.groups):
        return plot
    advice = "exclude fewer" if ends else "--ends includes the first and last"
    reason = f"{plot}: no {'' if ends else 'inner '}repetitions to draw: {advice}"
    if alone:
        raise ParameterError(reason)
    print_skipped(reason)
    return None


def _draw(cycles: Cycles, sessions: list[Cycles], path: Path, *, ends: bool, sides: bool) -> None:
    """Draw one plot with axes per channel, per pair of sides, or per channel of two sessions."""
    from matplotlib.figure import Figure

    from kineme.plot import plot_curves, plot_sessions, plot_sides

    groups, pairs, channels = cycles.groups, pair_sides(cycles.channels), cycles.channels
    panels: list[tuple[Callable[..., Axes], tuple[Any, ...]]]
    if sides and pairs:
        panels = [(plot_sides, (cycles, *pair, group)) for pair in pairs for group in groups]
        columns = len(groups)
    elif len(sessions) == 2 and {*sessions[0].groups} & {*sessions[1].groups}:
        curves = compare_curves(*sessions, ends=ends)
        groups = list(dict.fromkeys(curves["group"].tolist()))
        panels = [(plot_sessions, (curves, name, group)) for name in channels for group in groups]
        columns = len(groups)
    else:
        panels, columns = [(plot_curves, (cycles, channel)) for channel in channels], 1
    if columns == 1 and len(panels) > AXES_PER_COLUMN:
        columns = 2
    rows = -(-len(panels) // columns)
    figure = Figure(figsize=(1.5 + 4.5 * columns, 1 + 2.5 * rows), layout="constrained")
    for number, (draw, arguments) in enumerate(panels, 1):
        axes = figure.add_subplot(rows, columns, number)
        if draw is plot_sessions:
            _, channel, group = arguments
            unit = cycles.units[channels.index(channel)]
            draw(*arguments, unit=unit, ax=axes)
            axes.set_title(group, loc="left", fontsize="medium")
            names = [str(each.columns["recording"][0]) for each in sessions]
            axes.legend(axes.lines[:2], names, frameon=False)
        else:
            draw(*arguments, ends=ends, ax=axes)
            if draw is plot_curves and number > 1 and (legend := axes.get_legend()):
                legend.remove()  # all axes have the same legend
    with atomic_write(path) as draft:
        figure.savefig(draft)


def _show(cycles: Cycles, sessions: list[Cycles], *, has_channels: bool, ends: bool) -> None:
    """Print a line per group (per session and group for two sessions), and the notes."""
    console = Console(highlight=False)
    channels = [*cycles.channels[:MAX_CHANNELS]]
    if not has_channels:
        channels = _choose_shown_channels(cycles, ends=ends)
    table, without_inner = _tabulate_groups(cycles, sessions, channels, ends=ends)
    console.print(table)
    inner = "inner repetitions: the first and last of each are left out"
    console.print(f"n, means: over {'all repetitions' if ends else inner}.")
    if len(cycles.channels) > len(channels) > 0:
        more = format_count(len(cycles.channels) - len(channels), "more channel")
        console.print(f"{more} measured: --output writes all, --channels chooses.")
    reasons = Counter(reason for reason in cycles.columns["excluded"].tolist() if reason)
    for reason, count in reasons.items():
        console.print(f"{format_count(count, 'cycle')} left out: {reason}.")
    if without_inner and not ends:
        groups = ", ".join(without_inner)
        console.print(f"{groups}: no inner repetitions; --ends includes the first and last.")
    for note in cycles.provenance["notes"]:
        console.print(Text(f"note: {note}", style="dim"), soft_wrap=not console.is_terminal)


def _tabulate_groups(
    cycles: Cycles, sessions: list[Cycles], channels: list[str], *, ends: bool
) -> tuple[Table, list[str]]:
    """Return the table of the groups, and the groups without inner repetitions."""
    units = dict(zip(cycles.channels, cycles.units, strict=True))
    ranges = [f"{name} range {units[name]}".strip() for name in channels]
    names = "label", "cycles", "n", "duration s", "sd", "cv %", "per min"
    table = make_table(*["recording"] * bool(sessions), *names, *ranges)
    without_inner: dict[str, None] = {}
    for session in sessions or [cycles]:
        values = _tabulate_measures(session, ends=ends)
        name = [str(session.columns["recording"][0])] if sessions else []
        for group in session.groups:
            n, mean, sd, cv = values[group, "duration_s"]
            per_min = values[group, "cadence_per_min"][1]
            cells = [f"{mean:.3f}", f"{sd:.3f}", f"{100 * cv:.1f}", f"{per_min:.1f}"]
            cells += [_format_mean(*values[group, f"{each}.range"][1:3]) for each in channels]
            count = int((session.columns["group"] == group).sum())
            head = group, str(count), str(n)
            table.add_row(*name, *head, *(_format_cell(cell) for cell in cells))
            if n == 0:
                without_inner[group] = None
    return table, [*without_inner]


def _tabulate_measures(
    cycles: Cycles, *, ends: bool
) -> dict[tuple[str, str], tuple[int, Any, Any, Any]]:
    """Return n, mean, standard deviation and coefficient of variation by group and measure."""
    summary = cycles.summary(ends=ends)
    rows = zip(
        *(summary[name].tolist() for name in ("group", "measure", "n", "mean", "sd", "cv")),
        strict=True,
    )
    return {(group, measure): (n, mean, sd, cv) for group, measure, n, mean, sd, cv in rows}


def _choose_shown_channels(cycles: Cycles, *, ends: bool) -> list[str]:
    """Return the channels to print: those with the largest range in a group, and their other side.

    Channels with different units cannot be compared; the first ones are printed then.
    """
    if len(set(cycles.units)) > 1:
        return [*cycles.channels[:MAX_CHANNELS]]
    values = _tabulate_measures(cycles, ends=ends)
    opposite = map_sides(cycles.channels)

    def find_range(channel: str) -> float:
        means = [values[group, f"{channel}.range"][1] for group in cycles.groups]
        return max((mean for mean in means if isfinite(mean)), default=0.0)

    by_range = sorted(cycles.channels, key=find_range, reverse=True)
    names = dict.fromkeys(side for name in by_range for side in (name, opposite.get(name, name)))
    return sorted([*names][:MAX_CHANNELS], key=cycles.channels.index)


def _format_mean(mean: float, sd: float) -> str:
    """Return mean ± standard deviation, with as many decimals as the mean needs."""
    if isfinite(mean) and mean and not PLAIN_RANGE[0] <= abs(mean) < PLAIN_RANGE[1]:
        return f"{mean:.4g} ± {sd:.2g}"
    digits = max(1, 2 - floor(log10(abs(mean)))) if isfinite(mean) and mean else 1
    return f"{mean:.{digits}f} ± {sd:.{digits}f}"


def _format_cell(cell: str) -> str:
    """Return a cell without missing numbers."""
    return "" if cell == "nan" else cell.replace(" ± nan", "").replace("nan", "")
