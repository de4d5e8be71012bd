"""Fill the generated tables of README.md and of the pages, and write the JSON Schema of results.

    python docs/fill_pages.py [--check]

========================== ==========================================================
README.md, results.md      measured figures, from ``figures.json``
segments.md, segments.schema.json  columns of the segment table, from `Segment`
library.md                 columns of the tables of a library, from the tables
parameters.md              constants of the presets, from the presets
========================== ==========================================================

A table stands between two comments such as ``<!-- figures -->`` and ``<!-- /figures -->``; no other
text is changed. With ``--check`` nothing is written, and the exit code is 1 if a file is outdated.
``python -m benchmarks NAME --record`` measures the figures.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import kineme
from kineme.labels.json_table import INDEPENDENT, SCHEMA
from kineme.library.storage.tables import DESCRIBED
from kineme.methods import Preset
from kineme.segments.table import COLUMNS, Column, find_lacking

HERE = Path(__file__).resolve().parent
FIGURES = HERE / "figures.json"
SCHEMA_FILE = HERE / "segments.schema.json"
WIDTH = 100
TYPES = {str: "text", int: "whole number", float: "number"}
SCHEMA_DESCRIPTION = (
    "The segments of a recording. The confidence of a row is the probability that what its kind "
    "claims is right: the cluster of an activity; transitions and primitives have none. The "
    "border_confidence is the probability that it starts where it says; signals have none. With "
    "the published presets, and for labels from a knowledge base, the "
    "confidence is a share and no probability."
)

README_METHODS = ("kineme", "voegele2014", "krueger2017", "haca")
README_ROWS = {
    "CMU subject 86: frames in the right class": "fairness.subject_86.{}.one_to_one",
    "CMU subject 86: border F1 within 0.25 s": "fairness.subject_86.{}.border_f1",
    "synthetic recordings: activities counted exactly, %": "synthetic.{}.counts",
}
"""Titles of the rows in README, and the figure of each method."""


class FigureTable(NamedTuple):
    """One table of the results: a row per case, a column per figure.

    The figure of a cell is called ``BENCHMARK.ROW.COLUMN``.
    """

    benchmark: str
    title: str
    rows: Mapping[str, str]
    columns: Mapping[str, str]


SHARES = {"mof": "MoF", "edit": "Edit", "f1@50": "F1@50", "border_f1": "border F1"}
RESULTS = (
    FigureTable(
        "synthetic",
        "Synthetic recordings",
        {name: f"`{name}`" for name in ("kineme", "voegele2014", "krueger2017")},
        {"counts": "activities counted exactly"},
    ),
    FigureTable(
        "fairness",
        "Subject 86 under the fair and the published scores",
        {f"subject_86.{name}": name for name in ("kineme", "voegele2014", "krueger2017")}
        | {
            "subject_86.aca": "aca, mean of five runs",
            "subject_86.haca": "haca, mean of five runs",
            "subject_86.means": "the annotators' mean borders, no transitions",
            "subject_86.spans": "the annotators' spans",
            "subject_86.uniform": "uniform cuts",
        },
        {
            "one_to_one": "one to one",
            "border_f1": "border F1",
            "border_ratio": "borders",
            "strict": "strict",
        },
    ),
    FigureTable(
        "sources",
        "Motion capture",
        {
            "mocap6.kineme": "CMU exercises, uncut",
            "takes.kineme": "game studio, uncut",
            "tug.kineme": "timed up and go, uncut",
            "subject_86.kineme": "CMU subject 86, uncut",
            "hdm05.kineme": "HDM05, joined",
            "synthetic.kineme": "synthetic",
        },
        {
            "one_to_one": "one to one",
            "border_f1": "border F1",
            "covering": "covering",
            "count_exact": "counted exactly",
        },
    ),
    FigureTable(
        "sources",
        "Counts of repetitions",
        {
            "uiprmd.kineme": "UI-PRMD, exercises",
            "uiprmd_incorrect.kineme": "UI-PRMD, done incorrectly",
            "msrc12.kineme": "MSRC-12, Kinect",
            "barbell.sensors": "barbell, sensors",
            "ptex.sensors": "PTEx, sensors",
            "gym_watch.sensors": "gym watch",
            "moca.kineme": "MoCA",
            "countix.kineme": "Countix, keypoints of video",
        },
        {"exact": "exact", "within_one": "within one"},
    ),
    FigureTable(
        "sources",
        "Sensors, uncut",
        {
            "swimming.sensors": "swimming watch",
            "hugadb_by_person.sensors": "HuGaDB, joined by person",
        },
        SHARES,
    ),
    FigureTable(
        "sources",
        "Movements made now and then",
        {"sparse_events.kineme": "synthetic"},
        {"precision": "precision", "recall": "recall"},
    ),
    FigureTable(
        "sources",
        "The same recording, changed",
        {"same.kineme": "`kineme`", "same.sensors": "`sensors`"},
        {"mean": "mean", "noise": "noise", "25_Hz": "25 Hz", "2_s_cut_off": "2 s cut off"},
    ),
    FigureTable(
        "sets",
        "Sets of other laboratories, one mapping for each recording",
        {
            f"{key}.recording.kineme": name
            for key, name in {
                "hapt": "HAPT, 1 sensor",
                "hugadb": "HuGaDB, 6 sensors",
                "ipolgait": "IPOL gait, 2 sensors",
                "utkinect": "UTKinect, joints",
            }.items()
        },
        {**SHARES, "seconds_per_hour": "s per hour"},
    ),
    FigureTable(
        "sets",
        "One mapping for the whole set",
        {
            f"{key}.{how}.kineme": f"{name}, {told}"
            for key, name in {
                "hapt": "HAPT",
                "hugadb": "HuGaDB",
                "ipolgait": "IPOL gait",
                "utkinect": "UTKinect",
            }.items()
            for how, told in {"folder": "clusters given", "untold": "clusters found"}.items()
        },
        {"clusters": "clusters", **SHARES},
    ),
    FigureTable(
        "sets",
        "Other packages on the same recordings",
        {
            f"{key}.recording.{method}{part}": f"{name}, {method}"
            for key, name, part in (
                ("hugadb", "HuGaDB, each 6th", ".every_6"),
                ("ipolgait", "IPOL gait", ""),
                ("utkinect", "UTKinect", ""),
            )
            for method in ("kineme", "claspy", "ruptures", "tsseg_hmm")
        },
        {"mof": "MoF", "f1@50": "F1@50", "border_f1": "border F1"},
    ),
    FigureTable(
        "agreement",
        "Agreement with the authors' program",
        {
            "krueger2017": "`krueger2017`",
            "krueger2017_as_stored": "`krueger2017`, on the program's bundled features",
            "2017_plain": "2017, not bundled",
            "2017_mirrored": "2017, not bundled, mirrored",
            "2017_bundled_mirrored": "2017, bundled, mirrored",
            "voegele2014": "`voegele2014`",
            "voegele2014_as_run": "`voegele2014`, with the step (10, 10)",
        },
        {
            "activities": "borders of activities",
            "cuts": "all cuts",
            "clusters": "clusters",
        },
    ),
    FigureTable(
        "confidence",
        "Confidence",
        {
            f"{kind} of {group}": f"{kind}, {group}"
            for group in ("bodies", "signals")
            for kind in ("cluster", "border", "count")
        }
        | {"cut of bodies": "start of a repetition, bodies"},
        {
            "right": "right, all",
            "sure": "share that is sure",
            "sure_right": "right, of the sure",
            "auc": "AUC",
            "brier": "Brier score",
            "base": "Brier score of one probability for all",
        },
    ),
    FigureTable(
        "cycles",
        "Durations of repetitions",
        {"all.inner": "inner", "all.ends": "first and last"},
        {"mean": "mean error", "deviation": "deviation"},
    ),
    FigureTable(
        "cycles",
        "Angles from markers against Plug-in Gait",
        {
            "laboratory.knee": "knee",
            "laboratory.knee_markers_only": "knee, without thigh markers",
            "laboratory.ankle": "ankle",
        },
        {
            "offset": "offset",
            "rest": "left without the offset",
            "range": "range",
            "range_deviation": "deviation of the range",
        },
    ),
    FigureTable(
        "contacts",
        "Foot contacts",
        {"markers": "heel and toe against force plates"},
        {"foot_strike": "strike", "foot_off": "foot off", "plates": "contacts"},
    ),
    FigureTable(
        "contacts",
        "Foot contacts by gyroscopes",
        {"fitting": "recordings without lost samples", "all": "all"},
        {"f1_all": "F1", "exact": "feet counted exactly", "within_one": "within one"},
    ),
    FigureTable(
        "search",
        "Search by example",
        {"hdm05": "HDM05", "uiprmd": "UI-PRMD", "utkinect": "UTKinect"},
        {"precision": "precision", "recall": "recall"},
    ),
    FigureTable(
        "vocabulary",
        "Clusters of a library",
        {
            "hdm05": "HDM05",
            "subject_86": "CMU subject 86",
            "both": "both",
            "uiprmd": "UI-PRMD",
        },
        {"actions": "actions", "clusters": "clusters", "one_to_one": "one to one"},
    ),
    FigureTable(
        "series",
        "Time series that are no movement",
        {"tssb": "TSSB, 38 series", "utsa": "UTSA, 16 series"},
        {"covering": "covering", "ami": "AMI of states"},
    ),
    FigureTable(
        "stream",
        "Streams",
        {
            "subject_86.one_to_one": "CMU subject 86, one to one",
            "subject_86.border_f1": "CMU subject 86, border F1",
            "hugadb.mof": "HuGaDB, MoF",
            "hugadb.border_f1": "HuGaDB, border F1",
            "uiprmd.exact": "UI-PRMD, counted exactly",
        },
        {"stream": "as a stream", "file": "as a file"},
    ),
    FigureTable(
        "loops",
        "Loops",
        {"": "recordings used in development", "others": "other recordings"},
        {
            "groups": "movements",
            "first": "the first is the best, within a tenth",
            "seam": "largest step over a seam / largest step inside",
            "above": "seams above the recording's 95 % quantile",
        },
    ),
    FigureTable(
        "segmentation",
        "Time to segment one minute (86_10, 63 s)",
        {
            name: f"`{name}`"
            for name in ("kineme", "voegele2014", "krueger2017", "krueger2017_not_bundled")
        },
        {"milliseconds": "kineme", "octave": "the authors' program"},
    ),
    FigureTable(
        "growth",
        "Long recordings",
        {
            "kineme.1_h": "`kineme`, 1 h",
            "kineme.4_h": "`kineme`, 4 h",
            "voegele2014.max_lag.1_h": "`voegele2014`, `max_lag`, 1 h",
            "voegele2014.max_lag.4_h": "`voegele2014`, `max_lag`, 4 h",
        },
        {"seconds": "time", "gigabytes": "memory"},
    ),
    FigureTable(
        "startup",
        "Start",
        {name: f"`{name}`" for name in ("kineme", "voegele2014", "krueger2017")},
        {"first": "first run, compiles", "cached": "later runs"},
    ),
    FigureTable(
        "library",
        "Building a library of 42 minutes",
        {"build.copies": "40 recordings of 63 s"},
        {"processors": "processor time", "memory": "memory"},
    ),
    FigureTable(
        "studio_edits",
        "Edits in the studio, of a table with 20,000 segments",
        {"20000.border": "move a border", "20000.split": "split", "20000.undo": "undo"},
        {"page": "page", "saved": "saved on disk"},
    ),
)

Figures = Mapping[str, Mapping[str, Any]]


def readme_table(figures: Figures) -> str:
    """Return the scores of the methods beside each other."""
    rows = [["", *(f"`{method}`" for method in README_METHODS)]]
    for title, name in README_ROWS.items():
        found = (figures.get(name.format(method)) for method in README_METHODS)
        rows.append([title, *map(show_figure, found)])
    return markdown_table(rows)


def results_tables(figures: Figures) -> str:
    """Return the tables of `RESULTS`, each with the benchmark that measures it."""
    parts = []
    for table in RESULTS:
        names = {
            row: [figure_name(table, row, column) for column in table.columns] for row in table.rows
        }
        rows = [["", *table.columns.values()]]
        for row, title in table.rows.items():
            rows.append([title, *(show_figure(figures.get(name)) for name in names[row])])
        dates = [
            figures[name]["date"] for each in names.values() for name in each if name in figures
        ]
        measured = (
            f"`python -m benchmarks {table.benchmark}`, {max(dates, default='not measured')}."
        )
        parts.append(f"### {table.title}\n\n{measured}\n\n{markdown_table(rows)}")
    return "\n\n".join(parts)


def figure_name(table: FigureTable, row: str, column: str) -> str:
    return ".".join(part for part in (table.benchmark, row, column) if part)


def show_figure(figure: Mapping[str, Any] | None) -> str:
    """Return a figure with its unit, or a dash if it is not recorded."""
    value = None if figure is None else figure["value"]
    if figure is None or value is None:
        return "–"
    text = f"{value:.4g}" if isinstance(value, float) else str(value)
    return f"{text} {figure['unit']}".strip()


def columns_table() -> str:
    """Return a row for each column of the segment table."""
    rows = [["column", "type", "meaning"]]
    for name, column in COLUMNS.items():
        unit = f", {column.unit}" if column.unit else ""
        rows.append([f"`{name}`", f"{TYPES[column.type]}{unit}", column.meaning])
    return markdown_table(rows)


def library_tables() -> str:
    """Return the columns of each table of a library, without those of the segment table."""
    parts = []
    for name, columns in DESCRIBED.items():
        rows = [[f"`{name}`", "type", "meaning"]]
        for column, described in columns.items():
            is_known = name == "segments" and column in COLUMNS
            if not is_known:
                kind = "32 numbers" if column == "embedding" else TYPES[described.type]
                rows.append([f"`{column}`", kind, described.meaning])
        parts.append(markdown_table(rows))
    return "\n\n".join(parts)


def constants_table(method: str) -> str:
    """Return a row for each constant of a method's presets; equal values are shown once."""
    presets: list[Preset] = [each for each in kineme.PRESETS.values() if each.method == method]
    described = {each.name: each for preset in presets for each in preset.constants()}
    heads: dict[tuple[str, ...], list[str]] = {}  # presets with equal values share a column
    for preset in presets:
        values = {each.name: show_constant(each.value) for each in preset.constants()}
        heads.setdefault(tuple(values.get(name, "") for name in described), []).append(preset.name)
    head = [", ".join(f"`{name}`" for name in names) for names in heads.values()]
    rows = [["constant", *head, "unit", "meaning"]]
    for constant, first, *others in zip(described.values(), *heads, strict=True):
        cells = [first, *("" if value == first else value for value in others)]
        rows.append([f"`{constant.name}`", *cells, constant.unit, constant.help])
    return markdown_table(rows)


