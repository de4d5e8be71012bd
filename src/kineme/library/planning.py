"""Plan a build: resolve sources, options and folder, and list the recordings in the sources."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from functools import cache, cached_property
from hashlib import sha256
from os import PathLike
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from kineme._util.files import AnyPath, OwnedFolder, is_remote, make_absolute, refuse_pipe
from kineme._util.json import options_from_json, options_to_json
from kineme._version import __version__
from kineme.errors import FileError, ParameterError, ReadError, WriteError
from kineme.formats import ReadOptions, read
from kineme.formats.keypoints.openpose import list_frame_files
from kineme.formats.listing import holds_recording, scan_folder
from kineme.formats.skeletons.amc import find_skeleton
from kineme.library.storage.layout import (
    ANALYSES,
    HEAD,
    KEY_LENGTH,
    TABLES,
    is_inside,
    make_path,
    read_head,
    read_json,
    translate_remote_errors,
)
from kineme.methods.segmenter import SegmentOptions
from kineme.recordings import Motion, Signals

Entry = tuple[str, Path, str]
"""A recording: its name, its path, and the key of its analysis."""
ANALYSIS = "kineme.library.piece/4"
"""Schema of an analysis; increment the number if the stored content changes."""
NOTHING = "{}: nothing to build from: name recordings or folders"
"""Error for a new library without sources."""
CHUNK = 1 << 20
"""Bytes that are read at a time for a digest."""
_AMC = ".amc"


@dataclass(frozen=True)
class Plan:
    """Sources (old and new) and options of a build.

    ``missing`` are new sources that do not exist; ``recursive`` includes subfolders.
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
        """Return a digest of the version and all options and constants that affect results.

        Raise ParameterError for options that are invalid or that a library cannot store.
        """
        chosen = [self.segment_options.resolved()]
        with suppress(ParameterError):  # a constant that the preset for signals lacks
            chosen.append(self.segment_options.resolved(signals=True))
        presets = [[preset.name, dict(preset.parameters())] for preset in chosen]
        options = [options_to_json(each) for each in (self.read_options, self.segment_options)]
        content = [ANALYSIS, __version__, presets, options]
        return sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()

    def key(self, digest: str) -> str:
        """Return the name of the analysis of a recording whose files have this digest."""
        return sha256(f"{self.options_digest} {digest}".encode()).hexdigest()[:KEY_LENGTH]


def make_plan(
    folder: Path,
    head: Mapping[str, Any],
    sources: Iterable[Path],
    remove: Iterable[Path],
    recursive: bool | None,
    read_options: ReadOptions | None,
    segment_options: SegmentOptions | None,
) -> Plan:
    """Return the plan of a build; arguments that are None are taken from the last build."""
    all_sources = list_sources(folder, sources, remove)
    if not all_sources and not head:
        raise ParameterError(NOTHING.format(folder))
    before = head.get("sources", ())
    missing = [each for each in all_sources if not each.exists() and str(each) not in before]
    former = read_kept_options(folder, head) if head else (ReadOptions(), SegmentOptions())
    return Plan(
        folder,
        tuple(each for each in all_sources if each not in missing),
        missing=tuple(missing),
        recursive=bool(head.get("recursive")) if recursive is None else recursive,
        read_options=read_options or former[0],
        segment_options=segment_options or former[1],
    )


def read_kept_options(folder: Path, head: Mapping[str, Any]) -> tuple[ReadOptions, SegmentOptions]:
    """Return the options in the head of a library; raise ReadError if they are invalid."""
    try:
        read_options = options_from_json(ReadOptions, head["read_options"])
        segment_options = options_from_json(SegmentOptions, head["segment_options"])
        segment_options.resolved()
    except ParameterError as error:
        reason = f"is damaged, build the library again: {error}"
        raise ReadError(folder / HEAD, reason) from error
    return read_options, segment_options


def list_sources(
    into: AnyPath, sources: Iterable[Path] = (), remove: Iterable[Path] = ()
) -> list[Path]:
    """Return the sources of a library with some added and removed, as absolute paths."""
    head = read_json(make_path(into) / HEAD)
    sources = [make_path(each) for each in head.get("sources", ())] + [*map(make_absolute, sources)]
    removed = {*map(make_absolute, remove)}
    unknown = removed - set(sources)
    if unknown:
        raise ParameterError(
            f"{min(unknown)} is not a source of the library; there are "
            f"{', '.join(map(str, sources)) or 'none'}"
        )
    return [path for path in dict.fromkeys(sources) if path not in removed]


def open_folder(into: AnyPath, named: Sequence[Path]) -> Path:
    """Return the folder of a library; create it if missing and any source is named."""
    folder = make_path(into, "build")
    owned = OwnedFolder(folder)
    owned.path(ANALYSES)
    owned.path(TABLES)
    if (folder / HEAD).is_file():
        owned.path(TABLES, read_head(folder)["tables"])
        return folder
    unfinished = (folder / ANALYSES).is_dir()  # the first build was interrupted
    try:
        if folder.exists() and not unfinished and (not folder.is_dir() or any(folder.iterdir())):
            raise WriteError(into, "exists already and is not a library: name a new folder")
        if not named and not unfinished:
            raise ParameterError(NOTHING.format(folder))
        (folder / ANALYSES).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise WriteError(into, f"cannot be created: {error.strerror or error}") from error
    return folder


