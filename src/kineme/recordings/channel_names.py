"""Recognise columns that are not channels: counters, labels, and a device's surroundings."""

from __future__ import annotations

import re

_COUNTS = frozenset(
    {"frame", "frames", "frame#", "index", "idx", "sample", "row", "id", "unnamed: 0"}
    | {"__index_level_0__", "counter", "packet_counter", "packetcounter", "level_0"}
)
_LABELS = frozenset(
    {"label", "labels", "class", "annotation", "ground_truth", "class_id", "label_id", "target"}
    | {"set", "sets", "rep", "reps", "repetition", "repetitions", "count", "weight", "weight_kg"}
    | {"activity", "exercise", "subject", "participant", "person", "user", "trial", "session"}
)
_NUMBERED = re.compile(r"(.+?)[\s_]*(?:id|idx|index|no|num|number|nr|count)")
_SURROUNDINGS = re.compile(
    r"(?:.*[\W_])?(?:temp(?:erature)?|battery|humidity|lux|latitude|longitude)(?:[\W_].*)?"
)


def is_channel_name(name: str) -> bool:
    """Return whether a column of numbers may be a channel, judging by its name.

    Examples
    --------
    >>> [is_channel_name(name) for name in ("acc_x", "reps", "Set number", "Battery level")]
    [True, False, False, False]
    """
    plain = name.strip().lower()
    numbered = _NUMBERED.fullmatch(plain)
    names = {plain, numbered[1] if numbered else plain}
    return names.isdisjoint(_COUNTS | _LABELS) and _SURROUNDINGS.fullmatch(plain) is None