def show_constant(value: Any) -> str:
    """Return a constant's value in few characters."""
    match value:
        case None | bool():
            return {None: "–", True: "yes", False: "no"}[value]
        case float():
            return f"{value:.4g}" if value < 1000 else f"{value:.0f}"
        case ((_, _), *_):
            return " ".join(map(str, value))
        case tuple():
            return ", ".join(map(show_constant, value))
    return str(value)


def markdown_table(rows: Sequence[Sequence[str]]) -> str:
    """Return a table, the first row as its head."""
    head, *body = (f"| {' | '.join(row)} |" for row in rows)
    return "\n".join([head, "|---" * len(rows[0]) + "|", *body])


def json_schema() -> dict[str, Any]:
    """Return the JSON Schema of a result, with the columns that the table declares."""
    columns = {name: _schema_of(column) for name, column in COLUMNS.items()}
    text, number, names = {"type": "string"}, {"type": "number"}, {"type": ["string", "null"]}
    provenance = {
        "kineme": text,
        "preset": text,
        "parameters": {"type": "object"},
        "input": _object({"path": names, "format": names, "sha256": names}),
        "notes": {"type": "array", "items": text},
    }
    positive = {"type": "number", "exclusiveMinimum": 0}
    needed = [name for name in INDEPENDENT if COLUMNS[name].default is None] + ["cluster"]
    lists = {"type": "object", "required": needed, "additionalProperties": {"type": "array"}}
    level = _object({"detail": positive, "columns": lists}, required=["detail"])
    levels = {"type": "array", "minItems": 1, "items": level}
    head = {
        "schema": {"const": SCHEMA},
        "n_frames": {"type": "integer", "minimum": 1},
        "fps": positive,
        "provenance": _object(provenance),
        "timings": {"type": "object", "additionalProperties": number},
    }
    of, count = {"enum": [*COLUMNS["level"].allowed]}, {"type": "integer", "minimum": 0}
    span = {"type": "array", "prefixItems": [of, count, count], "minItems": 3}
    comment = {"type": "array", "prefixItems": [of, count, text], "minItems": 3}
    annotation = {
        "checked": {"type": "array", "items": span},
        "by_hand": {"type": "array", "items": span},
        "comments": {"type": "array", "items": comment},
        "cluster_names": {"type": "object", "additionalProperties": text},
        "corrections": count,
        "excluded": {"type": "array", "items": count},
    }
    rows = {"type": "array", "minItems": 1, "items": _object(columns, required=find_lacking(()))}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": SCHEMA,
        "description": SCHEMA_DESCRIPTION,
        **_object(
            {
                **head,
                "annotation": _object(annotation),
                "hierarchy": _object(
                    {"detail": positive, "levels": levels}, required=["detail", "levels"]
                ),
                "segments": rows,
            },
            required=[*head, "segments"],
        ),
    }


