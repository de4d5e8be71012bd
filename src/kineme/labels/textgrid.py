"""Praat TextGrids: an interval tier per level, seconds, with the length of the recording.

Written in Praat's long text form, UTF-8. A TextGrid's tiers tile as segments
do; an empty interval is a gap and is read as a transition. No frame rate, no
scores, clusters only where there is no label.

Read are both text forms, UTF-8 or UTF-16, by Praat's own rule: numbers that
stand alone, ``"texts"`` with doubled quotes and ``<flags>`` count, all else is
decoration. Tiers are chosen as in `kineme.labels.elan`; point tiers are
ignored.

praatio reads these files, too; the tests hold both against each other. A
reader of one's own is shorter than what it takes to turn its many exceptions
and its silent corrections into one clear error.

Source: Praat manual, "TextGrid file formats".
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path

from kineme.errors import ReadError
from kineme.labels.delimited import new_text
from kineme.labels.elan import chosen_tiers
from kineme.labels.registry import LabelFormat
from kineme.labels.spans import Labels, Span, text_of
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Segment

TOKEN = re.compile(r'"((?:[^"]|"")*+)"|(?<!\S)([-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?)%?(?!\S)')


def write(rows: Sequence[Segment], segmentation: Segmentation, path: Path) -> None:
    """Leave a TextGrid with a tier per level of the rows at ``path``."""
    length = segmentation.n_frames / segmentation.fps
    tiers: dict[str, list[Segment]] = {}
    for row in rows:
        tiers.setdefault(row.level, []).append(row)
    with new_text(path, newline="\n") as file:
        file.write('File type = "ooTextFile"\nObject class = "TextGrid"\n\n')
        file.write(f"xmin = 0\nxmax = {length!r}\ntiers? <exists>\nsize = {len(tiers)}\nitem []:\n")
        for number, (name, inside) in enumerate(tiers.items(), 1):
            file.write(f'    item [{number}]:\n        class = "IntervalTier"\n')
            file.write(f'        name = "{name}"\n        xmin = 0\n        xmax = {length!r}\n')
            file.write(f"        intervals: size = {len(inside)}\n")
            file.writelines(_lines(inside))


def read(path: Path) -> Labels:
    """Return the intervals at ``path``."""
    tokens = _tokens(path)
    if _text(tokens, path) != "ooTextFile" or _text(tokens, path) != "TextGrid":
        raise ReadError(path, "is not a TextGrid in text form")
    _number(tokens, path)
    length = _number(tokens, path)
    tiers: dict[str, list[Span]] = {}
    for _ in range(_count(tokens, path)):
        kind, name = _text(tokens, path), _text(tokens, path)
        _number(tokens, path), _number(tokens, path)
        found = [_span(tokens, kind, path) for _ in range(_count(tokens, path))]
        if kind == "IntervalTier" and any(span.text for span in found):
            tiers[name] = [span for span in found if span.text]
    levels = chosen_tiers(list(tiers), path)
    spans = [span._replace(level=level) for name, level in levels.items() for span in tiers[name]]
    return Labels(spans, "seconds", None, length)


def _lines(rows: Sequence[Segment]) -> Iterator[str]:
    for number, row in enumerate(rows, 1):
        text = text_of(row).replace('"', '""')
        yield f"        intervals [{number}]:\n"
        yield f"            xmin = {row.start_s!r}\n            xmax = {row.stop_s!r}\n"
        yield f'            text = "{text}"\n'


def _tokens(path: Path) -> Iterator[str | float]:
    """Texts and numbers in order."""
    data = path.read_bytes()
    wide = data.startswith((b"\xff\xfe", b"\xfe\xff"))
    for match in TOKEN.finditer(data.decode("utf-16" if wide else "utf-8-sig")):
        if match[1] is not None:
            yield match[1].replace('""', '"')
            continue
        try:
            yield float(match[2])
        except ValueError as error:
            raise ReadError(path, f"has {match[2]!r:.60} where a number should be") from error


def _span(tokens: Iterator[str | float], kind: str, path: Path) -> Span:
    start = _number(tokens, path)
    stop = _number(tokens, path) if kind == "IntervalTier" else start
    return Span(start, stop, _text(tokens, path))


def _text(tokens: Iterator[str | float], path: Path) -> str:
    token = next(tokens, None)
    if not isinstance(token, str):
        raise ReadError(path, f"has {_format_number(token)} where a text in quotes should be")
    return token


def _number(tokens: Iterator[str | float], path: Path) -> float:
    token = next(tokens, None)
    if not isinstance(token, float):
        raise ReadError(path, f"has {_format_number(token)} where a number should be")
    return token


def _count(tokens: Iterator[str | float], path: Path) -> int:
    """How many follow; a claim beyond what is there ends in an error of `_text` or `_number`."""
    count = _number(tokens, path)
    if not 0 <= count < 1e9 or count != int(count):
        raise ReadError(path, f"has {count} where a count should be")
    return int(count)


def _format_number(token: object) -> str:
    return "its end" if token is None else f"{token!r:.60}"


FORMAT = LabelFormat(
    name="textgrid",
    help="Praat, both levels",
    suffixes=(".textgrid",),
    holds="levels",
    read=read,
    write=write,
    written_suffix=".TextGrid",
)
