"""What is given as FILES: recordings, or folders of them, gone through one by one.

One rule for every command: what is wrong with one recording costs that one only and is
said at the end, by name and reason. The exit code is 1 where something asked for by name,
a file or a folder, gave nothing, and where a result could not be written, as on a full disk.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from kineme._util.files import add_person
from kineme.cli.help import INPUT, RECORDINGS, option
from kineme.cli.messages import format_line, print_error, print_skipped, show_progress
from kineme.cli.options.reading import expand_read_options
from kineme.cli.options.targets import choose_files, choose_folders, find_tables, make_absolute
from kineme.errors import KinemeError, ReadError, WriteError

if TYPE_CHECKING:
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
Recursive = Annotated[
    bool, option(INPUT, "Look into the folders of a folder, too.", "--recursive", "-r")
]
SegmentTable = Annotated[
    Path | None,
    option(
        INPUT,
        "Take segments from a table or labels; of several recordings from a folder, or a path "
        "with {name}.",
    ),
]

SKELETON, MOTION = ".asf", ".amc"
"""Of what lies in two files, which ``*`` gives both of."""


class Batch:
    """Recordings of a command, given by themselves or by folder; each may fail by itself."""

    def __init__(self, given: list[Path], *, recursive: bool = False, quiet: bool = False):
        self._quiet = quiet
        self._missing = set(given)
        self._unwritten = False
        self._messages: list[tuple[Callable[[str], None], str]] = []
        self._at = 0
        self._given_as: dict[Path, set[Path]] = {}
        self._tables: dict[tuple[str, Path | None, str], dict[Path, Path | None]] = {}
        self.paths: list[Path] = []
        if Path("-") in given and not Path("-").exists():
            raise typer.BadParameter(
                "recordings are not read from standard input, for a file's name tells what it "
                "is: save it as one, such as take.bvh or take.csv, and name that",
                param_hint="FILES",
            )
        with_motions = {path.parent for path in given if path.suffix.lower() == MOTION}
        for path in given:
            if path.suffix.lower() == SKELETON and path.parent in with_motions:
                self._missing.discard(path)  # read with the motions beside it
                continue
            found = self._recordings_in(path, recursive=recursive) if path.is_dir() else [path]
            for recording in found:
                origins = self._given_as.setdefault(make_absolute(recording), set())
                if not origins:
                    self.paths.append(recording)
                origins.add(path)

    @property
    def single(self) -> bool:
        """Return whether there is one recording, given by its own name."""
        return len(self.paths) == 1 and self._is_named(self.paths[0])

    def join(self) -> list[Path]:
        """Return all recordings, of which the first stands for all from now on."""
        together = self.paths
        if len(together) > 1:
            self.paths = together[:1]
            first = self._given_as[make_absolute(together[0])]
            for path in together[1:]:
                first |= self._given_as[make_absolute(path)]
        return together

    def targets(self, option: str, given: Path | None, suffix: str) -> list[Path | None]:
        """Where the result of each recording goes; see `kineme.cli.options.targets`."""
        if given is None:
            return [None] * len(self.paths)
        return [*self.files(option, given, suffix)]

    def files(self, option: str, given: Path, suffix: str = "") -> list[Path]:
        """Return the same where the option is never left out."""
        with self._nothing_without():
            return choose_files(option, given, self.paths, suffix)

    def folders(self, option: str, given: Path) -> list[Path]:
        """Return the folder that each recording gets; the one given where it is a single one's."""
        with self._nothing_without():
            return choose_folders(option, given, self.paths, single=self.single)

    def tables(self, option: str, given: Path | None, person: str = "") -> list[Path | None]:
        """Return table or label file that belongs to each recording, or to this person in it."""
        if given is None:
            return [None] * len(self.paths)
        with self._nothing_without():
            return [*find_tables(option, given, self.paths, person)]

    def table(self, path: Path, option: str, given: Path | None, person: str = "") -> Path | None:
        """That of a recording among `tables`."""
        key = option, given, person
        if key not in self._tables:
            tables = self.tables(option, given, person)
            self._tables[key] = dict(zip(self.paths, tables, strict=True))
        return self._tables[key][path]

    def each_person(
        self,
        path: Path,
        read_options: ReadOptions,
        work: Callable[..., None],
        *targets: Path | None,
        tables: tuple[str, Path | None] = ("", None),
    ) -> None:
        """Have work done for each of the people in a recording who are asked for; once by default.

        It is called with the path, how that person is read, the table of that person where
        ``tables`` are given by option and place, and the targets, called after the person. What is
        wrong with one person costs that one alone.
        """
        with self.caught(path):
            failures = []
            for person, options in expand_read_options(path, read_options):
                table = self.table(path, *tables, options.person or "")
                places = [each and add_person(each, person) for each in targets]
                try:
                    work(path, options, table, *places)
                except ReadError as error:
                    failures.append(error)
            if failures:
                raise failures[0]

    @contextmanager
    def caught(self, path: Path) -> Iterator[None]:
        """Keep a failure with one of the recordings in the block for the end."""
        self._at += 1
        try:
            yield
        except KinemeError as error:
            unwritten = isinstance(error, WriteError)  # not the fault of the recording
            self._unwritten |= unwritten
            say = print_error if unwritten or self._is_named(path) else print_skipped
            self._messages.append((say, format_line(error, subject=path)))
        else:
            self._missing -= self._given_as[make_absolute(path)]

    def leave_out(self, path: Path, reason: str) -> None:
        """Say why a recording that could be read has no part in the result."""
        named = self._is_named(path)
        self._messages.append((print_error if named else print_skipped, f"{path}: {reason}"))
        self._missing |= {path} if named else set()

    def progress(self, path: Path) -> AbstractContextManager[Callable[[str], None]]:
        """Return a function that shows the stage at work on the recording whose turn it is."""
        turn = f" ({self._at} of {len(self.paths)})" if len(self.paths) > 1 else ""
        return show_progress(f"{path.name}{turn}", quiet=self._quiet)

    def exit(self) -> None:
        """Say what was left out and why.

        End with code 1 if something named gave nothing, or a result could not be written.
        """
        for say, text in self._messages:
            say(text)
        if self._missing or self._unwritten:
            raise typer.Exit(1)

    def _recordings_in(self, folder: Path, *, recursive: bool) -> list[Path]:
        from kineme.formats.listing import scan_folder

        listing = scan_folder(folder, recursive=recursive)
        self._messages += [
            (print_skipped, f"{path}: {reason}") for path, reason in listing.passed_over
        ]
        names = ", ".join(path.name for path in listing.folders[:3])
        more = ", …" if len(listing.folders) > 3 else ""
        deeper = f"--recursive looks into its folders ({names}{more})" if names else ""
        if not listing.recordings:
            if folder not in (path for path, _ in listing.passed_over):
                alone = any(path.suffix.lower() == SKELETON for path in folder.iterdir())
                why = "a skeleton (.asf) needs the motion (.amc) beside it" if alone else ""
                reasons = filter(None, ("there is no recording in this folder", why, deeper))
                self._messages.append((print_error, f"{folder}: {'; '.join(reasons)}"))
        elif deeper:
            self._messages.append((print_skipped, f"{folder}: {deeper}"))
        return listing.recordings

    def _is_named(self, path: Path) -> bool:
        """Return whether a recording was asked for by its own name, not found in a folder."""
        place = make_absolute(path)
        return any(make_absolute(origin) == place for origin in self._given_as[place])

    @contextmanager
    def _nothing_without(self) -> Iterator[None]:
        """End at once where there is no place for any result, or no table for any recording."""
        try:
            yield
        except (ReadError, WriteError) as error:
            self._messages.append((print_error, format_line(error)))
            self._missing.add(Path(error.path))
            self.exit()
