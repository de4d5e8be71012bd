"""Undo and redo as an immutable value: present, past and undone states.

Nothing changes in place, so a state that could not be saved can simply be dropped.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, TypeVar

from kineme.errors import ParameterError

State = TypeVar("State")

LONGEST = 100
"""Largest number of past states; the table of one hour has a few hundred kilobytes."""


@dataclass(frozen=True)
class History(Generic[State]):
    """A state, usually a segmentation, with past states (oldest first) and undone ones.

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
        """Return the history with a new present state; undone states are dropped."""
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
