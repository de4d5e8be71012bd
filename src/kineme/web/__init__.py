"""Pages: their sources (``pages``), as built (``static``), and what they are told.

``page_data`` puts together what a page draws, whichever kind the recording is,
from ``display`` (the poses), ``similarity`` and ``matrix`` (the tiles of the
similarity matrix). ``curves`` are what is drawn over time, ``cycle_curves`` the
repetitions of a cluster, as `kineme.cycles` measures them. The types of what pages are
told are in ``messages``, of what they send in ``requests``; ``encoding`` turns both
into JSON and back.
"""

from pathlib import Path

STATIC = Path(__file__).parent / "static"
"""Folder of the built pages."""
