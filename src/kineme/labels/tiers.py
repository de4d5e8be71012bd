"""Formats with tiers of annotations: ELAN documents and tables, and Praat TextGrids.

*ELAN* (``.eaf``): one tier per level, whole milliseconds. Frame rate and length are stored in
document properties (``kineme.fps``, ``kineme.n_frames``), which ELAN preserves. Clusters are stored
for unlabelled segments, scores never. Recordings at 1000 frames per second or more are rejected,
since a millisecond would hold several frames.

The linked medium is the video in ``provenance["video"]``, with the recording's start in it, or else
a video with the recording's name beside it.

Reading uses the tiers ``activity`` and ``primitive`` in upper or lower case. If there is no tier of
activities, the only other tier with annotations holds them. Annotations that depend on others have
no times and are ignored.

pympi-ling reads and writes these files, too, but does not guard against XML entities; tests compare
both. Files with a document type are rejected, which prevents entity expansion.

ELAN's tab-delimited text (`ELAN_TABLE`) is read, too. Without a header, a line holds tier,
participant, begin, end and optionally duration, each in one or more time formats, and the text
last. With a header, columns are ``Begin Time - …`` and ``End Time - …``, and either ``Tier``, one
column for each tier, or only ``Annotation`` for activities. Tiers are chosen as in ``.eaf``.

*Praat* (``.TextGrid``): one interval tier per level, in seconds, with the length of the recording,
written in Praat's long text format as UTF-8. Intervals of a tier cover the recording; empty ones
become transitions. There is no frame rate and no score; clusters are stored for unlabelled
segments. Reading accepts both text formats in UTF-8 or UTF-16 by Praat's rule: free-standing
numbers, ``"texts"`` with doubled quotes and ``<flags>`` count, the rest is ignored. Tiers are
chosen as in ``.eaf``; point tiers are ignored. praatio reads these files, too, and tests compare
both, but it raises many different exceptions and corrects errors silently.

Sources: EAF format 3.0, https://www.mpi.nl/tools/elan/EAF_Annotation_Format_3.0_and_ELAN.pdf; ELAN
manual, "Export as tab-delimited text"; Praat manual, "TextGrid file formats".
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import get_args
from xml.etree import ElementTree as ET

from kineme._util.files import NoEntities, atomic_write, find_video
from kineme.errors import ReadError, WriteError
from kineme.formats.delimited import find_separator
from kineme.formats.listing import is_elan_table
from kineme.labels.delimited import open_new_text, parse_number, read_first_bytes
from kineme.labels.registry import LabelFormat
from kineme.labels.spans import Labels, Span, format_text
from kineme.recordings.cells import replace_decimal_comma
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level, Segment

PER_SECOND = 1000
MEDIA_TYPES = {
    ".mp4": "video/mp4",
    ".m4v": "video/mp4",
    ".mov": "video/quicktime",
    ".webm": "video/webm",
    ".ogv": "video/ogg",
}
SCHEMA = {
    "{http://www.w3.org/2001/XMLSchema-instance}noNamespaceSchemaLocation": (
        "http://www.mpi.nl/tools/elan/EAFv3.0.xsd"
    )
}
_CLOCK = re.compile(r"(\d+):(\d\d):(\d\d\.\d+)")
_TIME = re.compile(r"\d+(?:\.\d+)?|\d+:\d\d:\d\d\.\d+")
_TIMES = re.compile(r"(begin|end) time - (.*)", re.IGNORECASE)
_NO_TIERS = re.compile(
    r"(begin|end) time|duration|tier|participant|annotation|file|$", re.IGNORECASE
)
Annotation = tuple[str, float, float, str]
TOKEN = re.compile(r'"((?:[^"]|"")*+)"|(?<!\S)([-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?)%?(?!\S)')


def write(rows: Sequence[Segment], segmentation: Segmentation, path: Path) -> None:
    """Write an ELAN document with one tier per level."""
    if segmentation.fps >= PER_SECOND:
        raise WriteError(
            path,
            f"ELAN stores whole milliseconds, too coarse for {segmentation.fps:g} frames "
            "per second: use another format",
        )
    root = ET.Element("ANNOTATION_DOCUMENT", AUTHOR="kineme", DATE="1970-01-01T00:00:00+00:00")
    root.attrib |= {"FORMAT": "3.0", "VERSION": "3.0", **SCHEMA}
    header = ET.SubElement(root, "HEADER", MEDIA_FILE="", TIME_UNITS="milliseconds")
    _add_medium(header, segmentation)
    for name, value in (("fps", repr(segmentation.fps)), ("n_frames", segmentation.n_frames)):
        ET.SubElement(header, "PROPERTY", NAME=f"kineme.{name}").text = str(value)
    # Segments that touch share a time slot.
    times = sorted({time for row in rows for time in _round_to_milliseconds(row)})
    slots = {time: f"ts{number}" for number, time in enumerate(times, 1)}
    order = ET.SubElement(root, "TIME_ORDER")
    for time, slot in slots.items():
        ET.SubElement(order, "TIME_SLOT", TIME_SLOT_ID=slot, TIME_VALUE=str(time))
    tiers: dict[str, ET.Element] = {}
    for position, row in enumerate(rows, 1):
        if row.level not in tiers:
            tiers[row.level] = ET.SubElement(
                root, "TIER", TIER_ID=row.level, LINGUISTIC_TYPE_REF="default-lt"
            )
        start, stop = (slots[time] for time in _round_to_milliseconds(row))
        holder = ET.SubElement(tiers[row.level], "ANNOTATION")
        span = ET.SubElement(holder, "ALIGNABLE_ANNOTATION", ANNOTATION_ID=f"a{position}")
        span.attrib |= {"TIME_SLOT_REF1": start, "TIME_SLOT_REF2": stop}
        # XML does not allow these two characters.
        text = format_text(row).replace("\ufffe", "\ufffd").replace("\uffff", "\ufffd")
        ET.SubElement(span, "ANNOTATION_VALUE").text = text
    ET.SubElement(
        root,
        "LINGUISTIC_TYPE",
        LINGUISTIC_TYPE_ID="default-lt",
        TIME_ALIGNABLE="true",
        GRAPHIC_REFERENCES="false",
    )
    ET.indent(root)
    with atomic_write(path) as draft:
        ET.ElementTree(root).write(draft, encoding="UTF-8", xml_declaration=True)


def read(path: Path) -> Labels:
    """Read the annotations of an ELAN document."""
    root = _parse_document(path)
    if root.tag != "ANNOTATION_DOCUMENT":
        raise ReadError(path, f"is not an ELAN document but a {root.tag!r:.60}")
    slots = {slot.get("TIME_SLOT_ID"): slot.get("TIME_VALUE") for slot in root.iter("TIME_SLOT")}
    tiers = {
        tier.get("TIER_ID", ""): found
        for tier in root.iter("TIER")
        if (found := list(tier.iter("ALIGNABLE_ANNOTATION")))
    }
    spans = [
        _parse_span(annotation, slots, level, path)
        for name, level in choose_tiers(list(tiers), path).items()
        for annotation in tiers[name]
    ]
    fps = _read_property(root, "kineme.fps", path)
    n_frames = _read_property(root, "kineme.n_frames", path)
    return Labels(spans, "seconds", fps, n_frames / fps if n_frames and fps else None)


def _add_medium(header: ET.Element, segmentation: Segmentation) -> None:
    """Add the video of the recording to the header, if known."""
    source, video = (segmentation.provenance.get(name) or {} for name in ("input", "video"))
    named = Path(video.get("path") or "")
    path = named if named.is_file() else find_video(Path(source.get("path") or ""))
    if path is None:
        return
    medium = ET.SubElement(header, "MEDIA_DESCRIPTOR", MEDIA_URL=path.absolute().as_uri())
    medium.set("MIME_TYPE", MEDIA_TYPES.get(path.suffix.lower(), "video/*"))
    medium.set("RELATIVE_MEDIA_URL", f"./{path.name}")
    origin = round(PER_SECOND * float(video.get("offset_s") or 0))
    if origin:
        medium.set("TIME_ORIGIN", str(origin))


def choose_tiers(names: Sequence[str], path: Path) -> dict[str, Level]:
    """Return the tiers to read and their levels: those named after a level, in any case.

    Without a tier of activities, these are the only other tier.
    """
    levels: tuple[Level, ...] = get_args(Level)
    # Exact names come last, so they take precedence.
    ordered = sorted(names, key=lambda name: name in levels)
    tiers = {name.casefold(): name for name in ordered if name.casefold() in levels}
    found = {tiers[level]: level for level in levels if level in tiers}
    others = [name for name in names if name.casefold() not in levels]
    if "activity" in tiers or not others:
        return found
    if len(others) > 1:
        raise ReadError(
            path,
            f"has {len(names)} tiers ({', '.join(names):.100}): keep one, or name one 'activity'",
        )
    return {others[0]: "activity", **found}


class _Builder(NoEntities, ET.TreeBuilder):
    """Tree builder that rejects documents with entities."""


def _parse_document(path: Path) -> ET.Element:
    parser = ET.XMLParser(target=_Builder())  # noqa: S314 (see NoEntities)
    try:
        with path.open("rb") as file:
            return ET.parse(file, parser).getroot()  # noqa: S314
    except (ET.ParseError, ValueError, LookupError) as error:
        raise ReadError(path, f"is not an ELAN document: {error}") from error


def _parse_span(
    annotation: ET.Element, slots: dict[str | None, str | None], level: Level, path: Path
) -> Span:
    start, stop = (
        _parse_seconds(slots.get(annotation.get(f"TIME_SLOT_REF{end}")), annotation, path)
        for end in (1, 2)
    )
    return Span(start, stop, annotation.findtext("ANNOTATION_VALUE") or "", level)


def _parse_seconds(text: str | None, annotation: ET.Element, path: Path) -> float:
    if text is None or not text.isascii() or not text.isdigit() or len(text) > 15:
        name = annotation.get("ANNOTATION_ID")
        raise ReadError(path, f"annotation {name!r:.60} has no time in milliseconds")
    return int(text) / PER_SECOND


def _read_property(root: ET.Element, name: str, path: Path) -> float | None:
    """Return the number in a property of an ELAN file; None if it is missing."""
    for holder in root.iter("PROPERTY"):
        if holder.get("NAME") == name:
            try:
                value = float(holder.text or "")
            except ValueError:
                value = 0.0
            if not 0 < value < 1e15:
                raise ReadError(path, f"{name} must be a positive number, not {holder.text!r:.60}")
            return value
    return None


def _round_to_milliseconds(row: Segment) -> tuple[int, int]:
    return round(row.start_s * PER_SECOND), round(row.stop_s * PER_SECOND)


ELAN = LabelFormat(
    name="elan",
    help="ELAN, both levels",
    suffixes=(".eaf",),
    holds="levels",
    read=read,
    write=write,
)


def read_table(path: Path) -> Labels:
    """Read the annotations of ELAN's tab-delimited text."""
    with path.open(encoding="utf-8-sig", newline="") as file:
        texts = ["" if line.startswith('"#') else line for line in file]
    header = next(filter(str.strip, texts), "")
    # Spreadsheets save the table with commas or semicolons, and quotes around cells with them.
    separator = "\t" if "\t" in header else find_separator(header)
    rows = csv.reader(
        texts,
        delimiter=separator,
        quoting=csv.QUOTE_NONE if separator == "\t" else csv.QUOTE_MINIMAL,
    )
    lines = [(line, row) for line, row in enumerate(rows, 1) if any(row)]
    if not lines:
        return Labels([])
    is_named = any(map(_TIMES.fullmatch, lines[0][1]))
    annotations = list(
        _read_named_columns(lines, path) if is_named else _read_unnamed_columns(lines, path)
    )
    levels = choose_tiers(list(dict.fromkeys(tier for tier, *_ in annotations)), path)
    return Labels(
        [Span(start, stop, text, levels[t]) for t, start, stop, text in annotations if t in levels]
    )


