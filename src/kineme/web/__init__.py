"""Web pages: sources (``pages``), built files (``static``), and the data that they get.

``page_data`` collects what a page draws of any recording, from ``display`` (poses), ``curves``
(channels over time), ``cycle_curves`` (repetitions of a cluster, measured by `kineme.cycles`) and
``matrix`` (tiles of the similarity matrix). ``messages`` has the types that pages receive,
``requests`` those that they send; ``encoding`` converts both to JSON and back.
"""

from pathlib import Path

STATIC = Path(__file__).parent / "static"
"""Folder of the built pages."""
