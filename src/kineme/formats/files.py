"""Load files with a digest, parse numbers with error messages, and write files atomically."""

from __future__ import annotations

from codecs import BOM_UTF16_BE, BOM_UTF16_LE
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cached_property
from hashlib import file_digest, sha256
from math import inf, isfinite
from os import PathLike
from os.path import realpath
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from kineme._util.checks import is_text, make_unique, warn
from kineme._util.files import atomic_write, read_head, refuse_pipe
from kineme.errors import ReadError, WriteError
from kineme.recordings import Motion, Note, Provenance

RATE_ROUNDING = 0.005
"""Fraction by which two frame rates may differ through rounding."""

MAX_EXPANSION = 100
"""Maximum memory use of a file as a multiple of its size; intact files need 1 to 40 times."""

MIN_MEMORY = 1 << 20
"""Bytes of memory that any file may use, however small it is."""


@dataclass(frozen=True)
class FileContent:
    r"""A file's path, all of its bytes, and the remarks of its reader.

    Parameters
    ----------
    path : Path
    data : bytes
    remarks : list of Note
        Filled by `warn`; included in every `provenance` created afterwards.

    Examples
    --------
    >>> content = FileContent(Path("walk.csv"), b"time,hip_x\n0,one\n")
    >>> content.text.splitlines()[0]
    'time,hip_x'
    >>> print(content.error("'one' is not a number", line=2))
    walk.csv, line 2: 'one' is not a number
    """

    path: Path
    data: bytes
    remarks: list[Note] = field(default_factory=list, compare=False)

    @cached_property
    def digest(self) -> str:
        return sha256(self.data).hexdigest()

    @property
    def text(self) -> str:
        """Return the bytes as text: UTF-16 if they start with its mark, else by `decode_text`."""
        if self.is_utf16:
            return self.data.decode("utf-16", errors="replace")
        return decode_text(self.data).removeprefix("\ufeff")

    @property
    def is_utf16(self) -> bool:
        """Whether the bytes start with a byte order mark of UTF-16."""
        return self.data.startswith((BOM_UTF16_LE, BOM_UTF16_BE))

    def warn(self, reason: str, line: int | None = None) -> None:
        """Add a remark of severity "warning" on something unusual that could be read."""
        where = "" if line is None else f"line {line}: "
        self.remarks.append(Note(f"{where}{reason}", "warning"))

    def choose_rate(
        self, requested: float | None, stated: float | None, missing: str = ""
    ) -> float:
        """Return the requested frame rate, else a valid stated one, else 0; warn if they differ.

        Instead of returning 0, raise ReadError if ``missing`` says what the file lacks.
        """
        stated = stated if stated and 0 < stated < inf else 0.0
        if requested and stated and abs(requested - stated) > RATE_ROUNDING * stated:
            self.warn(f"the file states {stated:g} Hz; {requested:g} is used")
        if missing and not (requested or stated):
            raise self.error(f"{missing}: give fps= (--fps)")
        return requested or stated

    def provenance(self, name: str, notes: Iterable[str]) -> Provenance:
        """Return the provenance of a recording in this file, with all remarks and these notes."""
        return Provenance(str(self.path), name, self.digest).noted(*self.remarks, *notes)

    def release(self) -> None:
        """Release the bytes, once a reader has parsed them and needs memory for the result."""
        object.__setattr__(self, "data", b"")

    @property
    def memory_limit(self) -> int:
        """Bytes of memory that the content of a file of this size may use."""
        return max(MIN_MEMORY, MAX_EXPANSION * len(self.data))

    def require_memory(self, size: int, what: str) -> None:
        """Raise ReadError if ``what`` the file describes needs more bytes than `memory_limit`.

        Every reader calls this before it allocates more than a few times the bytes it has parsed.
        """
        if size > self.memory_limit:
            raise self.error(
                f"claims {what}: {size / 1e6:.0f} MB of memory, too much for a file of "
                f"{len(self.data) / 1e6:.2g} MB: it is damaged"
            )

    def line_at(self, offset: int) -> int:
        """Return the number of the line, counted from 1, that contains a byte."""
        return self.data.count(b"\n", 0, offset) + 1

    def error(self, reason: str, line: int | None = None) -> ReadError:
        return ReadError(self.path, reason, line=line)


@dataclass(frozen=True)
class FileHead(FileContent):
    """First bytes of a file that is too large to load; its reader opens the path."""

    @cached_property
    def digest(self) -> str:
        with self.path.open("rb") as file:
            return file_digest(file, "sha256").hexdigest()

    @property
    def memory_limit(self) -> int:
        return max(MIN_MEMORY, MAX_EXPANSION * self.path.stat().st_size)


