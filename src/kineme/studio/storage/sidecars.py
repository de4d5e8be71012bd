"""Recordings that can be opened, and the settings that users made for them.

If a file has several people, each one is a recording with its own id, table, history and downloads.
They share the file, its reading options and its video.

Settings are small files in the folder ``.kineme`` beside the recordings:

- ``walk.bvh.reading.json``: reading options of the recording, which precede those of the studio,
  and the people in it if there are several. The person in ``person`` keeps the table named after
  the file alone, as all tables were before each person had one;
- ``walk.bvh.video.json``: the time in its reference video (a file of the same name) at frame 0;
- ``labels.json``: the labels that the recordings of the folder share, on the keys 1 to 9.

A damaged file is ignored and kept, and the user is told.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from hashlib import blake2b
from pathlib import Path
from typing import Annotated, Any, TypeVar

from msgspec import Meta, Struct

from kineme._util.checks import as_texts
from kineme._util.files import OwnedFolder, add_person, atomic_write
from kineme._util.json import load_json, options_from_json, options_to_json
from kineme.errors import KinemeError, ReadError, WriteError
from kineme.formats import ReadOptions
from kineme.web.display import DrawnPicture, describe_video
from kineme.web.messages import Video
from kineme.web.requests import LARGEST

FOLDER = ".kineme"
LABELS = "labels.json"
READING = "reading"
Content = TypeVar("Content")


@dataclass(frozen=True)
class ListedRecording:
    """A recording that can be opened: a file, or one ``person`` of a file with several.

    ``is_first`` tells whether this person was opened before the people became separate recordings:
    it keeps the id and the table of the file.
    """

    path: Path
    person: str = ""
    is_first: bool = False

    @property
    def id(self) -> str:
        """Id that pages use."""
        return make_file_id(self.path, "" if self.is_first else self.person)

    @property
    def name(self) -> str:
        """Name shown to the user."""
        person = f"person {self.person}" if self.person.isdecimal() else self.person
        return f"{self.path.name} · {person}" if person else self.path.name

    @property
    def person_path(self) -> Path:
        """Path with the person's name added, after which labels and downloads are named."""
        return add_person(self.path, self.person)

    @property
    def table_base(self) -> Path:
        """Path after which the table is named."""
        return self.path if self.is_first else self.person_path


def make_file_id(path: Path, person: str = "") -> str:
    """Return the id of a file, or of a person in it; it depends on path and person only."""
    name = str(path.absolute()).encode(errors="surrogateescape")
    suffix = f"\0{person}".encode(errors="backslashreplace") if person else b""
    return blake2b(name + suffix, digest_size=9).hexdigest()


class _Offset(Struct):
    offset_s: Annotated[float, Meta(ge=-LARGEST, le=LARGEST)] | None = None


def read_saved_reading(recording: Path) -> tuple[ReadOptions, tuple[str, ...]]:
    """Return the saved reading options of a file, and the people in it.

    The people are empty unless each is a separate recording.
    """
    return _read_reading(recording)[0]


def read_saved_options(recording: Path) -> ReadOptions:
    """Return the saved reading options of a file."""
    return read_saved_reading(recording)[0]


def list_recordings(paths: Iterable[Path]) -> list[ListedRecording]:
    """Return the recordings in these files; one per person if the people are known."""
    names_by_folder: dict[Path, set[str]] = {}
    recordings: list[ListedRecording] = []
    for path in paths:
        folder = path.parent / FOLDER
        # Listing each folder once is faster than looking for a file per recording.
        if folder not in names_by_folder:
            names_by_folder[folder] = _list_names(folder)
        has_options = _make_sidecar_path(path, READING).name in names_by_folder[folder]
        options, people = read_saved_reading(path) if has_options else (ReadOptions(), ())
        recordings += [ListedRecording(path, person, person == options.person) for person in people]
        recordings += [] if people else [ListedRecording(path)]
    return recordings


def resolve_read_options(
    listed: ListedRecording, general: ReadOptions, choice: ReadOptions | None = None
) -> ReadOptions:
    """Return the options for a recording: ``choice`` or the saved ones, then the general ones."""
    options = replace(general, **options_to_json(choice or read_saved_options(listed.path)))
    return replace(options, person=listed.person) if listed.person else options


