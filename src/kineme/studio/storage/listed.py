"""What there is to open: the file of a recording, or one of the people in it.

Where a file has several people, each of them is a recording of its own: it has an id, a table, a
history and downloads. They share the file, how it is read, and its video.
"""

from __future__ import annotations

from dataclasses import dataclass
from hashlib import blake2b
from pathlib import Path

from kineme._util.files import add_person


def make_file_id(path: Path) -> str:
    """Return the id of a file: the same for as long as it lies there."""
    return _compute_digest(str(path.absolute()))


@dataclass(frozen=True)
class ListedRecording:
    """A recording that can be opened.

    Parameters
    ----------
    path : Path
        Its file.
    person : str
        Who it is of several people; empty where nobody has to be told apart.
    is_first : bool
        Whether this person was read before anybody was told apart: id and table are still those
        of the file.
    """

    path: Path
    person: str = ""
    is_first: bool = False

    @property
    def id(self) -> str:
        """By which pages ask for it."""
        if self.is_first or not self.person:
            return make_file_id(self.path)
        return _compute_digest(str(self.path.absolute()), self.person)

    @property
    def name(self) -> str:
        """Return what it is called where people read it."""
        person = f"person {self.person}" if self.person.isdecimal() else self.person
        return f"{self.path.name} · {person}" if person else self.path.name

    @property
    def called(self) -> Path:
        """File that it would be by itself, after which labels and downloads are called."""
        return add_person(self.path, self.person)

    @property
    def with_table(self) -> Path:
        """Return the file that its table is called after."""
        return self.path if self.is_first else self.called


def _compute_digest(path: str, person: str = "") -> str:
    behind = f"\0{person}".encode(errors="backslashreplace") if person else b""
    return blake2b(path.encode(errors="surrogateescape") + behind, digest_size=9).hexdigest()
