"""Where results go: a file, a folder, or a pattern with ``{name}`` in it."""

from __future__ import annotations

import os
from pathlib import Path

import typer

from kineme.errors import WriteError
from kineme.labels import written_suffixes

NAME = "{name}"
PICTURES = (".png", ".pdf", ".svg")
PAGES = (".html", ".htm")


def targets(option: str, given: Path | None, inputs: list[Path], suffix: str) -> list[Path | None]:
    """One path per input; None for each where the option was not given.

    A folder (one that exists, or any path without a suffix) gets
    ``NAME`` + ``suffix`` for every input and is made if it is not there.
    ``{name}`` in a file's name stands for the input's name.
    """
    if given is None:
        return [None] * len(inputs)
    if given.is_dir() or not given.suffix:
        given = given / f"{NAME}{suffix}"
    elif len(inputs) > 1 and NAME not in given.name:
        raise typer.BadParameter(
            f"one file for {len(inputs)} recordings; give a folder or a name with {NAME} in it",
            param_hint=option,
        )
    paths = [given.with_name(given.name.replace(NAME, path.stem)) for path in inputs]
    if len(set(paths)) < len(paths):
        twice = next(path for path in paths if paths.count(path) > 1)
        raise typer.BadParameter(f"several recordings would become {twice}", param_hint=option)
    given_files = {path.resolve() for path in inputs}
    for path in paths:
        if path.resolve() in given_files:
            raise typer.BadParameter(
                f"{path} would take the place of a recording; give another folder or name",
                param_hint=option,
            )
    return list(paths)


def check_writable(
    table: Path | None = None, picture: Path | None = None, page: Path | None = None
) -> None:
    """WriteError for results that could not be written, before any work is done.

    Makes the folder they go to if its own parent is there.
    """
    for path, suffixes in ((table, written_suffixes()), (picture, PICTURES), (page, PAGES)):
        if path is None:
            continue
        if path.suffix.lower() not in suffixes:
            raise WriteError(path, f"the suffix must be one of {', '.join(suffixes)}")
        try:
            path.parent.mkdir(exist_ok=True)
        except OSError as error:
            reason = f"the folder {path.parent} cannot be made: {error.strerror}"
            raise WriteError(path, reason) from error
        if not os.access(path.parent, os.W_OK):
            raise WriteError(path, f"the folder {path.parent} may not be written to")