def format_json(value: Any, indent: int = 0, key: str = "") -> str:
    """Return JSON with every object and list on one line where it fits."""
    flat = key + json.dumps(value)
    if len(flat) + indent < WIDTH or not isinstance(value, dict | list):
        return flat
    inner = indent + 2
    if isinstance(value, dict):
        parts = [format_json(part, inner, f"{json.dumps(name)}: ") for name, part in value.items()]
        first, last = "{}"
    else:
        parts = [format_json(part, inner) for part in value]
        first, last = "[]"
    lines = ",\n".join(f"{' ' * inner}{part}" for part in parts)
    return f"{key}{first}\n{lines}\n{' ' * indent}{last}"


def _object(properties: dict[str, Any], *, required: Sequence[str] = ()) -> dict[str, Any]:
    need = {"required": [*required]} if required else {}
    return {"type": "object", **need, "properties": properties}


def _schema_of(column: Column) -> dict[str, Any]:
    """Return the schema of a cell."""
    kinds: dict[Any, str] = {str: "string", int: "integer", float: "number"}
    kind: str | list[str] = kinds[column.type]
    if column.type is float and column.default is not None:  # null where nothing is known
        kind = [kinds[float], "null"]
    cell: dict[str, Any] = {"enum": [*column.allowed]} if column.allowed else {"type": kind}
    if column.least is not None:
        cell["minimum"] = column.least
    unit = {"unit": column.unit} if column.unit else {}
    return {"description": column.meaning, **cell, **unit}


