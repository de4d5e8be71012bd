"""Paths of results: a file, a folder, or a pattern with ``{name}`` and ``{parent}``.

The rules are the same for every command. A folder (an existing one, or a path without suffix) gets
one file per recording, named after it. ``{name}`` is replaced by the recording's name, ``{parent}``
by the name of its folder. Recordings with the same name are distinguished by their folders:
``a/take.bvh`` and ``b/take.bvh`` become ``a_take`` and ``b_take``.

Folders are created, but the parent of the topmost new one must exist.
"""

from __future__ import annotations

import os
import re
from collections import Counter
from pathlib import Path

import typer

from kineme._util.files import CORRECTED, make_person_suffix
from kineme.errors import ReadError, WriteError
from kineme.labels.delimited import read_columns

NAME, PARENT = "{name}", "{parent}"
PICTURES = (".png", ".pdf", ".svg")
PAGES = (".html", ".htm")

_FIELD = re.compile(r"\{(name|parent)\}")


def choose_files(option: str, target: Path, inputs: list[Path], suffix: str = "") -> list[Path]:
    """Return one path per recording, none of which is a recording itself."""
    pattern = target / f"{NAME}{suffix}" if _is_folder(target) else target
    paths = _fill_patterns(option, pattern, inputs)
    recordings = {path.resolve() for path in inputs}
    for path in paths:
        if path.resolve() in recordings:
            raise typer.BadParameter(
                f"{path} would overwrite a recording: give another folder or name",
                param_hint=option,
            )
    check_target_folder(pattern)
    return paths


def choose_folders(option: str, target: Path, inputs: list[Path], *, single: bool) -> list[Path]:
    """Return one folder per recording; a single recording gets the given one."""
    if single and not _FIELD.search(str(target)):
        return [target]
    pattern = target if _FIELD.search(str(target)) else target / NAME
    paths = _fill_patterns(option, pattern, inputs)
    check_target_folder(pattern)
    return paths


def find_tables(option: str, source: Path, inputs: list[Path], person: str = "") -> list[Path]:
    """Return the table of each recording: one for all, from a pattern, or from a folder by name.

    In a folder, the table of this ``person`` is preferred.
    """
    if not _is_folder(source):
        is_shared = "recording" in read_columns(source)  # one table for several recordings
        return [source] * len(inputs) if is_shared else _fill_patterns(option, source, inputs)
    if not source.exists() and not _FIELD.search(str(source)):
        raise ReadError(source, "there is no such file or folder")
    recordings, paths = set(inputs), _fill_patterns(option, source / NAME, inputs)
    tables = [_find_table_file(path, recordings) for path in paths]
    if not person:
        return tables
    person_tables = [
        _find_table_file(path.with_name(f"{path.name}{make_person_suffix(person)}"), recordings)
        for path in paths
    ]
    return [
        person_table if person_table.exists() or not table.exists() else table
        for person_table, table in zip(person_tables, tables, strict=True)
    ]


def check_target_folder(pattern: Path) -> None:
    """Raise WriteError if the folder for all results cannot be created."""
    folder = pattern.parent
    while _FIELD.search(str(folder)):
        folder = folder.parent
    if not folder.exists() and not folder.parent.is_dir():
        reason = f"the folder {folder} cannot be created: there is no {folder.parent}"
        raise WriteError(pattern, reason)


def check_writable(
    table: Path | None = None, picture: Path | None = None, page: Path | None = None
) -> None:
    """Raise WriteError for results that cannot be written, before any work is done.

    Creates their folders.
    """
    from kineme.labels import list_written_suffixes

    for path, suffixes in ((table, list_written_suffixes()), (picture, PICTURES), (page, PAGES)):
        if path is None:
            continue
        if path.suffix.lower() not in suffixes:
            raise WriteError(path, f"the suffix must be one of {', '.join(suffixes)}")
        make_parent_folder(path)


def make_parent_folder(path: Path) -> None:
    """Create the folder of a file or folder; WriteError if that is impossible."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        reason = f"the folder {path.parent} cannot be created: {error.strerror}"
        raise WriteError(path, reason) from error
    if not os.access(path.parent, os.W_OK):
        raise WriteError(path, f"no permission to write to the folder {path.parent}")


def make_absolute(path: Path) -> Path:
    """Return the absolute path without resolving links, so that given names are kept."""
    return Path(os.path.abspath(path))  # noqa: PTH100


def _is_folder(path: Path) -> bool:
    return path.is_dir() or not path.suffix


def _fill_patterns(option: str, pattern: Path, inputs: list[Path]) -> list[Path]:
    """Return the pattern filled in for each recording; the results are unique."""
    if len(inputs) > 1 and not _FIELD.search(str(pattern)):
        raise typer.BadParameter(
            f"one file for {len(inputs)} recordings; give a folder or a name with {NAME} in it",
            param_hint=option,
        )
    names, folders = _make_names(inputs), [make_absolute(path).parts[1:-1] for path in inputs]
    depths = [0] * len(inputs)
    while True:
        paths = [
            _fill_pattern(pattern, name, folder, depth)
            for name, folder, depth in zip(names, folders, depths, strict=True)
        ]
        counts = Counter(paths)
        ambiguous = [i for i, path in enumerate(paths) if counts[path] > 1]
        deeper = [i for i in ambiguous if depths[i] < len(folders[i])]
        if not deeper:
            break
        # Tell ambiguous names apart by one more of their parent folders.
        for i in deeper:
            depths[i] += 1
    if ambiguous:
        raise typer.BadParameter(
            f"several recordings would be written to {paths[ambiguous[0]]}: put {NAME} in the name",
            param_hint=option,
        )
    return paths


def _make_names(inputs: list[Path]) -> list[str]:
    """Return names without suffixes; keep suffixes of files that differ in nothing else."""
    count = Counter(path.with_suffix("") for path in inputs)
    return [
        path.name
        if path.is_dir()
        else path.stem + path.suffix.replace(".", "_") * (count[path.with_suffix("")] > 1)
        for path in inputs
    ]


def _fill_pattern(pattern: Path, name: str, folders: tuple[str, ...], depth: int) -> Path:
    """Return the pattern with a recording's name and folder, and ``depth`` more parents."""
    if PARENT in str(pattern):
        parent = "_".join(folders[-1 - depth :])
    else:
        parent, name = "", "_".join((*folders[len(folders) - depth :], name))
    values = {"name": name, "parent": parent}
    return Path(_FIELD.sub(lambda field: values[field[1]], str(pattern)))


def _find_table_file(path: Path, recordings: set[Path]) -> Path:
    """Return the first existing table with this name, but no recording."""
    from kineme.labels import list_written_suffixes

    candidates = [
        path.with_name(path.name + suffix) for suffix in (CORRECTED, *list_written_suffixes())
    ]
    files = (file for file in candidates if file.is_file() and file not in recordings)
    return next(files, candidates[0])
