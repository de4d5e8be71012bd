"""Compare two sessions on one sheet of paper: what changed, with confidence bounds.

The numbers come from `kineme.cycles.compare_sessions`, `kineme.cycles.compare_curves` and
`kineme.cycles.compare_sides`. The sheet shows the groups with most repetitions and the channels
with the clearest changes, and states what it leaves out.
"""

from __future__ import annotations

from base64 import b64encode
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from io import BytesIO
from math import floor, log10
from os import PathLike
from pathlib import Path

import numpy as np

from kineme._util.checks import check_path, format_count
from kineme._util.files import PAGES, atomic_write
from kineme._version import __version__
from kineme.cycles import Cycles, compare_curves, compare_sessions, compare_sides
from kineme.cycles.table import Columns
from kineme.errors import WriteError
from kineme.plot.curves import FIRST, SECOND, plot_sessions

MAX_GROUPS = 4
"""Groups on a sheet."""
MAX_LINES = {1: 26, 2: 26, 3: 28, 4: 31}
"""Lines of all tables by the number of groups; more groups leave less room for pictures."""
HEADER_LINES = 3
"""Lines that a table needs above its first row."""
MAX_PANELS = {1: 6, 2: 3, 3: 3, 4: 3}
"""Pictures by the number of groups."""
MAX_PAIRS = {1: 6, 2: 5, 3: 4, 4: 4}
"""Pairs of left and right channels by the number of groups."""
TIMES = ("duration_s", "cadence_per_min")
"""Measures at the top of each table."""
MEASURE_NAMES = {"duration_s": "duration (s)", "cadence_per_min": "repetitions per minute"}
MISSING = "–"
EXPLANATION = (
    "Differences are the second session minus the first. Their bounds contain the true difference "
    "with 95 % confidence (Welch's t), for each number separately: about one in twenty unchanged "
    "numbers will appear changed."
)
STYLE = """
@page { size: A4; margin: 11mm 13mm; }
body { max-width: 184mm; margin: 0 auto; padding: 4mm; color: #1b1f27; background: #fff;
  font: 9pt/1.35 system-ui, "Segoe UI", Helvetica, Arial, sans-serif; }
@media print { body { padding: 0; } }
h1 { margin: 0; font-size: 15pt; }
h2 { margin: 3.5mm 0 1mm; font-size: 10.5pt; }
p { margin: 0.8mm 0; }
.quiet { color: #59606b; font-size: 8pt; }
table { width: 100%; table-layout: fixed; border-collapse: collapse;
  font-variant-numeric: tabular-nums; }
th { font-weight: 600; text-align: right; border-bottom: 0.4pt solid #888; }
th:first-child, td:first-child { text-align: left; width: 25%; }
td { text-align: right; border-bottom: 0.3pt solid #ddd; }
th, td { padding: 0.35mm 1mm; overflow: hidden; white-space: nowrap; text-overflow: ellipsis; }
.clear td:last-child { font-weight: 600; }
.curves { display: grid; grid-template-columns: repeat(3, 1fr); gap: 1mm 3mm; }
figure { margin: 0; }
figcaption { overflow: hidden; white-space: nowrap; text-overflow: ellipsis; font-size: 8pt; }
img { display: block; width: 100%; }
i { display: inline-block; width: 8mm; margin: 0 1mm 0.8mm 4mm; border-top: 1.4pt solid; }
section, figure, table { break-inside: avoid; }
"""


@dataclass(frozen=True)
class Sheet:
    """Two sessions and their comparison."""

    names: tuple[str, str]
    sessions: tuple[Cycles, Cycles]
    numbers: Columns
    curves: Columns
    sides: tuple[Columns, Columns]
    ends: bool


