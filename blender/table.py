"""What kineme found, as Blender shows it: names, frames, markers, catalogues; nothing of Blender.

A *record* is what an action keeps: the table as kineme's JSON has it, the frame of the scene at
which the table's frame 0 is, and the markers that were set, by the rows they stand for. Frames of
the table count from 0 and spans exclude their end; frames of a scene are whole numbers from
anywhere, and spans of Blender include their end.
"""

from __future__ import annotations

import re
import uuid
from collections import Counter
from collections.abc import Container, Iterable, Iterator, Sequence
from itertools import count
from typing import Any, NamedTuple

Row = dict[str, Any]
Record = dict[str, Any]

MOST_BYTES = 55
"""Of a name, so that Blender has room for a number behind it: names of its data end at 63."""
CATALOGUES = uuid.UUID("3f1f5d4e-6f0b-5d43-9c3f-2b1c7a5e8d10")
"""What the identities of catalogues are made from: the same name has the same one in all files."""
CATALOGUES_HEAD = "# This is an Asset Catalog Definition file for Blender.\n\nVERSION 1\n"


class Marker(NamedTuple):
    """A marker of the timeline: where it is, and what it says."""

    frame: int
    name: str


def rows_of(record: Record, level: str) -> list[Row]:
    """The segments of a level, in time order."""
    return [row for row in record["table"]["segments"] if row["level"] == level]


def name_of(row: Row) -> str:
    """What a segment is called: by its label, else by its cluster, else by its kind."""
    if row["label"].strip():
        return shortened(row["label"])
    if row["cluster"] >= 0:
        return f"cluster {row['cluster']}"
    return row["kind"]


def shortened(text: str) -> str:
    """A text of one line that fits into a name of Blender."""
    line = re.sub(r"\s+", " ", text).strip()
    return line.encode()[:MOST_BYTES].decode(errors="ignore").strip()


def numbered(rows: Sequence[Row]) -> list[str]:
    """A name for each segment, with a number where several are called the same.

    Numbers that would make the name of another are left out, so that no two are the same.
    """
    names = [name_of(row) for row in rows]
    totals = Counter(names)
    free = {name: _numbers_of(name, n, totals) for name, n in totals.items()}
    return [next(free[name]) if totals[name] > 1 else name for name in names]


def _numbers_of(name: str, n: int, others: Container[str]) -> Iterator[str]:
    """A name with numbers behind it, of as many digits as so many need, unlike the others."""
    width = max(2, len(str(n)))
    each = (f"{name} {number:0{width}}" for number in count(1))
    return (one for one in each if one not in others)


def clips_of(record: Record, level: str) -> list[tuple[str, Row]]:
    """The segments that become strips and actions, with their names: all but transitions."""
    rows = [row for row in rows_of(record, level) if row["kind"] != "transition"]
    return list(zip(numbered(rows), rows, strict=True))


def frames_of(record: Record, row: Row) -> tuple[int, int]:
    """The first and the last frame of a segment in the scene."""
    return record["first"] + row["start_frame"], record["first"] + row["stop_frame"] - 1


def row_at(record: Record, level: str, frame: int) -> Row | None:
    """The segment that a frame of the scene lies in."""
    for row in rows_of(record, level):
        first, last = frames_of(record, row)
        if first <= frame <= last:
            return row
    return None


def neighbour(record: Record, level: str, frame: int, step: int) -> int | None:
    """Where the next segment starts, or with a step of -1 the one before; None at the ends."""
    starts = [frames_of(record, row)[0] for row in rows_of(record, level)]
    if step > 0:
        return min((start for start in starts if start > frame), default=None)
    return max((start for start in starts if start < frame), default=None)


def markers_of(record: Record, level: str) -> list[Marker]:
    """A marker for each segment of a level, at its first frame."""
    return [Marker(frames_of(record, row)[0], name_of(row)) for row in rows_of(record, level)]


def same_markers(
    former: Iterable[Sequence[Any]], markers: Sequence[Marker]
) -> Iterator[tuple[Marker, int | None]]:
    """Each marker that was set, and the place in ``markers`` of the one that it is now.

    It is known by its frame and name, else by its frame: then it was renamed. One that was
    moved is the user's own.
    """
    former = [Marker(*each) for each in former]
    free = dict(enumerate(markers))
    found: dict[int, int] = {}
    for by_name in (True, False):
        for number, one in enumerate(former):
            if number in found:
                continue
            for place, other in free.items():
                if one == other or (not by_name and one.frame == other.frame):
                    found[number] = place
                    del free[place]
                    break
    return ((one, found.get(number)) for number, one in enumerate(former))


def names_given(
    record: Record, level: str, markers: Sequence[Marker]
) -> tuple[dict[int, str], dict[int, str]]:
    """Names of clusters, and names of segments by their first frames, from renamed markers.

    The name that most renamed markers of a cluster have is that of the cluster; those who were
    given another have it for themselves.
    """
    rows = {frames_of(record, row)[0]: row for row in rows_of(record, level)}
    renamed: list[tuple[Row, str]] = []
    for one, place in same_markers(record["markers"], markers):
        row = rows.get(one.frame)
        if row is None or place is None:
            continue
        name = shortened(markers[place].name)
        if name not in ("", one.name):
            renamed.append((row, name))
    clusters: dict[int, str] = {}
    for cluster in {row["cluster"] for row, _ in renamed if row["cluster"] >= 0}:
        names = Counter(name for row, name in renamed if row["cluster"] == cluster)
        clusters[cluster] = names.most_common(1)[0][0]
    segments = {
        row["start_frame"]: name for row, name in renamed if clusters.get(row["cluster"]) != name
    }
    return clusters, segments


def catalogue_of(name: str) -> tuple[str, str]:
    """The identity and the path of the catalogue of a cluster's clips."""
    path = "kineme/" + re.sub(r"[:/\\]", "-", name)
    return str(uuid.uuid5(CATALOGUES, path)), path


def with_catalogues(text: str, names: Iterable[str]) -> str:
    """The text of a file of catalogues, with those of these names in it."""
    text = text or CATALOGUES_HEAD
    if not text.endswith("\n"):
        text += "\n"
    for name in sorted(set(names)):
        identity, path = catalogue_of(name)
        if not re.search(rf"^{identity}:", text, re.MULTILINE):
            text += f"{identity}:{path}:{path.replace('/', '-')}\n"
    return text
