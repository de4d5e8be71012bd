"""Undo and redo as a value: the present table, the ones before it, and the ones undone.

Nothing here changes in place, so that a state that could not be saved is
simply dropped.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, TypeVar

from kineme.errors import ParameterError

State = TypeVar("State")

LONGEST = 100
"""States to go back; the table of an hour has a few hundred kilobytes."""


@dataclass(frozen=True)
class History(Generic[State]):
    """A state and how it came about.

    Parameters
    ----------
    present : State
        Usually a `kineme.segments.segmentation.Segmentation`.
    past : tuple of State
        Those before it, oldest first.
    future : tuple of State
        Those undone, the next one to redo first.

    Examples
    --------
    >>> history = History("cut").followed_by("merged").followed_by("named")
    >>> history.undone().present
    'merged'
    >>> history.undone().redone().present
    'named'
    """

    present: State
    past: tuple[State, ...] = ()
    future: tuple[State, ...] = ()

    def followed_by(self, state: State) -> History[State]:
        """Return the history with a new present; what was undone cannot be redone any more."""
        return History(state, (*self.past, self.present)[-LONGEST:])

    def undone(self) -> History[State]:
        """Return the history one step back."""
        if not self.past:
            raise ParameterError("there is nothing to undo")
        return History(self.past[-1], self.past[:-1], (self.present, *self.future))

    def redone(self) -> History[State]:
        """Return the history one step forward again."""
        if not self.future:
            raise ParameterError("there is nothing to redo")
        return History(self.future[0], (*self.past, self.present), self.future[1:])
