"""How far a long work is, in sentences."""

from __future__ import annotations

import time
from collections.abc import Callable

Progress = Callable[[str], None]


class Watch:
    """Tells how many things are done, and for how many seconds the work on the others goes on.

    Parameters
    ----------
    progress : callable
        Called with each sentence.
    things : int
        That there are.
    work : float
        That they make, in any unit.
    what : str
        Said before the numbers.
    """

    def __init__(self, progress: Progress, things: int, work: float, what: str = ""):
        self._progress, self._what = progress, what
        self._started = time.monotonic()
        self._things, self._work = things, work
        self._things_done, self._work_done = 0, 0.0

    def done(self, things: int, work: float) -> None:
        """So many more are done, and so much work."""
        self._things_done += things
        self._work_done += work
        left = self._work - self._work_done
        left_s = (time.monotonic() - self._started) * left / max(self._work_done, 1)
        shown = f"{left_s:.0f} s" if left_s < 90 else f"{left_s / 60:.0f} min"
        more = f", {shown} left" if self._things_done < self._things else ""
        self._progress(f"{self._what}{self._things_done} of {self._things}{more}")

    def more(self, work: float) -> None:
        """There is so much more work."""
        self._work += work
