"""A recording that can be opened: a file, or one person in it.

If a file has several people, each one is a recording with its own id, table, history and downloads.
They share the file, its reading options and its video.
"""

from __future__ import annotations

from dataclasses import dataclass
from hashlib import blake2b
from pathlib import Path

from kineme._util.files import add_person


def make_file_id(path: Path) -> str:
    """Return the id of a file, which depends on its path only."""
    return _compute_digest(str(path.absolute()))


@dataclass(frozen=True)
class ListedRecording:
    """A recording that can be opened.

    Parameters
    ----------
    path : Path
        Its file.
    person : str
        The person of a file with several; empty for other files.
    is_first : bool
        Whether this person was opened before the people became separate recordings: it keeps the
        id and the table of the file.
    """

    path: Path
    person: str = ""
    is_first: bool = False

    @property
    def id(self) -> str:
        """Id that pages use."""
        if self.is_first or not self.person:
            return make_file_id(self.path)
        return _compute_digest(str(self.path.absolute()), self.person)

    @property
    def name(self) -> str:
        """Name shown to the user."""
        person = f"person {self.person}" if self.person.isdecimal() else self.person
        return f"{self.path.name} · {person}" if person else self.path.name

    @property
    def person_path(self) -> Path:
        """Path with the person's name added, after which labels and downloads are named."""
        return add_person(self.path, self.person)

    @property
    def table_base(self) -> Path:
        """Path after which the table is named."""
        return self.path if self.is_first else self.person_path


def _compute_digest(path: str, person: str = "") -> str:
    suffix = f"\0{person}".encode(errors="backslashreplace") if person else b""
    return blake2b(path.encode(errors="surrogateescape") + suffix, digest_size=9).hexdigest()
