"""Process FILES, recordings or folders of recordings, and choose the paths of their results.

The rules are the same for every command. An error with one recording does not stop the others and
is reported at the end, with name and reason. The exit code is 1 if a file or folder named by the
user gave no result, or if a result could not be written.

A result goes to a file, a folder, or a pattern with ``{name}`` and ``{parent}``. A folder (an
existing one, or a path without suffix) gets one file per recording, named after it. ``{name}`` is
replaced by the recording's name, ``{parent}`` by the name of its folder. Recordings with the same
name are distinguished by their folders: ``a/take.bvh`` and ``b/take.bvh`` become ``a_take`` and
``b_take``. Folders are created, but the parent of the topmost new one must exist.
"""

from __future__ import annotations

import os
import re
from collections import Counter
from collections.abc import Callable, Collection, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import Annotated

import typer

from kineme._util.files import (
    CORRECTED,
    PAGES,
    PICTURES,
    add_person,
    make_absolute,
    make_person_suffix,
)
from kineme.cli.help import INPUT, RECORDINGS, option
from kineme.cli.options import expand_read_options
from kineme.cli.terminal import format_line, print_error, print_skipped, show_progress
from kineme.errors import KinemeError, ReadError, WriteError
from kineme.formats.listing import scan_folder
from kineme.formats.options import ReadOptions

Files = Annotated[
    list[Path],
    typer.Argument(
        metavar="FILES", help="Recordings, or folders of them (formats: kineme info --help)."
    ),
]
FilesOfFormats = Annotated[
    list[Path],
    typer.Argument(metavar="FILES", help=f"Recordings, or folders of them: {RECORDINGS}."),
]
Recursive = Annotated[bool, option(INPUT, "Include subfolders.", "--recursive", "-r")]
SegmentTable = Annotated[
    Path | None,
    option(
        INPUT,
        "Use segments of a table or label file; for several recordings, a folder or a path "
        "with {name}.",
    ),
]

SKELETON, MOTION = ".asf", ".amc"
"""Suffixes of motions in two files; ``*`` in a shell gives both."""
NAME, PARENT = "{name}", "{parent}"
_FIELD = re.compile(r"\{(name|parent)\}")


