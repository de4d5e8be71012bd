"""Reading and writing recordings.

`read` picks a reader by what the file holds and by its suffix; `write` picks a
writer by suffix. Every reader gives a `Motion` in metres, y up, or `Signals`,
and says in the provenance what the file did not tell and had to be inferred.
One module per format; `register` adds more.
"""

from kineme.formats.files import FileContent
from kineme.formats.options import ReadOptions
from kineme.formats.read_write import (
    list_people,
    list_takes,
    read,
    read_analog,
    read_motion,
    read_quietly,
    sketch,
    write,
)
from kineme.formats.registry import Format, register, supported_formats

__all__ = [
    "FileContent",
    "Format",
    "ReadOptions",
    "list_people",
    "list_takes",
    "read",
    "read_analog",
    "read_motion",
    "read_quietly",
    "register",
    "sketch",
    "supported_formats",
    "write",
]
