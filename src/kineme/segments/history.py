"""What was, what is, what was taken back: undo and redo as a value."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, TypeVar

from kineme.errors import ParameterError

State = TypeVar("State")

LONGEST = 100
"""States to go back; a table of an hour takes a few hundred kilobytes."""


@dataclass(frozen=True)
class History(Generic[State]):
    """The present state, those before it (oldest first), and those taken back (next first)."""

    present: State
    past: tuple[State, ...] = ()
    future: tuple[State, ...] = ()

    def then(self, state: State) -> History[State]:
        """The same with a new present; what was taken back is gone."""
        return History(state, (*self.past, self.present)[-LONGEST:])

    def undone(self) -> History[State]:
        """One step back; ParameterError if there is none."""
        if not self.past:
            raise ParameterError("there is nothing to undo")
        return History(self.past[-1], self.past[:-1], (self.present, *self.future))

    def redone(self) -> History[State]:
        """One step forward again; ParameterError if there is none."""
        if not self.future:
            raise ParameterError("there is nothing to redo")
        return History(self.future[0], (*self.past, self.present), self.future[1:])
