"""Recordings wherever they are: listed, brought near, and read."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from kineme.errors import FileError, ReadError
from kineme.formats import read
from kineme.formats.listing import holds_recording, recordings_in
from kineme.formats.options import AnyPath
from kineme.formats.skeletons.amc import find_skeleton
from kineme.library.storage.places import is_remote, reaching
from kineme.recordings import Motion, Signals


def recordings_under(folder: Path, *, recursive: bool) -> list[Path]:
    """The recordings in a folder; elsewhere, only such as are one file."""
    if not is_remote(folder):
        return recordings_in(folder, recursive=recursive).recordings
    there: Any = folder
    inside = there.fs.find(there.path, maxdepth=None if recursive else 1)
    home = there.path.rstrip("/") + "/"
    paths = [folder / name.removeprefix(home) for name in sorted(inside)]
    return [path for path in paths if not path.name.startswith(".") and holds_recording(path)]


@contextmanager
def fetched(path: Path, skeleton: AnyPath | None) -> Iterator[Path]:
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


def read_at(path: Path, reading: Mapping[str, Any]) -> Motion | Signals:
    """The recording at a place, with keywords of `kineme.read`."""
    if not is_remote(path):
        return read(path, **reading)
    with fetched(path, reading.get("skeleton")) as here:
        found = read(here, **reading)
    return replace(found, provenance=replace(found.provenance, path=str(path)))
