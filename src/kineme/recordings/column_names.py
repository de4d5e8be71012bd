"""Recognise columns by name: coordinates of a point, and columns that are not channels.

The coordinates of a point are ``hip_x hip_y hip_z``. A unit of length may follow: ``hip x [mm]``,
``hip_x_mm``, ``hip_x_px``. Sensors have coordinates, too: ``acc_x``, ``gyro.y`` or ``ForceZ``.
Counters, labels, and measurements of surroundings, places or the heart are not channels.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping
from itertools import groupby, islice

import numpy as np
from numpy.typing import ArrayLike

from kineme.recordings.joint_names import SENSOR

_COUNTS = frozenset(
    {"frame", "frames", "index", "idx", "sample", "row", "id", "unnamed 0", "index level 0"}
    | {"counter", "packet counter", "packetcounter", "level 0", "seq", "sequence", "crc"}
)
_LABELS = frozenset(
    {"label", "labels", "class", "annotation", "ground truth", "class id", "label id", "target"}
    | {"set", "sets", "rep", "reps", "repetition", "repetitions", "count", "weight", "weight kg"}
    | {"activity", "exercise", "subject", "participant", "person", "user", "trial", "session"}
)
_NUMBERED = re.compile(r"(.+?) ?(?:id|idx|index|no|num|number|nr|count)")
_SURROUNDINGS = re.compile(
    r"(?:.* )?(?:temp|temperature|battery|humidity|lux|latitude|longitude|altitude|accuracy|gps"
    r"|heart ?rate|bpm|steps|pedometer|barometer|sound)(?: .*)?|location [a-z]{2}.*"
    r"|(?:lat|lon|lng|hr)(?: deg| degrees)?"
)
_PLACE = re.compile(r"\b(?:lat|lon|lng|latitude|longitude|gps)\b")
# Insoles have pressures, and machines speeds, too: these are left out only beside a place.
_COURSE = re.compile(r"(?:pressure|speed|bearing|course)(?: (?:h?pa|m s|km h|deg|degrees))?")
_OWNER = re.compile(
    r"(?:person|subject|participant|individual|user|landmark|key ?point"
    r"|(?P<part>track|device|sensor|joint|body ?part))"
    r"(?P<suffix> ?(?:id|name|type|kind|no|number|label))?"
)
_NUMBER = re.compile(r"[-+]?[\d.,]+(?:e[-+]?\d+)?", re.IGNORECASE)
_ROWS_IN_TURN = 5  # mean of successive rows of one owner, above which they are no turns

EMPTY = frozenset(
    {"", "nan", "na", "n/a", "null", "none", "-"} | {"#n/a", "#nv", "#div/0!", "#num!", "#value!"}
)
"""Contents of a cell without a number, in lower case; the last ones are errors of spreadsheets."""

_NO_OWNERS = EMPTY | {"<na>", "true", "false"}

COORDINATE = re.compile(
    r"(?:(.*[^\s_.:/-])[\s_.:/-]+([xyzXYZ])|(.*[a-z0-9])([XYZ]))(?:(?:[\s_]*[\[(]|[\s_]+)(m|cm|mm|px)[\])]?)?"
)
"""Matches a point and its axis, after a separator or by a capital letter, and a unit."""

_WORD = re.compile(r"[A-Z]?[a-z]+\d*|[A-Z]+\d*(?![a-z])|\d+")
_MOST_WORDS = 8


def group_axes(columns: Iterable[str]) -> dict[str, dict[str, str]]:
    """Return the columns of the axes of each joint or sensor that has x and y at least.

    Examples
    --------
    >>> group_axes(["time", "hip_x", "hip_y", "knee_x"])
    {'hip': {'x': 'hip_x', 'y': 'hip_y'}}
    """
    found: dict[str, dict[str, str]] = {}
    for column in columns:
        match = COORDINATE.fullmatch(column.strip())
        if match:
            # The two alternatives, with a separator or by a capital, have their own groups.
            point, axis = (match[1], match[2]) if match[1] else (match[3], match[4])
            found.setdefault(point, {})[axis.lower()] = column
    return {point: axes for point, axes in found.items() if {"x", "y"} <= axes.keys()}


def is_body(name: str) -> bool:
    """Return whether the name of a point is that of a joint, not of a sensor.

    The part before a colon names the person and is ignored.

    Examples
    --------
    >>> is_body("A:hip"), is_body("hip_acc")
    (True, False)
    """
    joint = name.rpartition(":")[2]
    return not any(SENSOR.fullmatch(word) for word in _WORD.findall(joint))


def list_beginnings(name: str) -> Iterator[str]:
    """Yield the prefixes of a name that end before a word, up to the eighth word.

    Examples
    --------
    >>> list(list_beginnings("hip_angular_vel"))
    ['hip', 'hip_angular']
    """
    for word in islice(_WORD.finditer(name), 1, _MOST_WORDS):
        yield name[: word.start()].rstrip(" \t_.:/-")


def select_channels(names: Iterable[str]) -> list[str]:
    """Return the columns of numbers that may be channels, judging by their names.

    Counters and labels never are, measurements of surroundings only if there are no others.

    Examples
    --------
    >>> select_channels(["acc_x", "Set number", "batteryLevel"]), select_channels(["id", "HR"])
    (['acc_x'], ['HR'])
    """
    words = {name: _split_words(name) for name in names}
    measured = [name for name in words if not _is_count_or_label(words[name])]
    others = [name for name in measured if not _SURROUNDINGS.fullmatch(words[name])]
    if any(map(_PLACE.search, words.values())):
        others = [name for name in others if not _COURSE.fullmatch(words[name])]
    return others or measured


def name_column(label: object) -> str:
    """Return the name of a column of a data frame; several levels are joined by ``_``.

    Examples
    --------
    >>> name_column(("acc", "x")), name_column(("time", "")), name_column(3)
    ('acc_x', 'time', '3')
    """
    return "_".join(filter(None, map(str, label))) if isinstance(label, tuple) else str(label)


def is_owner(name: str) -> bool:
    """Return whether a column of this name may tell the person, device or point of each row.

    Examples
    --------
    >>> is_owner("sensorName"), is_owner("Device ID"), is_owner("sensor_x")
    (True, True, False)
    """
    return _OWNER.fullmatch(_split_words(name)) is not None


def describe_alternation(
    columns: Mapping[str, ArrayLike], requested: Collection[str] = ()
) -> str | None:
    """Return an error if rows of several points, people or devices alternate.

    A device exchanged once does not count as alternation. A requested channel is no owner. Numbers
    are owners only if the name of their column says so, and no channels are requested.

    Examples
    --------
    >>> print(describe_alternation({"device": ["left", "right"] * 3}))
    rows of several points, people or devices alternate (column 'device': left, right): ...
    >>> describe_alternation({"device": ["left"] * 3 + ["right"] * 3})
    """
    for name, column in columns.items():
        match = _OWNER.fullmatch(_split_words(name))
        if match is None or name in requested:
            continue
        texts = (str(cell).strip() for cell in np.asarray(column).tolist())
        cells = [text for text in texts if text.lower() not in _NO_OWNERS]
        # A bare "sensor" may be a measurement, such as that of a foot switch.
        needs_text = requested or (match["part"] and not match["suffix"])
        if needs_text and all(map(_NUMBER.fullmatch, cells)):
            continue
        rows, turns = Counter(cells), Counter(owner for owner, _ in groupby(cells))
        owners = [*rows]
        if turns.total() <= len(owners) + 1:
            continue
        # The slowest of several sensors has about one row at a time.
        if any(rows[owner] <= _ROWS_IN_TURN * turns[owner] for owner in owners):
            return (
                f"rows of several points, people or devices alternate (column {name!r}: "
                f"{owners[0]:.20}, {owners[1]:.20}): give each a table or columns of its own"
            )
    return None


def _is_count_or_label(words: str) -> bool:
    numbered = _NUMBERED.fullmatch(words)
    return not {words, numbered[1] if numbered else words}.isdisjoint(_COUNTS | _LABELS)


def _split_words(name: str) -> str:
    """Return the words of a name in lower case, separated by blanks."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])|[\W_]+", " ", name).strip().lower()