def _read_named_columns(rows: Sequence[tuple[int, list[str]]], path: Path) -> Iterator[Annotation]:
    """Yield the annotations of a table with a line of names: a tier per row, or per column."""
    names = rows[0][1]
    times: dict[str, tuple[int, bool]] = {}
    for i, name in enumerate(names):
        if (match := _TIMES.fullmatch(name.strip())) and "hh:mm:ss:ff" not in name.lower():
            times.setdefault(match[1].lower(), (i, match[2].strip().lower() == "msec"))
    if len(times) < 2:
        raise ReadError(path, "has no begin and end of annotations in hh:mm:ss.ms, ss.msec or msec")
    lowered = [name.strip().lower() for name in names]
    tier = lowered.index("tier") if "tier" in lowered else None
    text = lowered.index("annotation") if "annotation" in lowered else len(names) - 1
    tiers = [i for i, name in enumerate(names) if not _NO_TIERS.match(name.strip())]
    for line, cells in rows[1:]:
        row = [*cells, *[""] * (len(names) - len(cells))]
        start, stop = (
            _parse_table_seconds(row[times[end][0]], path, line, is_ms=times[end][1])
            for end in ("begin", "end")
        )
        if tier is not None or not tiers:
            yield "activity" if tier is None else row[tier], start, stop, row[text]
            continue
        for i in tiers:
            if row[i]:
                yield names[i], start, stop, row[i]


