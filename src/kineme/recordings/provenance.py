"""Record where a recording came from and what was inferred while reading it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Literal, Self

from kineme._util.arrays import Floats
from kineme.recordings.times import Clock

Severity = Literal["info", "warning"]


class Note(str):
    """One sentence on what was inferred or done, with its severity.

    Parameters
    ----------
    text : str
        The sentence.
    severity : {"info", "warning"}
        `kineme.read` warns of "warning" notes: the recording may be misread.

    Examples
    --------
    >>> note = Note("no unit in the file: metres assumed", "warning")
    >>> str(note), note.severity
    ('no unit in the file: metres assumed', 'warning')
    """

    __slots__ = ("severity",)
    severity: Severity

    def __new__(cls, text: str, severity: Severity = "info") -> Self:
        note = super().__new__(cls, text)
        note.severity = severity
        return note

    @property
    def text(self) -> str:
        return str(self)

    # Without this, pickling a str subclass loses the severity.
    def __reduce__(self) -> tuple[type[Self], tuple[str, Severity]]:
        return type(self), (str(self), self.severity)


@dataclass(frozen=True)
class Provenance:
    """Source of a recording, and what was inferred while reading it.

    Parameters
    ----------
    path : str, optional
        Path of the file.
    format : str, optional
        Name of the format.
    sha256 : str, optional
        Digest of the file's bytes.
    notes : sequence of Note or str
        For example "frame rate 120 Hz assumed: AMC files do not store one". Plain texts become
        notes of severity "info".
    events : sequence of (float, str)
        Events marked in the file: seconds from its first frame, and label.
    clock : Clock, optional
        Times in the file, if they differ from those of frames counted from 0.
    take : str, optional
        The animation that was read from a file that may hold several.
    takes : sequence of str
        All animations in the file.
    person : str, optional
        The person that was read from a file that may hold several.
    people : sequence of str
        All people in the file.
    rows : (rows,) array, optional
        Second of the recording at which each row of the source was taken, in time order. None if
        rows are frames, or if there are no rows.

    Examples
    --------
    >>> Provenance(path="a.amc").noted("frame rate 120 Hz assumed").notes
    ('frame rate 120 Hz assumed',)
    """

    path: str | None = None
    format: str | None = None
    sha256: str | None = None
    notes: tuple[Note, ...] = ()
    events: tuple[tuple[float, str], ...] = ()
    clock: Clock | None = None
    take: str | None = None
    takes: tuple[str, ...] = ()
    person: str | None = None
    people: tuple[str, ...] = ()
    rows: Floats | None = field(default=None, compare=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "notes", _as_notes(self.notes))
        for name in ("events", "takes", "people"):
            object.__setattr__(self, name, tuple(getattr(self, name)))

    @property
    def warnings(self) -> tuple[Note, ...]:
        """Return the notes of severity "warning"."""
        return tuple(note for note in self.notes if note.severity == "warning")

    @property
    def input(self) -> dict[str, str | None]:
        """Return the input for results: the file, and take and person if it has several."""
        found = {"path": self.path, "format": self.format, "sha256": self.sha256}
        if len(self.takes) > 1:
            found["take"] = self.take
        # Name the person only if the file holds several.
        if len(self.people) > 1:
            found["person"] = self.person
        return found

    def noted(self, *notes: Note | str) -> Provenance:
        """Return a copy with notes added; plain texts become notes of severity "info"."""
        return replace(self, notes=self.notes + _as_notes(notes))

    def marked(self, events: Iterable[tuple[float, str]]) -> Provenance:
        """Return a copy with these events (seconds and labels) instead of its own."""
        return replace(self, events=tuple(events))

    def timed(self, clock: Clock | None, rows: Floats | None = None) -> Provenance:
        """Return a copy with this clock and these seconds of rows instead of its own."""
        return replace(self, clock=clock, rows=rows)

    def of_take(self, name: str, names: Iterable[str]) -> Provenance:
        """Return a copy for this take, one of those in the file."""
        return replace(self, take=name, takes=tuple(names))

    def of_person(self, name: str, people: Iterable[str]) -> Provenance:
        """Return a copy for this person, one of those in the file."""
        return replace(self, person=name, people=tuple(people))


def _as_notes(notes: Iterable[Note | str]) -> tuple[Note, ...]:
    return tuple(note if isinstance(note, Note) else Note(note) for note in notes)
