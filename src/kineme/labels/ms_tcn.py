"""One label per line and frame, as MS-TCN and its followers keep their data.

    corpus/mapping.txt              "0 walk", "1 jump", ...: a number per class
    corpus/groundTruth/take.txt     "walk" once per frame

``write`` leaves the file in ``groundTruth`` and adds its classes to the
mapping; classes that are there keep their numbers. Blanks in a label become
``_``: the mapping is split at blanks by all who read it. No frame rate, no
scores; neighbours of the same class become one segment.

Read is a file of labels; ``transition``, ``background`` and ``SIL`` are
transitions. The mapping is not needed.

Source: Abu Farha, Gall, MS-TCN, CVPR 2019; https://github.com/yabufarha/ms-tcn.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from itertools import groupby
from pathlib import Path

from kineme._util.files import atomic_write
from kineme.errors import ReadError, WriteError
from kineme.labels.delimited import head
from kineme.labels.registry import LabelFormat
from kineme.labels.spans import Labels, Span, text_of
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Segment

FOLDER = "groundTruth"
NOTHING = ("background", "SIL")


def write(rows: Sequence[Segment], _: Segmentation, path: Path) -> None:
    """Leave a line per frame at ``path``, and the classes in the mapping."""
    if path.parent.name != FOLDER:
        raise WriteError(path, f"must lie in a folder called {FOLDER}: give {FOLDER}/{path.name}")
    with suppress(OSError):  # atomic_write says why there is none
        path.parent.mkdir(exist_ok=True)
    texts = [_strip_blanks(text_of(row)) for row in rows]
    mapping = path.parent.parent / "mapping.txt"
    classes = _classes(mapping)
    for text in texts:
        # New classes go on after the largest number.
        classes.setdefault(text, 1 + max(classes.values(), default=-1))
    with atomic_write(mapping) as class_draft, atomic_write(path) as draft:
        lines = (f"{number} {text}\n" for text, number in classes.items())
        class_draft.write_text("".join(lines), encoding="utf-8", newline="\n")
        with draft.open("w", encoding="utf-8", newline="\n") as file:
            for row, text in zip(rows, texts, strict=True):
                file.writelines([f"{text}\n"] * (row.stop_frame - row.start_frame))


def read(path: Path) -> Labels:
    """Return a span per run of equal lines at ``path``."""
    if path.is_dir():
        raise ReadError(path, f"is a folder: name one of the files in its {FOLDER}")
    spans = []
    at = 0
    with path.open(encoding="utf-8-sig", newline="\n") as file:
        # Runs of equal lines are segments.
        for text, run in groupby(line.strip() for line in file):
            if not text:
                raise ReadError(path, "has an empty line: every frame needs a label", line=at + 1)
            stop = at + sum(1 for _ in run)
            spans.append(Span(at, stop, "transition" if text in NOTHING else text))
            at = stop
    return Labels(spans, "frames", None, at)


def _classes(mapping: Path) -> dict[str, int]:
    """Return the classes that are there, by name."""
    if not mapping.is_file():
        return {}
    classes = {}
    try:
        for line in mapping.read_text(encoding="utf-8-sig").splitlines():
            number, text = line.split()
            classes[text] = int(number)
    except ValueError as error:
        raise WriteError(
            mapping, f'is no mapping: its lines must be like "0 walk", not {line!r:.60}'
        ) from error
    return classes


def _strip_blanks(text: str) -> str:
    return "".join("_" if letter.isspace() else letter for letter in text)


def _recognises(path: Path) -> bool:
    """Return whether the first line is one word or more, and no row of a table."""
    first = next(iter(head(path).decode(errors="replace").split("\n", 1)), "").strip()
    return bool(first) and "\t" not in first and not first[0].isdigit() and first[0] not in "-+."


FORMAT = LabelFormat(
    name="ms-tcn",
    help="One label per frame, with the mapping",
    suffixes=(".txt",),
    holds="level",
    read=read,
    write=write,
    recognises=_recognises,
    several=True,
    folder=FOLDER,
)
