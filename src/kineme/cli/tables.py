"""Print segments, recordings and scores as tables, on a terminal or to a file."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from rich import box
from rich.columns import Columns
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from kineme.cli.terminal import Console
from kineme.segments.display import get_cluster_color
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level, Segment

Section = tuple[str, Sequence[tuple[str, Sequence[str]]]]
"""Title and rows; a row is a name and its cells."""

TEXT_COLUMNS = ("kind", "cluster", "label", "recording", "example")
"""Columns without numbers, aligned left."""
_NOTHING_FOUND = (
    "no activity found: nothing repeats or stays similar for long enough. For a recording "
    "of a few seconds, try --set min_action=0.5 or --preset krueger2017"
)


def show_facts(
    facts: Mapping[str, Any], lines: Mapping[str, object], *, below: RenderableType | None = None
) -> None:
    """Print facts about a recording: its path, these lines, its notes, and ``below``."""
    console = Console(highlight=False)
    grid = Table.grid(padding=(0, 2))
    rows = [*lines.items(), *(("note", note) for note in facts["notes"])]
    width = max(len(name) for name, _ in rows)
    for name, value in rows:
        grid.add_row(Text(name, style="dim"), Text(str(value)))
    console.print(Text(str(facts["path"]), style="bold"))
    if console.is_terminal:
        console.print(grid)
    else:  # the grid would pad every line to the longest
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
    """Print one row per segment of a level, a summary, the notes and the written files.

    Notes in ``warned`` were printed before and are skipped.
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
    rows = _tabulate_activities if level == "activity" else _tabulate_primitives
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
    """Print rows in sections, with a column of names and one column per entry of the header."""
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


def _tabulate_activities(segmentation: Segmentation) -> Table:
    """Return a table of activities and transitions with their number of repetitions."""
    names = "#", "kind", "start s", "stop s", "frames", "repetitions", "cluster", "label"
    table = make_table(*names)
    primitives = segmentation.primitives
    for number, row in enumerate(segmentation.activities):
        repeated = (primitives.activity == number) & (primitives.kind == "primitive")
        inside = primitives.cluster[repeated].tolist()
        count = _format_repetitions(inside, row.cluster) if row.kind == "activity" else ""
        cells = count, format_cluster(row.cluster), row.label
        table.add_row(*_format_span(number, row), *cells, style=_choose_style(row))
    if any("+" in str(cell) for cell in table.columns[5].cells):
        table.caption = "(+n): primitives of the activity in other clusters or in none"
        table.caption_justify = "left"
    remove_if_empty(table, "label")
    return table


def _format_repetitions(clusters: list[int], main: int) -> str:
    """Return the number of primitives in the main cluster, and of others as "(+n)"."""
    if main not in clusters:
        # Take the most frequent cluster of the primitives.
        main = max(clusters, key=clusters.count, default=-1)
    count = clusters.count(main) if main >= 0 else 0
    others = len(clusters) - count
    return f"{count} (+{others})" if others else str(count)


def _tabulate_primitives(segmentation: Segmentation) -> Table:
    table = make_table("#", "kind", "start s", "stop s", "frames", "activity", "cluster", "label")
    for number, row in enumerate(segmentation.primitives):
        cells = str(row.activity), format_cluster(row.cluster), row.label
        table.add_row(*_format_span(number, row), *cells, style=_choose_style(row))
    remove_if_empty(table, "label")
    return table


def make_columns(names: Iterable[str]) -> RenderableType:
    """Return names side by side on a terminal, else one per line."""
    texts = [Text(name) for name in names]
    on_terminal = Console().is_terminal
    return Columns(texts, padding=(0, 2), column_first=True) if on_terminal else Group(*texts)


def make_table(*names: str) -> Table:
    """Return an empty table with these columns: text aligned left, numbers right."""
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for name in names:
        is_text = name in TEXT_COLUMNS
        # Fold instead of truncating: truncated names of recordings could be ambiguous.
        table.add_column(name, justify="left" if is_text else "right", overflow="fold")
    return table


def remove_if_empty(table: Table, name: str) -> None:
    """Remove the column with this name if all its cells are empty."""
    index = [column.header for column in table.columns].index(name)
    if not any(table.columns[index].cells):
        del table.columns[index]


def _format_span(number: int, row: Segment) -> tuple[str, ...]:
    frames = f"{row.start_frame}:{row.stop_frame}"
    return str(number), row.kind, f"{row.start_s:.2f}", f"{row.stop_s:.2f}", frames


def format_cluster(cluster: int) -> RenderableType:
    """Return a cluster number in its colour; empty for none."""
    return Text.assemble(("■ ", get_cluster_color(cluster)), str(cluster)) if cluster >= 0 else ""


def _choose_style(row: Segment) -> str:
    return "dim" if row.kind == "transition" else ""
