"""What a build is asked for: which sources, read how, into which folder."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from hashlib import sha256
from os import PathLike
from pathlib import Path
from typing import Any

from kineme._util.files import AnyPath, OwnedFolder
from kineme._util.json import options_from_json, options_to_json
from kineme._version import __version__
from kineme.errors import ParameterError, ReadError, WriteError
from kineme.formats import ReadOptions
from kineme.library.storage.layout import ANALYSES, HEAD, TABLES, read_head, read_json
from kineme.library.storage.places import is_remote, place
from kineme.methods.segmenter import SegmentOptions

Entry = tuple[str, Path, str]
"""A recording: its name, where it was read from, and its analysis."""

ANALYSIS = "kineme.library.piece/4"
"""Schema of an analysis: a change of what is kept of a recording gets the next number."""
NOTHING = "{}: nothing to build from: name recordings or folders"
"""The error where no recording is named, and none is known."""


@dataclass(frozen=True)
class Plan:
    """What a build is asked for: sources, those that it knew before among them, and how to read.

    ``missing`` are those named that are not there, and never were; ``recursive`` is whether folders
    in folders are looked into.
    """

    folder: Path
    sources: tuple[Path, ...]
    missing: tuple[Path, ...]
    recursive: bool
    read_options: ReadOptions
    segment_options: SegmentOptions

    @property
    def analyses(self) -> Path:
        return self.folder / ANALYSES

    @cached_property
    def options_digest(self) -> str:
        return digest_options(self.read_options, self.segment_options)

    def key(self, digest: str) -> str:
        """Return the name of the analysis of a recording whose files have this digest."""
        return analysis_key(self.options_digest, digest)


def plan_of(
    folder: Path,
    head: Mapping[str, Any],
    sources: Iterable[Path],
    remove: Iterable[Path],
    recursive: bool | None,
    read_options: ReadOptions | None,
    segment_options: SegmentOptions | None,
) -> Plan:
    """Return the plan of a build; what was not said is as it was the last time."""
    every = sources_after(folder, sources, remove)
    if not every and not head:
        raise ParameterError(NOTHING.format(folder))
    before = head.get("sources", ())
    missing = [each for each in every if not each.exists() and str(each) not in before]
    former = options_in(folder, head) if head else (ReadOptions(), SegmentOptions())
    return Plan(
        folder,
        tuple(each for each in every if each not in missing),
        tuple(missing),
        bool(head.get("recursive")) if recursive is None else recursive,
        read_options or former[0],
        segment_options or former[1],
    )


def options_in(folder: Path, head: Mapping[str, Any]) -> tuple[ReadOptions, SegmentOptions]:
    """Return the options in the head of a library; ReadError where they are none."""
    try:
        read_options = options_from_json(ReadOptions, head["read_options"])
        segment_options = options_from_json(SegmentOptions, head["segment_options"])
        segment_options.resolved()
    except ParameterError as error:
        reason = f"is damaged, build the library anew: {error}"
        raise ReadError(folder / HEAD, reason) from error
    return read_options, segment_options


def digest_options(read_options: ReadOptions, segment_options: SegmentOptions) -> str:
    """Return a digest of the version and of everything that decides what is found.

    ParameterError for options that a library cannot keep.
    """
    segment_options.resolved()
    presets = []
    for signals in (False, True):
        with suppress(ParameterError):  # constants of one that the other does not have
            chosen = segment_options.resolved(signals=signals)
            presets.append([chosen.name, dict(chosen.parameters())])
    options = [options_to_json(each) for each in (read_options, segment_options)]
    content = [ANALYSIS, __version__, presets, options]
    return sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def analysis_key(options_digest: str, digest: str) -> str:
    """Return the name of the analysis of a recording whose files have this digest."""
    return sha256(f"{options_digest} {digest}".encode()).hexdigest()[:32]


def sources_after(
    into: AnyPath, sources: Iterable[Path] = (), remove: Iterable[Path] = ()
) -> list[Path]:
    """The sources of a library after these were added and removed, as absolute paths."""
    head = read_json(place(into) / HEAD)
    sources = [place(each) for each in head.get("sources", ())] + [*map(absolute, sources)]
    removed = {*map(absolute, remove)}
    unknown = removed - set(sources)
    if unknown:
        raise ParameterError(
            f"{min(unknown)} is no source of the library; there are "
            f"{', '.join(map(str, sources)) or 'none'}"
        )
    return [path for path in dict.fromkeys(sources) if path not in removed]


def open_folder(into: AnyPath, named: Sequence[Path]) -> Path:
    """Return the folder of a library, made where there is none, unless nothing is named."""
    folder = place(into, "build")
    owned = OwnedFolder(folder)
    owned.path(ANALYSES)
    owned.path(TABLES)
    if (folder / HEAD).is_file():
        owned.path(TABLES, read_head(folder)["tables"])
        return folder
    unfinished = (folder / ANALYSES).is_dir()  # by a build that was ended before its first head
    try:
        if folder.exists() and not unfinished and (not folder.is_dir() or any(folder.iterdir())):
            raise WriteError(into, "is there already and is no library: name a new folder")
        if not named and not unfinished:
            raise ParameterError(NOTHING.format(folder))
        (folder / ANALYSES).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise WriteError(into, f"cannot be made: {error.strerror or error}") from error
    return folder


def as_paths(given: AnyPath | Iterable[AnyPath]) -> list[Path]:
    """One path or several as a list; ParameterError where one is none."""
    if isinstance(given, str | PathLike):
        return [place(given)]
    if not isinstance(given, Iterable):
        raise ParameterError(f"build needs paths of recordings or folders, not {given!r:.60}")
    return [place(path, "build") for path in given]


def absolute(path: Path) -> Path:
    """Return the path from the root; links are not followed."""
    return path if is_remote(path) else Path(os.path.abspath(path))  # noqa: PTH100