class Batch:
    """Recordings of a command, from files and folders; each may fail separately."""

    def __init__(self, inputs: list[Path], *, recursive: bool = False, quiet: bool = False):
        self._quiet = quiet
        self._missing = set(inputs)  # without any result yet
        self._unwritten = False
        self._messages: list[tuple[Callable[[str], None], str]] = []
        self._count = 0
        self._origins: dict[Path, set[Path]] = {}  # inputs that contain a recording
        self._tables: dict[tuple[str, Path | None, str], dict[Path, Path | None]] = {}
        self.paths: list[Path] = []
        if Path("-") in inputs and not Path("-").exists():
            raise typer.BadParameter(
                "recordings cannot be read from standard input: save it as a file such as "
                "take.bvh or take.csv and give its name",
                param_hint="FILES",
            )
        with_motions = {path.parent for path in inputs if path.suffix.lower() == MOTION}
        for path in inputs:
            if path.suffix.lower() == SKELETON and path.parent in with_motions:
                self._missing.discard(path)  # the motions beside it read it
                continue
            paths = self._list_recordings(path, recursive=recursive) if path.is_dir() else [path]
            for recording in paths:
                origins = self._origins.setdefault(make_absolute(recording), set())
                if not origins:
                    self.paths.append(recording)
                origins.add(path)

    @property
    def single(self) -> bool:
        """Whether there is one recording, named by the user."""
        return len(self.paths) == 1 and self._is_named(self.paths[0])

    def join(self) -> list[Path]:
        """Return all recordings; afterwards the first one stands for all of them."""
        paths = self.paths
        if len(paths) > 1:
            self.paths = paths[:1]
            first = self._origins[make_absolute(paths[0])]
            for path in paths[1:]:
                first |= self._origins[make_absolute(path)]
        return paths

    def targets(self, option: str, target: Path | None, suffix: str) -> list[Path | None]:
        """Return where the result of each recording goes; see `kineme.cli.files`."""
        if target is None:
            return [None] * len(self.paths)
        return [*self.files(option, target, suffix)]

    def files(self, option: str, target: Path, suffix: str = "") -> list[Path]:
        """Return where results go for an option that is always set."""
        with self._exit_on_error():
            return choose_files(option, target, self.paths, suffix)

    def folders(self, option: str, target: Path) -> list[Path]:
        """Return the folder for each recording; a single recording gets the given one."""
        with self._exit_on_error():
            return choose_folders(option, target, self.paths, single=self.single)

    def tables(self, option: str, source: Path | None, person: str = "") -> list[Path | None]:
        """Return the table or label file of each recording, or of this person in it."""
        if source is None:
            return [None] * len(self.paths)
        with self._exit_on_error():
            return [*find_tables(option, source, self.paths, person)]

    def table(self, path: Path, option: str, source: Path | None, person: str = "") -> Path | None:
        """Return the entry of `tables` for one recording."""
        key = option, source, person
        if key not in self._tables:
            tables = self.tables(option, source, person)
            self._tables[key] = dict(zip(self.paths, tables, strict=True))
        return self._tables[key][path]

    def run_each_person(
        self,
        path: Path,
        read_options: ReadOptions,
        work: Callable[..., None],
        *targets: Path | None,
        tables: tuple[str, Path | None] = ("", None),
    ) -> None:
        """Call ``work`` for each selected person or take in a recording; once by default.

        It gets the path, the reading options, the person's table, and the targets with the name of
        the person or take. ``tables`` is the option that names the table, and its path. A ReadError
        does not stop the others; the first one is raised at the end.
        """
        with self.catch_errors(path):
            failures = []
            for suffix, options in expand_read_options(path, read_options):
                table = self.table(path, *tables, options.person or "")
                person_targets = [target and add_person(target, suffix) for target in targets]
                try:
                    work(path, options, table, *person_targets)
                except ReadError as error:
                    failures.append(error)
            if failures:
                raise failures[0]

    @contextmanager
    def catch_errors(self, path: Path) -> Iterator[None]:
        """Keep an error with a recording in the block for the report at the end."""
        self._count += 1
        try:
            yield
        except KinemeError as error:
            unwritten = isinstance(error, WriteError)  # not caused by the recording
            self._unwritten |= unwritten
            report = print_error if unwritten or self._is_named(path) else print_skipped
            self._messages.append((report, format_line(error, subject=path)))
        else:
            self._missing -= self._origins[make_absolute(path)]

    @contextmanager
    def catch_result_errors(self, subject: object = "") -> Iterator[None]:
        """Keep an error with the common result of all recordings for the report at the end."""
        try:
            yield
        except KinemeError as error:
            self._unwritten = True
            self._messages.append((print_error, format_line(error, subject=subject)))

    def leave_out(self, path: Path, reason: str) -> None:
        """Report why a readable recording is not part of the result."""
        is_named = self._is_named(path)
        self._messages.append((print_error if is_named else print_skipped, f"{path}: {reason}"))
        self._missing |= {path} if is_named else set()

    def progress(self, path: Path) -> AbstractContextManager[Callable[[str], None]]:
        """Return a function that shows the current stage of this recording."""
        position = f" ({self._count} of {len(self.paths)})" if len(self.paths) > 1 else ""
        return show_progress(f"{path.name}{position}", quiet=self._quiet)

    def exit(self) -> None:
        """Print what was skipped and why.

        Exit with code 1 if anything named by the user gave no result, or a result was not written.
        """
        for report, text in self._messages:
            report(text)
        if self._missing or self._unwritten:
            raise typer.Exit(1)

    def _list_recordings(self, folder: Path, *, recursive: bool) -> list[Path]:
        """Return the recordings in a folder; keep messages on what was left out."""
        listing = scan_folder(folder, recursive=recursive)
        self._messages += [
            (print_skipped, f"{path}: {reason}") for path, reason in listing.passed_over
        ]
        names = ", ".join(path.name for path in listing.folders[:3])
        more = ", …" if len(listing.folders) > 3 else ""
        hint = f"--recursive looks into its folders ({names}{more})" if names else ""
        if not listing.recordings:
            if folder not in (path for path, _ in listing.passed_over):
                has_skeleton = any(path.suffix.lower() == SKELETON for path in folder.iterdir())
                why = "a skeleton (.asf) needs the motion (.amc) beside it" if has_skeleton else ""
                reasons = filter(None, ("there is no recording in this folder", why, hint))
                self._messages.append((print_error, f"{folder}: {'; '.join(reasons)}"))
        elif hint:
            self._messages.append((print_skipped, f"{folder}: {hint}"))
        return listing.recordings

    def _is_named(self, path: Path) -> bool:
        """Return whether the user named this recording itself, not only its folder."""
        absolute = make_absolute(path)
        return any(make_absolute(origin) == absolute for origin in self._origins[absolute])

    @contextmanager
    def _exit_on_error(self) -> Iterator[None]:
        """Exit if no result can be written, or no table can be found for any recording."""
        try:
            yield
        except (ReadError, WriteError) as error:
            self._messages.append((print_error, format_line(error)))
            self._missing.add(Path(error.path))
            self.exit()


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
        from kineme.labels.csv_table import lists_recordings

        is_shared = lists_recordings(source)  # one table for several recordings
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

    Creates their folders. Raise typer.BadParameter if a suffix is wrong.
    """
    check_suffixes(table, picture, page)
    for path in filter(None, (table, picture, page)):
        make_parent_folder(path)


def check_suffixes(
    table: Path | None = None, picture: Path | None = None, page: Path | None = None
) -> None:
    """Raise typer.BadParameter for results whose suffix names no format that can be written."""
    from kineme.labels import list_written_suffixes

    check_suffix("", table, list_written_suffixes())
    check_suffix("", picture, PICTURES)
    check_suffix("", page, PAGES)


def check_suffix(option: str, path: Path | None, suffixes: Collection[str]) -> None:
    """Raise typer.BadParameter, which names the option, for a path with another suffix."""
    if path is not None and path.suffix.lower() not in suffixes:
        raise typer.BadParameter(
            f"{path}: the suffix must be one of {', '.join(suffixes)}", param_hint=option or None
        )


def make_parent_folder(path: Path) -> None:
    """Create the folder of a file or folder; WriteError if that is impossible."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        reason = f"the folder {path.parent} cannot be created: {error.strerror}"
        raise WriteError(path, reason) from error
    if not os.access(path.parent, os.W_OK):
        raise WriteError(path, f"no permission to write to the folder {path.parent}")


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