def write_reading(recording: Path, options: ReadOptions, people: Sequence[str]) -> None:
    """Save the reading options of a file and the people in it."""
    content = {**options_to_json(options), "people": [*people]}
    write_file(_make_sidecar_path(recording, READING), json.dumps(content).encode())


def make_video_message(recording: Path, picture: DrawnPicture | None = None) -> Video | None:
    """Return the message about the video of a recording; ``drawn`` is drawn over it."""
    return describe_video(recording, picture, _read_offset(recording)[0].offset_s)


def read_video_offset(recording: Path) -> float:
    """Return the time in the video at the start of the recording, s; 0 by default."""
    return _read_offset(recording)[0].offset_s or 0.0


def write_video_offset(recording: Path, seconds: float) -> None:
    """Save the offset of the video, s; WriteError if it cannot be written."""
    write_file(_make_sidecar_path(recording, "video"), json.dumps({"offset_s": seconds}).encode())


def read_shared_labels(root: Path) -> list[str]:
    """Return the shared labels of a folder; empty by default."""
    return _read_labels(root)[0]


def write_shared_labels(root: Path, labels: Sequence[str]) -> list[str]:
    """Save the shared labels of a folder, without duplicates."""
    unique = list(dict.fromkeys(label.strip() for label in labels if label.strip()))
    write_file(root / FOLDER / LABELS, json.dumps(unique, ensure_ascii=False, indent=1).encode())
    return unique


def list_sidecar_problems(recording: Path) -> list[str]:
    """Return which files of a recording and its folder cannot be read, and why."""
    results = (_read_reading(recording), _read_offset(recording), _read_labels(recording.parent))
    return [note for _, notes in results for note in notes]


def read_sidecar(path: Path, shape: type[Content], otherwise: Content) -> tuple[Content, list[str]]:
    """Return the content of a settings file, and notes for the user.

    ``otherwise`` is returned for a missing or damaged file; a damaged one is kept.
    """
    try:
        return load_json(path, shape), []
    except ReadError as error:
        if isinstance(error.__cause__, FileNotFoundError | NotADirectoryError):
            return otherwise, []
        return otherwise, [f"{path.name} was ignored: it {error.reason}"]


def write_file(path: Path, content: bytes) -> None:
    """Write a file in ``.kineme`` completely or not at all; create its folders.

    WriteError if it cannot be written, or if it or a folder on the way is a link.
    """
    root = _find_root(path)
    OwnedFolder(root).make(*path.parent.relative_to(root).parts)
    with atomic_write(path) as draft:
        draft.write_bytes(content)


def delete_file(path: Path) -> None:
    """Delete a file in ``.kineme``, unless it or a folder on the way is a link."""
    root = _find_root(path)
    with suppress(OSError, WriteError):
        OwnedFolder(root).path(*path.relative_to(root).parts).unlink()


def _find_root(path: Path) -> Path:
    """Return the folder of recordings whose ``.kineme`` holds this path."""
    return next(folder.parent for folder in path.parents if folder.name == FOLDER)


def _read_reading(recording: Path) -> tuple[tuple[ReadOptions, tuple[str, ...]], list[str]]:
    path = _make_sidecar_path(recording, READING)
    people: tuple[str, ...] = ()
    content, notes = read_sidecar(path, dict[str, Any], {})
    try:
        people = as_texts(content.pop("people", ()), "people")
        return (options_from_json(ReadOptions, content), people), notes
    except KinemeError as error:
        note = f"{path.name} was ignored: it has an invalid option: {error}"
        return (ReadOptions(), people), [*notes, note]


def _read_offset(recording: Path) -> tuple[_Offset, list[str]]:
    return read_sidecar(_make_sidecar_path(recording, "video"), _Offset, _Offset())


def _read_labels(root: Path) -> tuple[list[str], list[str]]:
    return read_sidecar(root / FOLDER / LABELS, list[str], [])


def _list_names(folder: Path) -> set[str]:
    try:
        return {*os.listdir(folder)}  # noqa: PTH208 (names alone)
    except OSError:
        return set()


def _make_sidecar_path(recording: Path, what: str) -> Path:
    return recording.parent / FOLDER / f"{recording.name}.{what}.json"
