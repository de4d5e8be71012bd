"""Small files in ``.kineme``, beside the recordings of a folder: what people said of them.

- ``walk.bvh.reading.json``: how that recording is read, before what the studio was started with,
  and who the people in it are, where there are several. Its ``person`` is then whose table is
  called after the file alone, as all tables were before each of several people had one;
- ``walk.bvh.video.json``: the second of its reference video, a file of the same name, at frame 0;
- ``labels.json``: the labels that the recordings of the folder share, those on the keys 1 to 9.

A damaged file counts as none, is left alone, and people are told.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any, TypeVar

from msgspec import Meta, Struct

from kineme._util.checks import as_texts
from kineme._util.files import OwnedFolder, atomic_write
from kineme._util.json import load_json, options_from_json, options_to_json
from kineme.errors import KinemeError, ReadError, WriteError
from kineme.formats import ReadOptions
from kineme.studio.storage.listed import ListedRecording
from kineme.web.film import DrawnPicture, describe_video
from kineme.web.messages import Video
from kineme.web.requests import LARGEST

FOLDER = ".kineme"
LABELS = "labels.json"
READING = "reading"
Content = TypeVar("Content")


class _Offset(Struct):
    offset_s: Annotated[float, Meta(ge=-LARGEST, le=LARGEST)] | None = None


def read_saved_reading(recording: Path) -> tuple[ReadOptions, tuple[str, ...]]:
    """Return how a file is read, as people said, and who is in it.

    These are named where each of several people is a recording of its own.
    """
    return _read_reading(recording)[0]


def read_saved_options(recording: Path) -> ReadOptions:
    """Return the options alone."""
    return read_saved_reading(recording)[0]


def list_recordings(paths: Iterable[Path]) -> list[ListedRecording]:
    """Return recordings in some files: those of which the people are known have one for each."""
    present: dict[Path, set[str]] = {}
    found: list[ListedRecording] = []
    for path in paths:
        folder = path.parent / FOLDER
        # One listing per folder is cheaper than a look-up for each recording.
        if folder not in present:
            present[folder] = _list_names(folder)
        is_present = _make_sidecar_path(path, READING).name in present[folder]
        options, people = read_saved_reading(path) if is_present else (ReadOptions(), ())
        found += [ListedRecording(path, who, who == options.person) for who in people]
        found += [] if people else [ListedRecording(path)]
    return found


def resolve_read_options(
    listed: ListedRecording, general: ReadOptions, choice: ReadOptions | None = None
) -> ReadOptions:
    """Return how a recording is read: by a ``choice``, or as people said of it; else as all."""
    options = replace(general, **options_to_json(choice or read_saved_options(listed.path)))
    return replace(options, person=listed.person) if listed.person else options


def write_reading(recording: Path, options: ReadOptions, people: Sequence[str]) -> None:
    """Keep what people say of how a file is read, and who is in it."""
    content = {**options_to_json(options), "people": [*people]}
    write_file(_make_sidecar_path(recording, READING), json.dumps(content).encode())


def make_video_message(recording: Path, drawn: DrawnPicture | None = None) -> Video | None:
    """Return what a page is told of the video, over which ``drawn`` is drawn."""
    return describe_video(recording, drawn, _read_offset(recording)[0].offset_s)


def read_video_offset(recording: Path) -> float:
    """Seconds of the video at the start of the recording; 0 where nobody said."""
    return _read_offset(recording)[0].offset_s or 0.0


def write_video_offset(recording: Path, seconds: float) -> None:
    """Keep the offset of the video; WriteError where it cannot be written."""
    write_file(_make_sidecar_path(recording, "video"), json.dumps({"offset_s": seconds}).encode())


def read_shared_labels(root: Path) -> list[str]:
    """Return the labels of a folder; none where nobody chose any."""
    return _read_labels(root)[0]


def write_shared_labels(root: Path, labels: Sequence[str]) -> list[str]:
    """Keep these labels, each once, for the folder."""
    unique = list(dict.fromkeys(label.strip() for label in labels if label.strip()))
    write_file(root / FOLDER / LABELS, json.dumps(unique, ensure_ascii=False, indent=1).encode())
    return unique


def list_sidecar_problems(recording: Path) -> list[str]:
    """Return which of the files of a recording and its folder cannot be read, and why."""
    found = (_read_reading(recording), _read_offset(recording), _read_labels(recording.parent))
    return [note for _, notes in found for note in notes]


def read_sidecar(path: Path, shape: type[Content], otherwise: Content) -> tuple[Content, list[str]]:
    """Return what a side file holds, and what people should know of it.

    ``otherwise`` counts where there is none, or a damaged one, which is left alone.
    """
    try:
        return load_json(path, shape), []
    except ReadError as error:
        if isinstance(error.__cause__, FileNotFoundError | NotADirectoryError):
            return otherwise, []
        return otherwise, [f"{path.name} was left alone: it {error.reason}"]


def write_file(path: Path, content: bytes) -> None:
    """Have a file of ``.kineme`` on the disk, whole or not at all, with the folders around it.

    WriteError where it cannot be; it, ``.kineme`` or a folder between is a link.
    """
    root = _find_root(path)
    OwnedFolder(root).make(*path.parent.relative_to(root).parts)
    with atomic_write(path) as draft:
        draft.write_bytes(content)


def delete_file(path: Path) -> None:
    """Delete a file of ``.kineme``, unless it or a folder around it is a link."""
    root = _find_root(path)
    with suppress(OSError, WriteError):
        OwnedFolder(root).path(*path.relative_to(root).parts).unlink()


def _find_root(path: Path) -> Path:
    """Return the folder of recordings that holds the ``.kineme`` of a path."""
    return next(folder.parent for folder in path.parents if folder.name == FOLDER)


def _read_reading(recording: Path) -> tuple[tuple[ReadOptions, tuple[str, ...]], list[str]]:
    path = _make_sidecar_path(recording, READING)
    people: tuple[str, ...] = ()
    content, notes = read_sidecar(path, dict[str, Any], {})
    try:
        people = as_texts(content.pop("people", ()), "people")
        return (options_from_json(ReadOptions, content), people), notes
    except KinemeError as error:
        wrong = f"{path.name} was left alone: it holds a wrong option: {error}"
        return (ReadOptions(), people), [*notes, wrong]


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
