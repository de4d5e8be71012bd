"""Where results go: a file, a folder, or a pattern with ``{name}`` and ``{parent}`` in it.

One rule for every command. A folder, one that exists or any path without a suffix, gets a
file per recording, called as that is. ``{name}`` stands for the recording's name,
``{parent}`` for its folder's. Recordings of one name are told apart by their folders:
``a/take.bvh`` and ``b/take.bvh`` become ``a_take`` and ``b_take``.

Folders are made; that which is to hold all of them must have a folder to lie in.
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


def choose_files(option: str, given: Path, inputs: list[Path], suffix: str = "") -> list[Path]:
    """One path per recording, none of which is a recording itself."""
    pattern = given / f"{NAME}{suffix}" if _is_folder(given) else given
    paths = _fill_patterns(option, pattern, inputs)
    recordings = {path.resolve() for path in inputs}
    for path in paths:
        if path.resolve() in recordings:
            raise typer.BadParameter(
                f"{path} would take the place of a recording; give another folder or name",
                param_hint=option,
            )
    check_target_folder(pattern)
    return paths


def choose_folders(option: str, given: Path, inputs: list[Path], *, single: bool) -> list[Path]:
    """One folder per recording: the one given for a single one, else one of its own in it."""
    if single and not _FIELD.search(str(given)):
        return [given]
    pattern = given if _FIELD.search(str(given)) else given / NAME
    paths = _fill_patterns(option, pattern, inputs)
    check_target_folder(pattern)
    return paths


def find_tables(option: str, given: Path, inputs: list[Path], person: str = "") -> list[Path]:
    """Return table of each recording: a file of all, by a pattern, or that of its name in a folder.

    In a folder that of this ``person`` in it, where there is one.
    """
    if not _is_folder(given):
        of_all = "recording" in read_columns(given)  # a table that says whose each row is
        return [given] * len(inputs) if of_all else _fill_patterns(option, given, inputs)
    if not given.exists() and not _FIELD.search(str(given)):
        raise ReadError(given, "there is no such file or folder")
    recordings, paths = set(inputs), _fill_patterns(option, given / NAME, inputs)
    usual = [_find_table_file(path, recordings) for path in paths]
    if not person:
        return usual
    named = [
        _find_table_file(path.with_name(f"{path.name}{make_person_suffix(person)}"), recordings)
        for path in paths
    ]
    return [
        one if one.exists() or not other.exists() else other
        for one, other in zip(named, usual, strict=True)
    ]


def check_target_folder(pattern: Path) -> None:
    """WriteError where the folder that is to hold all results has none to lie in."""
    fixed = pattern.parent
    while _FIELD.search(str(fixed)):
        fixed = fixed.parent
    if not fixed.exists() and not fixed.parent.is_dir():
        reason = f"the folder {fixed} cannot be made: there is no {fixed.parent}"
        raise WriteError(pattern, reason)


def check_writable(
    table: Path | None = None, picture: Path | None = None, page: Path | None = None
) -> None:
    """WriteError for results that could not be written, before any work is done.

    Makes the folders that they go to.
    """
    from kineme.labels import list_written_suffixes

    for path, suffixes in ((table, list_written_suffixes()), (picture, PICTURES), (page, PAGES)):
        if path is None:
            continue
        if path.suffix.lower() not in suffixes:
            raise WriteError(path, f"the suffix must be one of {', '.join(suffixes)}")
        make_parent_folder(path)


def make_parent_folder(path: Path) -> None:
    """Make the folder that a file or a folder is to lie in; WriteError if that cannot be."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        reason = f"the folder {path.parent} cannot be made: {error.strerror}"
        raise WriteError(path, reason) from error
    if not os.access(path.parent, os.W_OK):
        raise WriteError(path, f"the folder {path.parent} may not be written to")


def make_absolute(path: Path) -> Path:
    """Return the path from the root, under the names that it was given: links are not followed."""
    return Path(os.path.abspath(path))  # noqa: PTH100


def _is_folder(given: Path) -> bool:
    return given.is_dir() or not given.suffix


def _fill_patterns(option: str, pattern: Path, inputs: list[Path]) -> list[Path]:
    """Return the pattern filled in for each recording, all of them different."""
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
        count = Counter(paths)
        clashing = [i for i, path in enumerate(paths) if count[path] > 1]
        deeper = [i for i in clashing if depths[i] < len(folders[i])]
        if not deeper:
            break
        for i in deeper:
            depths[i] += 1
    if clashing:
        raise typer.BadParameter(
            f"several recordings would become {paths[clashing[0]]}; put {NAME} in it",
            param_hint=option,
        )
    return paths


def _make_names(inputs: list[Path]) -> list[str]:
    """Names without suffixes, but for recordings that differ in nothing else."""
    count = Counter(path.with_suffix("") for path in inputs)
    return [
        path.name
        if path.is_dir()
        else path.stem + path.suffix.replace(".", "_") * (count[path.with_suffix("")] > 1)
        for path in inputs
    ]


def _fill_pattern(pattern: Path, name: str, folders: tuple[str, ...], depth: int) -> Path:
    """Return the pattern with a recording's name and folder, and more of its folders the deeper."""
    if PARENT in str(pattern):
        parent = "_".join(folders[-1 - depth :])
    else:
        parent, name = "", "_".join((*folders[len(folders) - depth :], name))
    values = {"name": name, "parent": parent}
    return Path(_FIELD.sub(lambda field: values[field[1]], str(pattern)))


def _find_table_file(path: Path, recordings: set[Path]) -> Path:
    """Return the first file of a name, with one of the suffixes of tables, that is no recording."""
    from kineme.labels import list_written_suffixes

    candidates = [
        path.with_name(path.name + suffix) for suffix in (CORRECTED, *list_written_suffixes())
    ]
    files = (file for file in candidates if file.is_file() and file not in recordings)
    return next(files, candidates[0])