def _read_unnamed_columns(
    rows: Sequence[tuple[int, list[str]]], path: Path
) -> Iterator[Annotation]:
    """Yield the tier, start, stop and text of each line of a table without a header."""
    first = rows[0][1]
    columns = [i for i in range(2, len(first) - 1) if _TIME.fullmatch(first[i])]
    clocks = [i for i in columns if _CLOCK.fullmatch(first[i])]
    chosen = clocks or columns
    if len(chosen) < 2:
        raise ReadError(path, "has no begin and end of annotations", line=rows[0][0])
    # Begin, end and perhaps duration follow each other, each as seconds, milliseconds, or both.
    end = chosen[2] if not clocks and len(chosen) > 3 else chosen[1]
    begin = chosen[0]
    # Without clock times, whole numbers are milliseconds, others seconds.
    is_ms = not clocks and not any("." in row[begin] for _, row in rows)
    for line, row in rows:
        if len(row) <= end:
            raise ReadError(path, f"{len(row)} cells, but other rows have {len(first)}", line=line)
        start, stop = (_parse_table_seconds(row[i], path, line, is_ms=is_ms) for i in (begin, end))
        yield row[0], start, stop, row[len(first) - 1] if len(row) >= len(first) else ""


def _parse_table_seconds(text: str, path: Path, line: int, *, is_ms: bool) -> float:
    if match := _CLOCK.fullmatch(text.strip()):
        return 3600 * int(match[1]) + 60 * int(match[2]) + float(match[3])
    number = parse_number(replace_decimal_comma(text), "a time", path, line)
    return number / (1000 if is_ms else 1)


