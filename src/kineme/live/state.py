"""State of a stream, in memory and as a file: NPZ with its arrays, and the rest as JSON inside."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field, fields
from os import PathLike
from typing import Any

import numpy as np

from kineme._util.files import atomic_write, translate_read_errors
from kineme.errors import ReadError
from kineme.live.finals import Finals, Look, Row
from kineme.live.intake import Intake
from kineme.live.looking import RecentPast

SCHEMA = "kineme.stream/1"
EXAMPLE = "example "
NUMBERS = ("gap", "now", "next_look", "is_timed", "is_finished")
Settings = dict[str, Any]


@dataclass
class Announced:
    """Activity that was announced last, and the number of its repetitions announced."""

    start: int = 0
    cluster: int = -1
    n_repetitions: int = 0


@dataclass
class StreamState:
    """Everything that changes in a stream.

    Attributes
    ----------
    intake, finals, past
        Rows that are not frames yet, final segments, and the recent past.
    before : Look, optional
        Result of the last segmentation of the recent past.
    announced : Announced
    gap : int, optional
        First frame of the current gap.
    now, next_look : int
        Number of frames so far, and at which the recent past is segmented next.
    is_timed : bool, optional
        Whether rows have times; None before the first.
    is_finished : bool
    """

    intake: Intake
    finals: Finals
    past: RecentPast
    before: Look | None = None
    announced: Announced = field(default_factory=Announced)
    gap: int | None = None
    now: int = 0
    next_look: int = 0
    is_timed: bool | None = None
    is_finished: bool = False


def save_state(state: StreamState, settings: Mapping[str, Any], path: str | PathLike[str]) -> None:
    """Write a state and the arguments of the stream."""
    past = state.past
    past.collect()
    intake = {each.name: getattr(state.intake, each.name) for each in fields(Intake)}
    arrays: dict[str, Any] = {
        n: value for n, value in intake.items() if isinstance(value, np.ndarray)
    }
    arrays |= {"values": past.values, "missing": past.missing, "known": past.known}
    arrays |= {f"{EXAMPLE}{cluster}": rows for cluster, rows in past.examples.items()}
    content = {
        "schema": SCHEMA,
        "settings": settings,
        "intake": {name: value for name, value in intake.items() if name not in arrays},
        "finals": asdict(state.finals),
        "start": past.start,
        "before": state.before,
        "announced": asdict(state.announced),
        "numbers": {name: getattr(state, name) for name in NUMBERS},
    }
    text = np.frombuffer(json.dumps(content).encode(), np.uint8)
    with atomic_write(path) as draft, draft.open("wb") as file:
        np.savez(file, content=text, **arrays)


def load_state(path: str | PathLike[str]) -> tuple[Settings, Callable[[StreamState], None]]:
    """Return the arguments of a saved stream, and a function that restores its state."""
    with translate_read_errors(path):
        try:
            with np.load(path, allow_pickle=False) as file:
                arrays: dict[str, Any] = {name: file[name] for name in file.files}
            content = json.loads(arrays.pop("content").tobytes())
        except (ValueError, KeyError, AttributeError) as error:
            raise ReadError(path, "is not a stream saved by kineme") from error
    if content.get("schema") != SCHEMA:
        raise ReadError(path, f"has another version: {content.get('schema')!r:.40}")

    def fill(state: StreamState) -> None:
        own = {each.name for each in fields(Intake)} & arrays.keys()
        state.intake = Intake(**content["intake"], **{name: arrays[name] for name in own})
        finals = content["finals"]
        for level in ("activities", "primitives"):
            finals[level] = [Row(*row) for row in finals[level]]
        finals["labels"] = {int(cluster): label for cluster, label in finals["labels"].items()}
        state.finals = Finals(**finals)
        past = state.past
        past.start, past.known = content["start"], arrays["known"]
        past.values, past.missing = arrays["values"], arrays["missing"]
        past.examples = {
            int(name.removeprefix(EXAMPLE)): rows
            for name, rows in arrays.items()
            if name.startswith(EXAMPLE)
        }
        if content["before"] is not None:
            state.before = Look(*([Row(*row) for row in rows] for rows in content["before"]))
        state.announced = Announced(**content["announced"])
        for name, value in content["numbers"].items():
            setattr(state, name, value)

    return content["settings"], fill