def write_sessions(
    first: Cycles,
    second: Cycles,
    path: str | PathLike[str],
    *,
    names: tuple[str, str] | None = None,
    ends: bool = False,
) -> None:
    """Write a page (.html) that compares two sessions and prints on one sheet.

    ``names`` are the titles of the sessions, by default their recordings. With ``ends`` the first
    and last cycle of an activity count as well. ParameterError if the sessions cannot be compared.
    """
    check_path(path, "write_sessions")
    if Path(path).suffix.lower() not in PAGES:
        raise WriteError(path, f"a page is written as {', '.join(PAGES)}")
    sheet = Sheet(
        names or (_choose_name(first), _choose_name(second)),
        (first, second),
        numbers=compare_sessions(first, second, ends=ends),
        curves=compare_curves(first, second, ends=ends),
        sides=(compare_sides(first, ends=ends), compare_sides(second, ends=ends)),
        ends=ends,
    )
    with atomic_write(path) as draft:
        draft.write_text(_format_page(sheet), encoding="utf-8")


def _choose_name(cycles: Cycles) -> str:
    names = list(dict.fromkeys(cycles.columns["recording"].tolist()))
    return names[0] if len(names) == 1 else format_count(len(names), "recording")


def _format_page(sheet: Sheet) -> str:
    """Return the page: numbers, pictures and sides of as many groups as fit."""
    first, second = (escape(name) for name in sheet.names)
    groups = _list_groups(sheet)
    shown_groups = groups[:MAX_GROUPS]
    # Lines of each group's table, without its header and the durations.
    n_channels = MAX_LINES[len(shown_groups)] // len(shown_groups) - HEADER_LINES - len(TIMES)
    channels = {group: _sort_channels(sheet, group)[:n_channels] for group in shown_groups}
    body = [
        f"<h1>{first} → {second}</h1>",
        f'<p class="quiet">{_format_caption(sheet)}. {EXPLANATION}</p>',
        *(_format_numbers(sheet, group, channels[group]) for group in shown_groups),
        _format_pictures(sheet, _list_panels(channels)[: MAX_PANELS[len(shown_groups)]]),
        _format_sides(sheet, shown_groups),
        f'<p class="quiet">{escape(_format_footer(sheet, groups, n_channels))}</p>',
    ]
    return (
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8" />\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1" />\n'
        '<meta http-equiv="Content-Security-Policy" '
        "content=\"default-src 'none'; img-src data:; style-src 'unsafe-inline'\" />\n"
        f"<title>{first} → {second}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n"
        + "\n".join(part for part in body if part)
        + "\n</body>\n</html>\n"
    )


def _format_caption(sheet: Sheet) -> str:
    """Return what the numbers are, and how many repetitions of each session are left out."""
    kind = "all repetitions" if sheet.ends else "inner repetitions, without first and last ones"
    left_out = "".join(
        f"; {format_count(count, 'repetition')} of {escape(name)} left out ({escape(reason)})"
        for name, cycles in zip(sheet.names, sheet.sessions, strict=True)
        for reason, count in Counter(cycles.columns["excluded"].tolist()).items()
        if reason
    )
    return f"Means ± standard deviations of {kind}{left_out}"


def _list_groups(sheet: Sheet) -> list[str]:
    """Return the groups that both sessions have, those with most repetitions first."""
    groups = list(dict.fromkeys(sheet.numbers["group"].tolist()))
    # The session with fewer repetitions limits the comparison.
    return sorted(
        groups, key=lambda group: -min(_count_cycles(cycles, group) for cycles in sheet.sessions)
    )


def _count_cycles(cycles: Cycles, group: str) -> int:
    return int((cycles.columns["group"] == group).sum())


def _find_row(sheet: Sheet, group: str, measure: str) -> dict[str, float]:
    numbers = sheet.numbers
    at = np.flatnonzero((numbers["group"] == group) & (numbers["measure"] == measure))[0]
    return {name: float(column[at]) for name, column in numbers.items()
            if name not in ("group", "measure")}  # fmt: skip


def _sort_channels(sheet: Sheet, group: str) -> list[str]:
    """Return the channels, sorted by how clearly their range changed."""

    def measure_clarity(channel: str) -> float:
        row = _find_row(sheet, group, f"{channel}.range")
        width = row["high"] - row["low"]
        # The difference relative to the width of its confidence interval.
        return abs(row["difference"]) / width if width > 0 else -1.0

    return sorted(sheet.sessions[0].channels, key=measure_clarity, reverse=True)