def _figures() -> Figures:
    loaded: Figures = json.loads(FIGURES.read_text(encoding="utf-8"))
    return loaded


Fill = Callable[[str], str]
FILLS: dict[Path, tuple[str, Fill]] = {
    HERE.parent / "README.md": ("figures", lambda _: readme_table(_figures())),
    HERE / "results.md": ("figures", lambda _: results_tables(_figures())),
    HERE / "segments.md": ("columns", lambda _: columns_table()),
    HERE / "library.md": ("tables", lambda _: library_tables()),
    HERE / "parameters.md": ("constants", constants_table),
}
"""For each page the word in its comments, and what makes a table from the word behind that."""


def fill_page(page: Path) -> str:
    """Return the text of a page with its tables up to date."""
    word, fill = FILLS[page]
    mark = re.compile(rf"(<!-- {word}(?:: (\w+))? -->\n).*?(<!-- /{word} -->)", re.DOTALL)
    text = page.read_text(encoding="utf-8")
    return mark.sub(lambda found: f"{found[1]}\n{fill(found[2])}\n\n{found[3]}", text)


def fill_schema() -> str:
    """Return the text of ``segments.schema.json``."""
    return format_json(json_schema()) + "\n"


def main() -> None:
    texts = {page: fill_page(page) for page in FILLS} | {SCHEMA_FILE: fill_schema()}
    old = [file for file, text in texts.items() if file.read_text(encoding="utf-8") != text]
    if "--check" in sys.argv[1:] and old:
        sys.exit(
            "\n".join(f"{file.name} is outdated: run python docs/fill_pages.py" for file in old)
        )
    for file in old:
        file.write_text(texts[file], encoding="utf-8")


if __name__ == "__main__":
    main()