def decode_text(data: bytes) -> str:
    """Return bytes as text: UTF-8, else Windows-1252.

    Bytes that fit neither are replaced; they occur in comments and names only.
    """
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        return data.decode("cp1252", errors="replace")


def load_head(path: str | PathLike[str]) -> FileHead:
    """Return the first bytes of a file; raise ReadError like `load`."""
    with _translate_open_errors(path):
        return FileHead(Path(path), read_head(Path(path)))


def load(path: str | PathLike[str]) -> FileContent:
    """Return the content of a file; raise ReadError if it is missing or cannot be read."""
    with _translate_open_errors(path):
        return FileContent(Path(path), Path(path).read_bytes())


@contextmanager
def _translate_open_errors(path: str | PathLike[str]) -> Iterator[None]:
    try:
        refuse_pipe(path)
        yield
    except OSError as error:
        raise ReadError(path, f"cannot be opened: {error.strerror or error}") from error
    except ValueError as error:  # the name contains a null byte
        raise ReadError(path, f"cannot be opened: {error}") from error


def find_sibling(content: FileContent, relative: str | PathLike[str]) -> Path:
    """Return the path of a file to which ``content`` refers by a relative path.

    Raise ReadError if it is not in the folder of ``content``, links included, or is a pipe.
    """
    folder = content.path.parent
    path = folder / relative
    # Resolve links on both sides, so that a link cannot lead out of the folder.
    if not Path(realpath(path)).is_relative_to(realpath(folder)):
        raise content.error(
            f"names {str(relative)!r:.90}, which is outside its folder: put that file into "
            "the folder"
        )
    refuse_pipe(path)
    return path


def parse_numbers(words: Sequence[str | bytes]) -> list[float]:
    """Return the words as finite numbers; raise ValueError that names the first other word."""
    try:
        # Convert all words at once; search for a wrong one only after an error.
        values = list(map(float, words))
    except ValueError:
        wrong = next(word for word in words if not _is_number(word))
        raise ValueError(f"{_excerpt(wrong)} is not a number") from None
    if not all(map(isfinite, values)):
        wrong = next(word for word, value in zip(words, values, strict=True) if not isfinite(value))
        raise ValueError(f"{_excerpt(wrong)} is not a finite number")
    return values


def save(path: Path, text: Iterable[str]) -> None:
    """Write ``text`` to ``path`` atomically."""
    with atomic_write(path) as draft, draft.open("w", encoding="utf-8", newline="\n") as file:
        file.writelines(text)


def format_table(values: NDArray[np.float64]) -> list[str]:
    """Return one line per row, with nine decimals: below a nanometre in any of the units."""
    row = " ".join(["%.9f"] * values.shape[1]) + "\n"
    return [row % tuple(line) for line in values.tolist()]


def clean_names(path: Path, names: Sequence[str], clean: Callable[[str], str]) -> list[str]:
    """Return the names as a format can store them, made unique; warn if that changes some.

    Raise WriteError for a name that is not valid text (half of a UTF-16 surrogate pair).
    """
    for name in names:
        if not is_text(name):
            raise WriteError(path, f"the name {name!r:.60} cannot be written: it is not text")
    cleaned = make_unique(map(clean, names))
    changed = [pair for pair in zip(names, cleaned, strict=True) if pair[0] != pair[1]]
    if changed:
        name, new = changed[0]
        more = f", and {len(changed) - 1} more" if len(changed) > 1 else ""
        warn(f"{path.name}: the name {name!r:.60} written as {new!r:.60}{more}")
    return cleaned


def require_rotations(motion: Motion, path: Path, what: str) -> NDArray[np.float64]:
    """Return the rotations of a motion to be written; raise WriteError if it has none."""
    if motion.rotations is None:
        raise WriteError(
            path,
            f"{what} needs rotations, but this motion has positions only: write .trc, .csv or .npz",
        )
    return motion.rotations


def format_point_name(name: str) -> str:
    """Return a point's name as tables can store it: one line, without colons at its ends."""
    return " ".join(name.split()).strip(": ")


def _is_number(word: str | bytes) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _excerpt(word: str | bytes) -> str:
    text = word.decode("ascii", errors="backslashreplace") if isinstance(word, bytes) else word
    return repr(text if len(text) <= 40 else text[:40] + "...")