def as_paths(paths: AnyPath | Iterable[AnyPath]) -> list[Path]:
    """Return one or several paths as a list; raise ParameterError for anything else."""
    if isinstance(paths, str | PathLike):
        return [make_path(paths)]
    if not isinstance(paths, Iterable):
        raise ParameterError(f"build takes paths of recordings or folders, not {paths!r:.60}")
    return [make_path(path, "build") for path in paths]


def list_recordings(sources: Iterable[Path], *, recursive: bool, without: Path) -> dict[Path, Path]:
    """Return the path of each recording in the sources, and the first source that holds it.

    Files in the folder ``without``, that of the library, are left out.
    """
    found: dict[Path, Path] = {}
    for source in sources:
        inside = [source]
        if source.is_dir():
            inside = find_recordings(source, recursive=recursive)
        for path in inside:
            if path.exists() and not is_inside(path, without):
                found.setdefault(path, source)
    return found


def find_recordings(folder: Path, *, recursive: bool) -> list[Path]:
    """Return the recordings in a folder; in a remote one only those of a single file."""
    if not is_remote(folder):
        return scan_folder(folder, recursive=recursive).recordings
    remote: Any = folder
    inside = remote.fs.find(remote.path, maxdepth=None if recursive else 1)
    home = remote.path.rstrip("/") + "/"
    paths = [folder / name.removeprefix(home) for name in sorted(inside)]
    return [path for path in paths if not path.name.startswith(".") and holds_recording(path)]


def name_recordings(found: Mapping[Path, Path], former: Mapping[Path, str]) -> dict[Path, str]:
    """Return a name for each recording: its path in its source, with more folders if not unique.

    Former names are kept.
    """
    names = {path: former[path] for path in found if path in former}
    used = set(names.values())
    for path, source in found.items():
        if path in names:
            continue
        depth = 1 if path == source else len(path.parts) - len(source.parts)
        while (name := "/".join(path.parts[-depth:])) in used and depth < len(path.parts):
            depth += 1
        names[path] = name
        used.add(name)
    return {path: names[path] for path in found}


def read_states(paths: Iterable[Path], skeleton: AnyPath | None) -> dict[Path, str]:
    """Return sizes and times of the files of recordings, to detect changes without reading them.

    Empty if unknown. The state of an AMC includes the skeletons near it.
    """
    skeletons_in = cache(_list_skeletons)

    def state(path: Path) -> str:
        if path.is_dir():
            return _read_state(sorted(path.iterdir()))
        if skeleton is not None:
            return _read_state([path, Path(skeleton)])
        if path.suffix.lower() != _AMC:
            return _read_state([path])
        home = path.parent
        near = [skeletons_in(each) for each in (home, home / "asf", home.parent / "asf")]
        return " ".join([_read_state([path]), *near]).strip()

    states = dict.fromkeys(paths, "")
    for path in states:
        with suppress(OSError):
            states[path] = state(path)
    return states


def _read_state(files: Iterable[Path]) -> str:
    stats = ((file.name, file.stat()) for file in files)
    return " ".join(f"{name}:{found.st_size}:{found.st_mtime_ns}" for name, found in stats)


def _list_skeletons(folder: Path) -> str:
    try:
        files = sorted(file for file in folder.iterdir() if file.suffix.lower() == ".asf")
    except OSError:
        return ""
    return sha256(_read_state(files).encode()).hexdigest()[:16] if files else ""


def measure_size(path: Path) -> int:
    """Return the size of a recording in bytes; 0 if unknown."""
    try:
        files = path.iterdir() if path.is_dir() else [path]
        return sum(file.stat().st_size for file in files)
    except OSError:
        return 0


def compute_digest(path: Path, skeleton: AnyPath | None) -> str:
    """Return the SHA-256 of a recording's files and of its suffix, which selects the format."""
    digest = sha256(path.suffix.lower().encode())
    try:
        for file in list_files(path, skeleton):
            refuse_pipe(file)
            of_file = sha256()
            with file.open("rb") as content:
                while chunk := content.read(CHUNK):
                    of_file.update(chunk)
            digest.update(of_file.digest())
    except OSError as error:
        raise ReadError(path, f"cannot be opened: {error.strerror or error}") from error
    return digest.hexdigest()


def list_files(path: Path, skeleton: AnyPath | None) -> list[Path]:
    """Return the files of a recording, the main one first."""
    if path.is_dir():
        return [file for _, file in list_frame_files(path)]
    if skeleton is not None:
        return [path, Path(skeleton)]
    if path.suffix.lower() != _AMC:
        return [path]
    try:
        return [path, find_skeleton(path)]
    except ReadError:  # the reader will report the missing skeleton
        return [path]


def read_recording(path: Path, options: ReadOptions) -> Motion | Signals:
    """Read a local or remote recording; warn like `kineme.read`."""
    if not is_remote(path):
        return read(path, **vars(options))
    with fetch(path, options.skeleton) as local:
        recording = read(local, **vars(options))
    return replace(recording, provenance=replace(recording.provenance, path=str(path)))


@contextmanager
def fetch(path: Path, skeleton: AnyPath | None) -> Iterator[Path]:
    """Provide a local copy of a recording, with the skeleton of an AMC beside it.

    Errors in the block name the original ``path``.
    """
    if not is_remote(path):
        yield path
        return
    with TemporaryDirectory(prefix="kineme-") as home:
        with translate_remote_errors(path):
            files = [path]
            if path.suffix.lower() == _AMC and skeleton is None:
                files.append(find_skeleton(path))
            for file in files:
                (Path(home) / file.name).write_bytes(file.read_bytes())
        try:
            yield Path(home) / path.name
        except FileError as error:
            raise ReadError(path, error.reason) from error
