"""Segments, recordings and scores as tables for people, on a terminal, in a file or a pipe."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import isnan
from pathlib import Path
from typing import Any

from rich import box
from rich.columns import Columns
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from kineme.cli.terminal import Console
from kineme.segments.colors import get_cluster_color
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level, Segment

Section = tuple[str, Sequence[tuple[str, Sequence[str]]]]
"""A title, and rows: a name and the cells beside it."""

PER_CENT = "sure %"
OF_COUNTS = "sure %: how probable it is that the number of repetitions is right"
WORDS = ("kind", "cluster", "label", "recording", "example")
"""Columns that hold no numbers."""
_NOTHING_FOUND = (
    "no activity found: nothing stays similar or repeats for long enough; of a recording of a few "
    "seconds --set min_action=0.5 or --preset krueger2017 may tell more"
)


def show_facts(
    facts: Mapping[str, Any], lines: Mapping[str, object], *, below: RenderableType | None = None
) -> None:
    """Print what is known of a recording: its name, these lines, its notes, what goes below."""
    console = Console(highlight=False)
    grid = Table.grid(padding=(0, 2))
    rows = [*lines.items(), *(("note", note) for note in facts["notes"])]
    width = max(len(name) for name, _ in rows)
    for name, value in rows:
        grid.add_row(Text(name, style="dim"), Text(str(value)))
    console.print(Text(str(facts["path"]), style="bold"))
    if console.is_terminal:
        console.print(grid)
    else:  # of which the grid would fill every line up to the longest
        for name, value in rows:
            console.print(Text(f"{name:<{width}}  {value}"), soft_wrap=True)
    if below is not None:
        console.print(below)
    console.print()


def show_segments(
    segmentation: Segmentation,
    level: Level,
    *,
    written: Sequence[Path | None] = (),
    warned: Sequence[str] = (),
) -> None:
    """Print one row per segment of a level, a summary, the notes and the files written.

    Notes that were ``warned`` of before are not said again.
    """
    console = Console(highlight=False)
    source = segmentation.provenance["input"]["path"]
    console.print(
        Text.assemble(
            (Path(source).name, "bold"),
            f"  {segmentation.n_frames / segmentation.fps:.1f} s, {segmentation.n_frames} frames "
            f"at {segmentation.fps:g} Hz, {segmentation.provenance['preset']}",
        )
    )
    rows = _activity_rows if level == "activity" else _primitive_rows
    console.print(rows(segmentation))
    console.print(f"{segmentation.describe()}.")
    for note in segmentation.provenance["notes"]:
        if note not in warned:
            console.print(Text(f"note: {note}", style="dim"), soft_wrap=not console.is_terminal)
    if "activity" not in segmentation.activities.kind:
        console.print(Text(f"note: {_NOTHING_FOUND}", style="dim"))
    show_written(console, written)
    console.print()


def show_written(console: Console, paths: Iterable[Path | None]) -> None:
    """Print a line for each file that was written."""
    for path in filter(None, paths):
        console.print(Text(f"written: {path}"), soft_wrap=True)


def show_scores(title: str, columns: Mapping[str, Mapping[str, float]]) -> None:
    """Print scores by the columns that have them."""
    from kineme.evaluation.score import explain_disagreement, make_score_rows

    show_table(title, list(columns), make_score_rows(columns), note=explain_disagreement(columns))


def show_table(
    title: str, header: Sequence[str], sections: Sequence[Section], *, note: str = ""
) -> None:
    """Print a column of names, one column per title in the header, rows in sections, a note."""
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0))
    table.add_column("", no_wrap=True)
    for name in header:
        table.add_column(name, justify="right", overflow="fold")
    for section, rows in sections:
        if section:
            table.add_row(Text(section, style="bold"))
        for name, cells in rows:
            table.add_row(f"  {name}" if section else name, *cells)
    console = Console(highlight=False)
    console.print(Text(title, style="bold"))
    console.print(table)
    if note:
        console.print(Text(note, style="dim"))


def _activity_rows(segmentation: Segmentation) -> Table:
    """Activities and transitions with their repetitions counted."""
    from kineme.cycles.table import count_confidence

    table = new_table(
        "#",
        "kind",
        "start s",
        "stop s",
        "frames",
        "repetitions",
        PER_CENT,
        "cluster",
        "label",
    )
    primitives, captions = segmentation.primitives, []
    for number, row in enumerate(segmentation.activities):
        repeated = (primitives.activity == number) & (primitives.kind == "primitive")
        inside = primitives.cluster[repeated].tolist()
        count = _repetitions(inside, row.cluster) if row.kind == "activity" else ""
        probability = count_confidence(
            primitives.confidence[repeated], primitives.border_confidence[repeated]
        )
        cells = count, format_per_cent(probability), cluster_cell(row.cluster), row.label
        table.add_row(*_span(number, row), *cells, style=_style(row))
    if any("+" in str(cell) for cell in table.columns[5].cells):
        captions.append("(+n): primitives of the activity that are in other clusters, or in none")
    if keep_if_filled(table, PER_CENT):
        captions.append(OF_COUNTS)
    table.caption, table.caption_justify = "\n".join(captions) or None, "left"
    keep_if_filled(table, "label")
    return table


def format_per_cent(probability: float) -> str:
    """Return a probability in per cent; nothing where there is none."""
    return "" if isnan(probability) else f"{100 * probability:.0f}"


def _repetitions(clusters: list[int], main: int) -> str:
    """How many primitives are in the activity's cluster, else in the largest; how many are not."""
    if main not in clusters:
        # Most frequent of the clusters of its primitives.
        main = max(clusters, key=clusters.count, default=-1)
    count = clusters.count(main) if main >= 0 else 0
    others = len(clusters) - count
    return f"{count} (+{others})" if others else str(count)


def _primitive_rows(segmentation: Segmentation) -> Table:
    table = new_table("#", "kind", "start s", "stop s", "frames", "activity", "cluster", "label")
    for number, row in enumerate(segmentation.primitives):
        cells = str(row.activity), cluster_cell(row.cluster), row.label
        table.add_row(*_span(number, row), *cells, style=_style(row))
    keep_if_filled(table, "label")
    return table


def columns_of(names: Iterable[str]) -> RenderableType:
    """Names side by side; in a file or a pipe each on a line of its own."""
    texts = [Text(name) for name in names]
    on_terminal = Console().is_terminal
    return Columns(texts, padding=(0, 2), column_first=True) if on_terminal else Group(*texts)


def new_table(*names: str) -> Table:
    """Return a table with these columns: words to the left, numbers to the right."""
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for name in names:
        words = name in WORDS
        # Names that end in dots could be those of several recordings.
        table.add_column(name, justify="left" if words else "right", overflow="fold")
    return table


def keep_if_filled(table: Table, name: str) -> bool:
    """Leave out the column of this name if all of its cells are empty; whether it stays."""
    at = [column.header for column in table.columns].index(name)
    filled = any(table.columns[at].cells)
    if not filled:
        del table.columns[at]
    return filled


def _span(number: int, row: Segment) -> tuple[str, ...]:
    frames = f"{row.start_frame}:{row.stop_frame}"
    return str(number), row.kind, f"{row.start_s:.2f}", f"{row.stop_s:.2f}", frames


def cluster_cell(cluster: int) -> RenderableType:
    """Return a cluster with its colour; nothing for none."""
    return Text.assemble(("■ ", get_cluster_color(cluster)), str(cluster)) if cluster >= 0 else ""


def _style(row: Segment) -> str:
    return "dim" if row.kind == "transition" else ""