ELAN_TABLE = LabelFormat(
    name="elan-table",
    help="ELAN's tab-delimited text",
    suffixes=(".txt", ".tsv", ".csv"),
    holds="levels",
    read=read_table,
    recognises=lambda path: is_elan_table(read_first_bytes(path).decode(errors="replace")),
)


def write_textgrid(rows: Sequence[Segment], segmentation: Segmentation, path: Path) -> None:
    """Write a TextGrid with one tier per level."""
    length = segmentation.n_frames / segmentation.fps
    tiers: dict[str, list[Segment]] = {}
    for row in rows:
        tiers.setdefault(row.level, []).append(row)
    with open_new_text(path, newline="\n") as file:
        file.write('File type = "ooTextFile"\nObject class = "TextGrid"\n\n')
        file.write(f"xmin = 0\nxmax = {length!r}\ntiers? <exists>\nsize = {len(tiers)}\nitem []:\n")
        for place, (name, inside) in enumerate(tiers.items(), 1):
            file.write(f'    item [{place}]:\n        class = "IntervalTier"\n')
            file.write(f'        name = "{name}"\n        xmin = 0\n        xmax = {length!r}\n')
            file.write(f"        intervals: size = {len(inside)}\n")
            file.writelines(_format_lines(inside))


def read_textgrid(path: Path) -> Labels:
    """Read the intervals of a TextGrid."""
    tokens = _split_tokens(path)
    if _read_text(tokens, path) != "ooTextFile" or _read_text(tokens, path) != "TextGrid":
        raise ReadError(path, "is not a TextGrid in text form")
    _read_number(tokens, path)
    length = _read_number(tokens, path)
    tiers: dict[str, list[Span]] = {}
    for _ in range(_read_count(tokens, path)):
        kind, name = _read_text(tokens, path), _read_text(tokens, path)
        _read_number(tokens, path), _read_number(tokens, path)
        found = [_read_interval(tokens, kind, path) for _ in range(_read_count(tokens, path))]
        if kind == "IntervalTier" and any(span.text for span in found):
            tiers[name] = [span for span in found if span.text]
    levels = choose_tiers(list(tiers), path)
    spans = [span._replace(level=level) for name, level in levels.items() for span in tiers[name]]
    return Labels(spans, "seconds", None, length)


