"""``kineme cycles``: each repetition measured, summed up and as mean curves."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from math import floor, isfinite, log10
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple

import typer

from kineme._util.checks import format_count
from kineme.cli.help import OUTPUT, option
from kineme.cli.messages import Failures
from kineme.cli.options.declare import add_options
from kineme.cli.options.inputs import Batch, Files, Recursive, SegmentTable
from kineme.cli.options.method import SEGMENTING
from kineme.cli.options.reading import EVERYTHING, READING, Quiet
from kineme.cli.segment import read_and_segment
from kineme.errors import ParameterError
from kineme.formats import read_analog
from kineme.formats.options import ReadOptions
from kineme.methods.segmenter import SegmentOptions

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from kineme.cycles import Cycles
    from kineme.recordings import Motion, Signals
    from kineme.segments.segmentation import Segmentation

MEASURED = "Measured"
FAR, UNSURE = "far", "unsure"
SHOWN = 4
"""Channels whose ranges are shown."""
PLAIN = 1e-3, 1e5
"""From where to where numbers are told without a power of ten."""
IN_A_COLUMN = 4
"""Axes of a picture, one below the other; of more there are two columns, left beside right."""


@add_options(READING | SEGMENTING)
def cycles(
    files: Files,
    read_options: ReadOptions,
    segment_options: SegmentOptions,
    output: Annotated[
        Path | None,
        option(
            OUTPUT,
            "Write cycles, summary and curves: .xlsx, .csv, .parquet, .mat or .nc.",
            "--output",
            "-o",
        ),
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
            MEASURED,
            "What to measure, as in knee_*,trunk_lean; see kineme info --channels.",
            metavar="NAME,NAME,…",
        ),
    ] = None,
    anchor: Annotated[
        str | None,
        option(
            MEASURED,
            'Where a cycle begins: "knee_r max", "knee_r > 40", left_foot_strike, '
            "or an event of the file; by default at equal phase.",
            metavar="EVENT",
        ),
    ] = None,
    align: Annotated[
        Literal["linear", "landmarks", "warp"],
        option(
            MEASURED,
            "Bring curves in step: linear, landmarks or warp.",
            metavar="HOW",
            show_default=False,
        ),
    ] = "linear",
    exclude: Annotated[
        list[str] | None,
        option(
            MEASURED,
            "Leave a row out of means by its number, or all far from the mean (far), or of "
            "uncertain start (unsure).",
            metavar="ROW|RULE",
        ),
    ] = None,
    ends: Annotated[
        bool, option(MEASURED, "Count first and last repetitions, too.", "--ends")
    ] = False,
    common: Annotated[
        bool, option(MEASURED, "Tables (--segments) number their clusters in common.", "--common")
    ] = False,
    segments: SegmentTable = None,
    recursive: Recursive = False,
    quiet: Quiet = False,
) -> None:
    """Measure each repetition: duration, ranges, mean curves.

    Borders are moved to equal phase. Several recordings are measured together.
    """
    from kineme.cli.tables import show_written
    from kineme.cli.terminal import Console
    from kineme.cycles import channels_of, compare_sides, write_cycles, write_table
    from kineme.cycles.measure import cycles as measured

    batch = Batch(files, recursive=recursive, quiet=quiet)
    names = None if channels is None else [name.strip() for name in channels.split(",")]
    _check_targets(output, plot, compare, sides)
    if compare is not None and len(batch.paths) != 2 and read_options.person != EVERYTHING:
        raise typer.BadParameter("takes two recordings", param_hint="--compare")
    if common and segments is None:
        reason = "is for tables whose clusters have numbers in common: give them with --segments"
        raise typer.BadParameter(reason, param_hint="--common")
    parts: list[_Part] = []
    batch.tables("--segments", segments)  # whether there are any

    def read_one(path: Path, options: ReadOptions, table: Path | None) -> None:
        with batch.progress(path) as stage:
            part = read_and_segment(path, options, table, segment_options, stage)
            found = channels_of(part[0], names) if len(batch.paths) > 1 else ()
            parts.append(_Part(path, *part, tuple(channel.name for channel in found)))

    for path in batch.paths:
        batch.each_person(path, read_options, read_one, tables=("--segments", segments))
    parts = _keep_common_channels(parts, batch)
    recordings, tables = [each.recording for each in parts], [each.segments for each in parts]
    failures = Failures()
    if recordings:
        with failures.caught(""):
            analog = _read_analog_channels(batch.paths, recordings, read_options) if names else []
            if sides is not None:
                names = _choose_channels(recordings, names)
            found = measured(
                recordings, tables, channels=names, anchor=anchor, beside=analog, common=common,
                align=align,
            )  # fmt: skip
            found = _exclude_cycles(found, exclude or [])
            # The cycles of each recording that has some.
            owners = found.columns["recording"]
            named = dict.fromkeys(owners.tolist()) if compare is not None else ()
            sessions = [found.select(owners == name) for name in named]
            if output is not None:
                write_cycles(found, output, ends=ends)
            if plot is not None:
                _draw(found, sessions, plot, ends=ends, sides=sides is not None)
            if compare is not None:
                _compare(sessions, compare, ends=ends)
            if sides is not None:
                write_table(compare_sides(found, ends=ends), sides)
            if not quiet:
                chosen, given = channels is not None, segments is not None
                _show(found, sessions, chosen=chosen, ends=ends, given=given)
                show_written(Console(highlight=False), [output, plot, compare, sides])
    batch.exit()
    failures.exit()


class _Part(NamedTuple):
    path: Path
    recording: Motion | Signals
    segments: Segmentation
    channels: tuple[str, ...]


def _keep_common_channels(parts: list[_Part], batch: Batch) -> list[_Part]:
    """Those that have the channels that most have; the others are left out, and this is said."""
    counts = Counter(each.channels for each in parts)
    most = counts.most_common(1)[0][0] if counts else ()
    for each in parts:
        if each.channels != most:
            other = ", ".join(sorted({*most} ^ {*each.channels})[:4])
            reason = f"does not have the channels of the others ({other}): choose with --channels"
            batch.leave_out(each.path, reason)
    return [each for each in parts if each.channels == most]


def _read_analog_channels(
    paths: list[Path], recordings: list[Motion | Signals], options: ReadOptions
) -> list[Signals]:
    """Channels in the file of a single body, such as force plates, which may be measured, too."""
    from kineme.recordings import Motion

    if len(paths) > 1 or not isinstance(recordings[0], Motion):
        return []
    signals = read_analog(paths[0], options)
    return [] if signals is None else [signals]


def _check_targets(
    output: Path | None, plot: Path | None, compare: Path | None, sides: Path | None
) -> None:
    """typer.BadParameter for a file that could not be written, before any work is done."""
    from kineme.cli.options.targets import PICTURES
    from kineme.cycles.export import SUFFIXES
    from kineme.report.page import SUFFIXES as PAGES

    for name, path, suffixes in (
        ("--output", output, SUFFIXES),
        ("--plot", plot, PICTURES),
        ("--compare", compare, (".csv", ".parquet", *PAGES)),
        ("--sides", sides, (".csv", ".parquet")),
    ):
        if path is not None and path.suffix.lower() not in suffixes:
            raise typer.BadParameter(f"{path} must end in {', '.join(suffixes)}", param_hint=name)


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
                    f"{rule!r} is no row and no rule: give a number, {FAR} or {UNSURE}",
                    param_hint="--exclude",
                ) from None
            cycles = cycles.exclude(rows)
    return cycles


def _compare(sessions: list[Cycles], path: Path, *, ends: bool) -> None:
    """Write what changed from the first recording to the second: numbers, curves beside them."""
    from kineme.cycles import compare_curves, compare_sessions, write_table
    from kineme.report.page import SUFFIXES as PAGES
    from kineme.report.sessions import write_sessions

    if len(sessions) < 2:
        raise ParameterError("there are no repetitions in both recordings to compare")
    first, second = sessions
    if path.suffix.lower() in PAGES:
        write_sessions(first, second, path, ends=ends)
        return
    write_table(compare_sessions(first, second, ends=ends), path)
    curves = compare_curves(first, second, ends=ends)
    write_table(curves, path.with_suffix(f".curves{path.suffix}"))


def _choose_channels(
    recordings: list[Motion | Signals], names: list[str] | None
) -> list[str] | None:
    """Return the channels to measure, and when each foot stands if all recordings tell it."""
    from kineme.cycles.channels import channels_of, make_contact_channels

    stances = [[each.name for each in make_contact_channels(recording)] for recording in recordings]
    if min(map(len, stances)) < 2:
        return names
    chosen = names or [channel.name for channel in channels_of(recordings[0])]
    return [*chosen, *stances[0]]


def _draw(cycles: Cycles, sessions: list[Cycles], path: Path, *, ends: bool, sides: bool) -> None:
    """One picture: axes for each channel, for each of a pair of sides, or for two sessions."""
    from matplotlib.figure import Figure

    from kineme._util.files import atomic_write
    from kineme.cycles import compare_curves
    from kineme.cycles.comparison import pair_sides
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
    if columns == 1 and len(panels) > IN_A_COLUMN:
        columns = 2
    rows = -(-len(panels) // columns)
    figure = Figure(figsize=(1.5 + 4.5 * columns, 1 + 2.5 * rows), layout="constrained")
    for number, (draw, what) in enumerate(panels, 1):
        axes = figure.add_subplot(rows, columns, number)
        if draw is plot_sessions:
            _, channel, group = what
            unit = cycles.units[channels.index(channel)]
            draw(*what, unit=unit, ax=axes)
            axes.set_title(group, loc="left", fontsize="medium")
            names = [str(each.columns["recording"][0]) for each in sessions]
            axes.legend(axes.lines[:2], names, frameon=False)
        else:
            draw(*what, ends=ends, ax=axes)
            if draw is plot_curves and number > 1 and (legend := axes.get_legend()):
                legend.remove()  # all have that of the first
    with atomic_write(path) as draft:
        figure.savefig(draft)


def _show(cycles: Cycles, sessions: list[Cycles], *, chosen: bool, ends: bool, given: bool) -> None:
    """Print a line for each group, of two sessions for each of both, and the notes."""
    from rich.text import Text

    from kineme.cli.tables import OF_COUNTS, PER_CENT, format_per_cent, keep_if_filled, make_table
    from kineme.cli.terminal import Console

    console = Console(highlight=False)
    shown = cycles.channels[:SHOWN] if chosen else _choose_shown_channels(cycles, ends=ends)
    units = dict(zip(cycles.channels, cycles.units, strict=True))
    ranges = [f"{name} range {units[name]}".strip() for name in shown]
    first = ["recording"] if sessions else []
    names = "label", "cycles", PER_CENT, "n", "duration s", "sd", "cv %", "per min"
    table = make_table(*first, *names, *ranges)
    without: list[str] = []
    for each in sessions or [cycles]:
        values = _tabulate_measures(each, ends=ends)
        name = [str(each.columns["recording"][0])] if sessions else []
        for group in each.groups:
            n, mean, sd, cv = values[group, "duration_s"]
            per_min = values[group, "cadence_per_min"][1]
            cells = [f"{mean:.3f}", f"{sd:.3f}", f"{100 * cv:.1f}", f"{per_min:.1f}"]
            cells += [_format_mean(*values[group, f"{channel}.range"][1:3]) for channel in shown]
            count = int((each.columns["group"] == group).sum())
            head = group, str(count), format_per_cent(each.count_confidence(group)), str(n)
            table.add_row(*name, *head, *(_format_cell(cell) for cell in cells))
            if n == 0:
                without.append(group)
    probable = keep_if_filled(table, PER_CENT)
    console.print(table)
    if probable:
        console.print(f"{OF_COUNTS}, of the least sure activity.")
    of = "all repetitions" if ends else "inner repetitions: the first and last of each are left out"
    console.print(f"n, means: over {of}.")
    if len(cycles.channels) > len(shown) > 0:
        more = format_count(len(cycles.channels) - len(shown), "more channel")
        console.print(f"{more} measured: --output writes all, --channels chooses.")
    reasons = [reason for reason in cycles.columns["excluded"].tolist() if reason]
    for reason in dict.fromkeys(reasons):
        console.print(f"{format_count(reasons.count(reason), 'cycle')} left out: {reason}.")
    if without and not ends:
        groups = ", ".join(dict.fromkeys(without))
        console.print(f"{groups}: no inner repetition; --ends counts the others.")
    if len(cycles) == 0:
        why = "the segments given have no primitives" if given else "nothing repeats itself here"
        console.print(f"no repetition: {why}.")
    for note in cycles.provenance["notes"]:
        console.print(Text(f"note: {note}", style="dim"), soft_wrap=not console.is_terminal)


def _tabulate_measures(
    cycles: Cycles, *, ends: bool
) -> dict[tuple[str, str], tuple[int, Any, Any, Any]]:
    """Number, mean, deviation and its share of the mean, of each group and measure."""
    summary = cycles.summary(ends=ends)
    rows = zip(
        *(summary[name].tolist() for name in ("group", "measure", "n", "mean", "sd", "cv")),
        strict=True,
    )
    return {(group, measure): (n, mean, sd, cv) for group, measure, n, mean, sd, cv in rows}


def _choose_shown_channels(cycles: Cycles, *, ends: bool) -> list[str]:
    """Return the channels to show: those that go farthest in a group, with the other side of each.

    Of several units, which cannot be compared, the first ones.
    """
    from kineme.cycles.comparison import pair_sides

    if len(set(cycles.units)) > 1:
        return [*cycles.channels[:SHOWN]]
    values = _tabulate_measures(cycles, ends=ends)
    pairs = pair_sides(cycles.channels)
    opposite = dict(pairs) | {right: left for left, right in pairs}

    def extent(channel: str) -> float:
        means = [values[group, f"{channel}.range"][1] for group in cycles.groups]
        return max((mean for mean in means if isfinite(mean)), default=0.0)

    farthest = sorted(cycles.channels, key=extent, reverse=True)
    names = dict.fromkeys(side for name in farthest for side in (name, opposite.get(name, name)))
    return sorted([*names][:SHOWN], key=cycles.channels.index)


def _format_mean(mean: float, sd: float) -> str:
    """Both with as many digits after the point as the mean is told with."""
    if isfinite(mean) and mean and not PLAIN[0] <= abs(mean) < PLAIN[1]:
        return f"{mean:.4g} ± {sd:.2g}"
    digits = max(1, 2 - floor(log10(abs(mean)))) if isfinite(mean) and mean else 1
    return f"{mean:.{digits}f} ± {sd:.{digits}f}"


def _format_cell(cell: str) -> str:
    """Return a cell; nothing where there is no number to tell."""
    return "" if cell == "nan" else cell.replace(" ± nan", "").replace("nan", "")
