"""Scores as tables: in which order, under which names, and as JSON, CSV or Markdown.

nan, which a score is where it cannot be had, is empty in CSV and Markdown and
null in JSON.
"""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol

from kineme._util.files import atomic_write
from kineme._version import __version__
from kineme.errors import WriteError
from kineme.evaluation.score import scores
from kineme.formats.delimited import as_text

OUTPUTS = (".json", ".csv")
DISAGREEMENT = 0.2
"""Border F1 above Edit by more than this is explained under the table."""
COST = {"seconds": "seconds", "seconds_per_hour": "seconds per hour"}
"""What a result cost: no score, but shown below them."""


def score_rows(
    columns: Mapping[str, Mapping[str, float]],
) -> list[tuple[str, list[tuple[str, list[str]]]]]:
    """Groups of rows ready to print: a group's title, and per row its name and cells.

    ``columns`` are scores by column title; those that are a number in none are left out.
    """
    titles: dict[str, dict[str, str]] = {}
    for name, score in scores().items():
        titles.setdefault(score.level, {})[name] = score.title
    groups = []
    for group, names in {**titles, "cost": COST}.items():
        rows = [
            (title, [format_score(values.get(name, math.nan)) for values in columns.values()])
            for name, title in names.items()
            if any(math.isfinite(values.get(name, math.nan)) for values in columns.values())
        ]
        if rows:
            groups.append((group, rows))
    return groups


def explain_disagreement(columns: Mapping[str, Mapping[str, float]]) -> str:
    """Return why scores of borders and of classes disagree, or "" if they do not."""
    for values in columns.values():
        by_class = values.get("edit", math.nan)
        # False for nan.
        if values.get("border_f1", math.nan) - by_class > DISAGREEMENT:
            return (
                "Borders are better than classes: Edit, F1@k and shares of frames also need the "
                "right class, and a cluster stands for one label only. Look at labels that share a "
                "cluster, or one label that has several."
            )
    return ""


def format_score(value: float) -> str:
    """Return a score with three digits behind the point, empty for nan."""
    return f"{value:.3f}" if math.isfinite(value) else ""


def markdown(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a Markdown table whose first column is left-aligned, the others right."""
    lines = [header, ["---", *["---:"] * (len(header) - 1)], *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def write_records(records: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Write records as JSON (with the version) or CSV, by suffix."""
    suffix = path.suffix.lower()
    if suffix not in OUTPUTS:
        raise WriteError(path, f"scores are written as {' or '.join(OUTPUTS)}")
    with (
        atomic_write(path) as draft,
        draft.open("w", encoding="utf-8", newline="\n" if suffix == ".json" else "") as file,
    ):
        if suffix == ".json":
            file.write(f"{records_json(records)}\n")
        else:
            rows = [plain(record) for record in records]
            names = list(dict.fromkeys(name for record in rows for name in record))
            table = csv.DictWriter(file, names, lineterminator="\n")
            table.writeheader()
            table.writerows(
                # Texts that look like formulas are protected for spreadsheets.
                {k: as_text(v) if isinstance(v, str) else v for k, v in record.items()}
                for record in rows
            )


def records_json(records: Sequence[Mapping[str, Any]]) -> str:
    """Records as one JSON object, with the version."""
    content = {"kineme": __version__, "scores": [plain(record) for record in records]}
    return json.dumps(content, indent=1, ensure_ascii=False)


class Result(Protocol):
    """What a run over a folder gives."""

    def to_json(self) -> str: ...

    def records(self) -> Sequence[Mapping[str, Any]]: ...


def write_result(result: Result, path: Path) -> None:
    """Write all of a result as JSON, or its records as CSV, by suffix."""
    if path.suffix.lower() != ".json":
        write_records(result.records(), path)
        return
    with atomic_write(path) as draft:
        draft.write_text(f"{result.to_json()}\n", encoding="utf-8")


def finite(value: Any) -> Any:
    """Return the value; None in place of a number that cannot be had."""
    return None if isinstance(value, float) and not math.isfinite(value) else value


def plain(record: Mapping[str, Any]) -> dict[str, Any]:
    """Return the record with None in place of numbers that cannot be had."""
    return {name: finite(value) for name, value in record.items()}