def _format_numbers(sheet: Sheet, group: str, channels: Sequence[str]) -> str:
    """Return a table of the changes in a group."""
    units = dict(zip(sheet.sessions[0].channels, sheet.sessions[0].units, strict=True))
    labels = MEASURE_NAMES | {
        f"{channel}.range": f"{channel} range{f' ({unit})' if (unit := units[channel]) else ''}"
        for channel in channels
    }
    lines = []
    for measure, label in labels.items():
        row = _find_row(sheet, group, measure)
        # The confidence interval excludes 0; False if the bounds are nan.
        clear = row["low"] > 0 or row["high"] < 0
        verdict = ("more" if row["difference"] > 0 else "less") if clear else "not clear"
        digits = _choose_digits(row["first_mean"], row["second_mean"])
        text = {name: _format_number(value, digits) for name, value in row.items()}
        bounds = f"{text['low']} to {text['high']}"
        cells = [
            label,
            *(f"{text[f'{session}_mean']} ± {text[f'{session}_sd']}"
              for session in ("first", "second")),
            text["difference"],
            bounds if np.isfinite(row["low"]) else MISSING,
            verdict if np.isfinite(row["low"]) else "too few",
        ]  # fmt: skip
        lines.append(f"<tr{' class=clear' if clear else ''}>{_format_cells(cells)}</tr>")
    heads = ["", *sheet.names, "difference", "95 %", "changed"]
    counts = " → ".join(str(_count_cycles(cycles, group)) for cycles in sheet.sessions)
    duration = _find_row(sheet, group, "duration_s")
    used = " and ".join(f"{duration[f'{session}_n']:.0f}" for session in ("first", "second"))
    return (
        f'<section><h2>{escape(group)}: {counts} repetitions <span class="quiet">(means of {used})'
        f"</span></h2>\n<table><tr>{_format_cells(heads, 'th')}</tr>\n" + "\n".join(lines)
        + "</table></section>"
    )  # fmt: skip


def _list_panels(channels: dict[str, list[str]]) -> list[tuple[str, str]]:
    """Return group and channel of each picture: the clearest change of each group first."""
    # Take turns: every group gets a first panel before any gets a second.
    columns = ([(group, name) for name in names] for group, names in channels.items())
    return [panel for turn in zip(*columns, strict=True) for panel in turn]


def _format_pictures(sheet: Sheet, panels: Sequence[tuple[str, str]]) -> str:
    """Return the mean curves of both sessions as pictures."""
    units = dict(zip(sheet.sessions[0].channels, sheet.sessions[0].units, strict=True))
    several = len({group for group, _ in panels}) > 1
    figures = []
    for group, channel in panels:
        unit = f" ({units[channel]})" if units[channel] else ""
        caption = escape(f"{group}: {channel}{unit}" if several else f"{channel}{unit}")
        picture = b64encode(_draw_picture(sheet.curves, group, channel)).decode("ascii")
        figures.append(
            f"<figure><figcaption>{caption}</figcaption>"
            f'<img alt="Mean curves of {caption}" src="data:image/svg+xml;base64,{picture}" />'
            "</figure>"
        )
    first, second = (escape(name) for name in sheet.names)
    return (
        f'<p><i style="color: {FIRST}; border-top-style: dashed"></i>{first}'
        f'<i style="color: {SECOND}"></i>{second}</p>\n<div class="curves">\n'
        + "\n".join(figures)
        + '\n</div>\n<p class="quiet">Mean ± standard deviation over the cycle, in per cent. A bar '
        "below marks where the bounds of the difference exclude 0.</p>"
    )


