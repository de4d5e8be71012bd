"""Recordings wherever they are: which files they are read from, listed, named and read."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import replace
from functools import cache
from hashlib import sha256
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from kineme._util.files import AnyPath, refuse_pipe
from kineme.errors import FileError, ReadError
from kineme.formats import ReadOptions, read
from kineme.formats.keypoints.openpose import frame_files
from kineme.formats.listing import holds_recording, recordings_in
from kineme.formats.skeletons.amc import find_skeleton
from kineme.library.storage.places import is_remote, lies_in, reaching
from kineme.recordings import Motion, Signals

CHUNK = 1 << 20
"""Bytes that are digested at a time."""
_AMC = ".amc"


def files_of(path: Path, skeleton: AnyPath | None) -> list[Path]:
    """Return the files that a recording is read from, its own first."""
    if path.is_dir():
        return [file for _, file in frame_files(path)]
    if skeleton is not None:
        return [path, Path(skeleton)]
    if path.suffix.lower() != _AMC:
        return [path]
    try:
        return [path, find_skeleton(path)]
    except ReadError:  # its reader will say so
        return [path]


def size_of(path: Path) -> int:
    """Return the bytes of a recording; 0 where they cannot be told."""
    try:
        files = path.iterdir() if path.is_dir() else [path]
        return sum(file.stat().st_size for file in files)
    except OSError:
        return 0


def content_digest(path: Path, skeleton: AnyPath | None) -> str:
    """SHA-256 of what a recording is read from, and of its suffix, which tells the format."""
    digest = sha256(path.suffix.lower().encode())
    try:
        for file in files_of(path, skeleton):
            refuse_pipe(file)
            of_file = sha256()
            with file.open("rb") as content:
                while chunk := content.read(CHUNK):
                    of_file.update(chunk)
            digest.update(of_file.digest())
    except OSError as error:
        raise ReadError(path, f"cannot be opened: {error.strerror or error}") from error
    return digest.hexdigest()


def states_of(paths: Iterable[Path], skeleton: AnyPath | None) -> dict[Path, str]:
    """Sizes and times of the files of recordings: whether they changed, without reading them.

    Empty where that cannot be told. With an AMC go the skeletons near it.
    """
    skeletons_in = cache(_skeletons_in)

    def state(path: Path) -> str:
        if path.is_dir():
            return _state(sorted(path.iterdir()))
        if skeleton is not None:
            return _state([path, Path(skeleton)])
        if path.suffix.lower() != _AMC:
            return _state([path])
        home = path.parent
        near = [skeletons_in(each) for each in (home, home / "asf", home.parent / "asf")]
        return " ".join([_state([path]), *near]).strip()

    states = dict.fromkeys(paths, "")
    for path in states:
        with suppress(OSError):
            states[path] = state(path)
    return states


def list_recordings(sources: Iterable[Path], *, recursive: bool, without: Path) -> dict[Path, Path]:
    """Return each recording in the sources, an absolute path, and the first source it was found in.

    Files ``without`` are left out: those of the library itself.
    """
    found: dict[Path, Path] = {}
    for source in sources:
        inside = [source]
        if source.is_dir():
            inside = recordings_under(source, recursive=recursive)
        for path in inside:
            if path.exists() and not lies_in(path, without):
                found.setdefault(path, source)
    return found


def names_of(found: Mapping[Path, Path], former: Mapping[Path, str]) -> dict[Path, str]:
    """A name for each recording: its path in its source, with more folders where two are equal.

    Names that are given already stay.
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


def _state(files: Iterable[Path]) -> str:
    stats = ((file.name, file.stat()) for file in files)
    return " ".join(f"{name}:{found.st_size}:{found.st_mtime_ns}" for name, found in stats)


def _skeletons_in(folder: Path) -> str:
    try:
        files = sorted(file for file in folder.iterdir() if file.suffix.lower() == ".asf")
    except OSError:
        return ""
    return sha256(_state(files).encode()).hexdigest()[:16] if files else ""


def recordings_under(folder: Path, *, recursive: bool) -> list[Path]:
    """Return the recordings in a folder; elsewhere, only such as are one file."""
    if not is_remote(folder):
        return recordings_in(folder, recursive=recursive).recordings
    remote: Any = folder
    inside = remote.fs.find(remote.path, maxdepth=None if recursive else 1)
    home = remote.path.rstrip("/") + "/"
    paths = [folder / name.removeprefix(home) for name in sorted(inside)]
    return [path for path in paths if not path.name.startswith(".") and holds_recording(path)]


@contextmanager
def fetch(path: Path, skeleton: AnyPath | None) -> Iterator[Path]:
    """A recording on this machine, with the skeleton of an AMC beside it, as long as the block.

    What is wrong with it is said of ``path``.
    """
    if not is_remote(path):
        yield path
        return
    files = [path]
    with TemporaryDirectory(prefix="kineme-") as home:
        with reaching(path):
            if path.suffix.lower() == ".amc" and skeleton is None:
                files.append(find_skeleton(path))
            for file in files:
                (Path(home) / file.name).write_bytes(file.read_bytes())
        try:
            yield Path(home) / path.name
        except FileError as error:
            raise ReadError(path, error.reason) from error


def read_at(path: Path, options: ReadOptions) -> Motion | Signals:
    """Return the recording at a place, with a warning as `kineme.read` gives it."""
    if not is_remote(path):
        return read(path, **vars(options))
    with fetch(path, options.skeleton) as here:
        found = read(here, **vars(options))
    return replace(found, provenance=replace(found.provenance, path=str(path)))
