"""Text formats with one item per line: Audacity, MS-TCN, and clip lists for motion matching.

*Audacity*: start and stop in seconds and text, separated by tabs; one level, no frame rate. Point
labels (start equals stop) are not segments. Lines that begin with a backslash (frequencies of a
spectral selection) are skipped.
https://manual.audacityteam.org/man/importing_and_exporting_labels.html

*MS-TCN*: one label per frame and line, the format of MS-TCN and related projects (Abu Farha, Gall,
CVPR 2019; https://github.com/yabufarha/ms-tcn).

    corpus/mapping.txt              "0 walk", "1 jump", ...: a number per class
    corpus/groundTruth/take.txt     "walk" once per frame

New classes are appended to the mapping; existing ones keep their numbers. Blanks in labels become
``_``, since readers split the mapping at blanks. Successive frames of one class become one segment;
``transition``, ``background`` and ``SIL`` are transitions. Reading needs no mapping. Numbers,
as NumPy saves an array of states, are labels, too, but whole ones below 0 are transitions.

*Clips*: a CSV of ``file``, ``start``, ``stop`` (frames, exclusive) and ``mirror`` like the list in
orangeduck's ``generate_database.py``, with seconds and ``label`` added. Writing stores one level,
unmirrored, with cluster numbers for unlabelled segments. Reading accepts the clips of one file
(mirrored duplicates are merged); the frame rate is computed from frames and seconds.
https://github.com/orangeduck/Motion-Matching
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from contextlib import suppress
from itertools import groupby, pairwise
from pathlib import Path

from kineme._util.files import HEAD, atomic_write
from kineme.errors import ReadError, WriteError
from kineme.labels.csv_table import choose_roundest_rate
from kineme.labels.delimited import (
    format_source,
    open_new_text,
    parse_integer,
    parse_number,
    read_columns,
    read_first_bytes,
    read_rows,
    write_rows,
)
from kineme.labels.registry import LabelFormat
from kineme.labels.spans import Labels, Span, format_text
from kineme.recordings.cells import is_number, replace_decimal_comma
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Segment

FOLDER = "groundTruth"
NOTHING = ("background", "SIL")
NEEDED = ("file", "start", "stop")


def _write_audacity(rows: Sequence[Segment], _: Segmentation, path: Path) -> None:
    with open_new_text(path, newline="\n") as file:
        file.writelines(f"{row.start_s!r}\t{row.stop_s!r}\t{format_text(row)}\n" for row in rows)


def _read_audacity(path: Path) -> Labels:
    """Return the labels of a track."""
    spans = []
    with path.open(encoding="utf-8-sig", newline="\n") as file:
        for line, text in enumerate(file, 1):
            cells = text.rstrip("\r\n").split("\t", 2)
            # A backslash begins the frequencies of a spectral selection.
            if cells == [""] or cells[0].startswith("\\"):
                continue
            if len(cells) < 2:
                raise ReadError(
                    path, "a label must be a start, a stop and a text separated by tabs", line=line
                )
            start, stop = (
                parse_number(replace_decimal_comma(cell), what, path, line)
                for cell, what in zip(cells, ("the start", "the stop"), strict=False)
            )
            spans.append(Span(start, stop, cells[2] if len(cells) > 2 else ""))
    return Labels(spans)


def _is_audacity(path: Path) -> bool:
    """Return whether the first label has two times with a tab between."""
    lines = read_first_bytes(path).decode(errors="replace").splitlines()
    return "\t" in next((line for line in lines if line and not line.startswith("\\")), "")


AUDACITY = LabelFormat(
    name="audacity",
    help="Audacity label track, one level",
    suffixes=(".txt",),
    holds="level",
    read=_read_audacity,
    write=_write_audacity,
    recognises=_is_audacity,
)


def _write_ms_tcn(rows: Sequence[Segment], _: Segmentation, path: Path) -> None:
    """Write a label per frame, and add new classes to the mapping."""
    if path.parent.name != FOLDER:
        raise WriteError(path, f"must be in a folder called {FOLDER}: give {FOLDER}/{path.name}")
    with suppress(OSError):  # atomic_write says why there is none
        path.parent.mkdir(exist_ok=True)
    texts = [
        "".join("_" if letter.isspace() else letter for letter in format_text(r)) for r in rows
    ]
    mapping = path.parent.parent / "mapping.txt"
    classes = _list_classes(mapping)
    for text in texts:
        # New classes continue after the largest number.
        classes.setdefault(text, 1 + max(classes.values(), default=-1))
    with atomic_write(mapping) as class_draft, open_new_text(path, newline="\n") as file:
        lines = (f"{number} {text}\n" for text, number in classes.items())
        class_draft.write_text("".join(lines), encoding="utf-8", newline="\n")
        for row, text in zip(rows, texts, strict=True):
            file.writelines([f"{text}\n"] * (row.stop_frame - row.start_frame))


def _read_ms_tcn(path: Path) -> Labels:
    """Return a label for each run of equal lines."""
    if path.is_dir():
        raise ReadError(path, f"is a folder: name one of the files in its {FOLDER}")
    spans = []
    at = 0
    with path.open(encoding="utf-8-sig", newline="\n") as file:
        for text, run in groupby(line.strip() for line in file):
            if not text:
                raise ReadError(path, "has an empty line: every frame needs a label", line=at + 1)
            stop = at + sum(1 for _ in run)
            spans.append(Span(at, stop, _name_class(text)))
            at = stop
    return Labels(spans, "frames", length=at)


def _name_class(text: str) -> str:
    """Return the text of a segment for the label of its frames."""
    if is_number(text) and (value := float(text.replace(",", "."))).is_integer():
        text = f"{value + 0.0:.0f}"  # without the sign of -0.0
    return "transition" if text in NOTHING or re.fullmatch(r"-[1-9]\d*", text) else text


def _list_classes(mapping: Path) -> dict[str, int]:
    """Return the numbers of the classes in a mapping, by name."""
    if not mapping.is_file():
        return {}
    classes, line = {}, ""
    try:
        for line in mapping.read_text(encoding="utf-8-sig").splitlines():
            if line.strip():
                number, text = line.split()
                classes[text] = int(number)
    except UnicodeDecodeError as error:
        raise WriteError(mapping, "is not UTF-8") from error
    except ValueError as error:
        raise WriteError(
            mapping, f'is not a mapping: its lines must be like "0 walk", not {line!r:.60}'
        ) from error
    return classes


def _is_ms_tcn(path: Path) -> bool:
    """Return whether the first line is a text and not a row of a table, or lines are states."""
    lines = read_first_bytes(path).decode(errors="replace").splitlines()
    if lines and path.stat().st_size > HEAD:  # the last line may be cut off
        del lines[-1:]
    first = lines[0].strip() if lines else ""
    if bool(first) and "\t" not in first and not first[0].isdigit() and first[0] not in "-+.":
        return True
    # Unlike samples of a channel or lists of change points, states mostly last for many frames.
    pairs = [*pairwise(map(str.strip, lines))]
    return all(map(is_number, lines)) and 2 * sum(a == b for a, b in pairs) > len(pairs)


MS_TCN = LabelFormat(
    name="ms-tcn",
    help="One label per frame, with the mapping",
    suffixes=(".txt",),
    holds="level",
    read=_read_ms_tcn,
    write=_write_ms_tcn,
    recognises=_is_ms_tcn,
    several=True,
    folder=FOLDER,
)


def _write_clips(rows: Sequence[Segment], segmentation: Segmentation, path: Path) -> None:
    """Write a line for each clip; 0: not mirrored."""
    source = format_source(segmentation)
    lines = ((source, row.start_frame, row.stop_frame, 0, row.start_s, row.stop_s, format_text(row))
             for row in rows)  # fmt: skip
    with open_new_text(path) as file:
        write_rows(file, (*NEEDED, "mirror", "start_s", "stop_s", "label"), lines)


def _read_clips(path: Path) -> Labels:
    """Return the clips of a list, in which a mirrored clip repeats another."""
    spans: dict[Span, None] = {}
    sources: dict[str, None] = {}
    last = 0, 0.0
    with path.open(encoding="utf-8-sig", newline="") as file:
        for line, cells in read_rows(file, path, [NEEDED]):
            start, stop = (parse_integer(cells[name], name, path, line) for name in NEEDED[1:])
            spans[Span(start, stop, cells.get("label", ""))] = None
            sources[cells["file"]] = None
            if cells.get("stop_s"):
                last = max(last, (stop, parse_number(cells["stop_s"], "stop_s", path, line)))
    if len(sources) > 1:
        names = ", ".join(sources)
        raise ReadError(path, f"lists clips of {len(sources)} files ({names:.100}): keep one")
    return Labels(list(spans), "frames", choose_roundest_rate(*last) if min(last) > 0 else None)


CLIPS = LabelFormat(
    name="clips",
    help="Clip list for motion matching, one level",
    suffixes=(".csv",),
    holds="level",
    read=_read_clips,
    write=_write_clips,
    recognises=lambda path: set(NEEDED) <= read_columns(path),
)