def _draw_picture(curves: Columns, group: str, channel: str) -> bytes:
    """Return an SVG without axis labels, which the page shows as text."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    output = BytesIO()
    # A fixed salt and no date make the output reproducible.
    with mpl.rc_context({"font.size": 7, "svg.hashsalt": "kineme"}):
        figure = Figure(figsize=(2.4, 1.4), layout="constrained")
        axes = plot_sessions(curves, channel, group, ax=figure.add_subplot())
        axes.set(xlabel="", ylabel="", xticks=[0, 25, 50, 75, 100])
        axes.spines[["top", "right"]].set_visible(False)
        figure.savefig(output, format="svg", metadata={"Date": None})
    return output.getvalue()


def _format_sides(sheet: Sheet, groups: Sequence[str]) -> str:
    """Return a table of left and right ranges in both sessions, if channels have sides."""
    first, second = (_collect_ranges(columns) for columns in sheet.sides)
    keys = [key for key in first if key in second and key[0] in groups]
    if not keys:
        return ""
    pairs = list(dict.fromkeys(key[1:] for key in keys))
    # Sort by pair of channels; each pair lists all groups.
    keys = sorted(keys, key=lambda key: pairs.index(key[1:]))[: MAX_PAIRS[len(groups)]]
    lines = []
    for key in keys:
        group, left, right = key
        cells = [f"{group}: {left}, {right}"]
        for left_range, right_range, index in (first[key], second[key]):
            digits = _choose_digits(left_range, right_range)
            cells += [
                _format_number(left_range, digits),
                _format_number(right_range, digits),
                _format_number(index, 1),
            ]
        lines.append(f"<tr>{_format_cells(cells)}</tr>")
    names = "".join(f'<th colspan="3">{escape(name)}</th>' for name in sheet.names)
    heads = ["mean range", *2 * ["left", "right", "index (%)"]]
    return (
        f"<section><h2>Left beside right</h2>\n<table><tr><th></th>{names}</tr>\n"
        f"<tr>{_format_cells(heads, 'th')}</tr>\n"
        + "\n".join(lines)
        + '</table>\n<p class="quiet">Symmetry index: the difference of left and right in per '
        "cent of their mean; 0 where they are equal. All pairs: --sides NAME.csv.</p></section>"
    )


def _collect_ranges(sides: Columns) -> dict[tuple[str, str, str], tuple[float, float, float]]:
    """Return ranges and symmetry index by group, left channel and right channel."""
    keys, values = (
        zip(*(sides[name][sides["measure"] == "range"].tolist() for name in names), strict=True)
        for names in (("group", "left_channel", "right_channel"),
                      ("left", "right", "symmetry_index"))
    )  # fmt: skip
    return dict(zip(keys, values, strict=True))


def _format_footer(sheet: Sheet, groups: Sequence[str], n_channels: int) -> str:
    """Return what the sheet leaves out, and the version of kineme."""
    channels = len(sheet.sessions[0].channels)
    omitted = []
    if len(groups) > MAX_GROUPS:
        omitted.append(f"{format_count(len(groups) - MAX_GROUPS, 'group')} with fewer repetitions")
    if channels > n_channels:
        omitted.append(f"{format_count(channels - n_channels, 'channel')} with less clear changes")
    more = f"Not shown: {', '.join(omitted)}; a table has them (--compare NAME.csv). "
    return f"{more if omitted else ''}Made by kineme {__version__}."


def _format_cells(texts: Sequence[str], tag: str = "td") -> str:
    return "".join(f"<{tag}>{escape(text)}</{tag}>" for text in texts)


def _choose_digits(*values: float) -> int:
    """Return the number of decimals for numbers of this size."""
    size = max((abs(value) for value in values if np.isfinite(value)), default=0.0)
    # Three significant digits of the largest number, at least one decimal.
    return max(1, 2 - floor(log10(size))) if size > 0 else 1


def _format_number(value: float, digits: int) -> str:
    if not np.isfinite(value):
        return MISSING
    text = f"{value:.{digits}f}"
    # No minus sign for a number that rounds to 0.
    return text.removeprefix("-") if float(text) == 0 else text.replace("-", "\N{MINUS SIGN}")