def _format_lines(rows: Sequence[Segment]) -> Iterator[str]:
    for place, row in enumerate(rows, 1):
        text = format_text(row).replace('"', '""')
        yield f"        intervals [{place}]:\n"
        yield f"            xmin = {row.start_s!r}\n            xmax = {row.stop_s!r}\n"
        yield f'            text = "{text}"\n'


def _split_tokens(path: Path) -> Iterator[str | float]:
    """Yield the texts and numbers of a TextGrid in order."""
    data = path.read_bytes()
    # A byte order mark identifies UTF-16.
    wide = data.startswith((b"\xff\xfe", b"\xfe\xff"))
    for match in TOKEN.finditer(data.decode("utf-16" if wide else "utf-8-sig")):
        if match[1] is not None:
            yield match[1].replace('""', '"')
            continue
        try:
            yield float(match[2])
        except ValueError as error:
            raise ReadError(path, f"has {match[2]!r:.60} where a number should be") from error


def _read_interval(tokens: Iterator[str | float], kind: str, path: Path) -> Span:
    start = _read_number(tokens, path)
    stop = _read_number(tokens, path) if kind == "IntervalTier" else start
    return Span(start, stop, _read_text(tokens, path))


def _read_text(tokens: Iterator[str | float], path: Path) -> str:
    token = next(tokens, None)
    if not isinstance(token, str):
        raise ReadError(path, f"has {_format_token(token)} where a text in quotes should be")
    return token


def _read_number(tokens: Iterator[str | float], path: Path) -> float:
    token = next(tokens, None)
    if not isinstance(token, float):
        raise ReadError(path, f"has {_format_token(token)} where a number should be")
    return token


def _read_count(tokens: Iterator[str | float], path: Path) -> int:
    """Read a count of items; too large ones fail later in `_read_text` or `_read_number`."""
    count = _read_number(tokens, path)
    if not 0 <= count < 1e9 or count != int(count):
        raise ReadError(path, f"has {count} where a count should be")
    return int(count)


def _format_token(token: object) -> str:
    return "its end" if token is None else f"{token!r:.60}"


TEXTGRID = LabelFormat(
    name="textgrid",
    help="Praat, both levels",
    suffixes=(".textgrid",),
    holds="levels",
    read=read_textgrid,
    write=write_textgrid,
    written_suffix=".TextGrid",
)
