"""Read and write recordings.

`read` chooses a reader by the file's content and suffix; `write` chooses a writer by suffix. A
reader returns a `Motion` in metres with y up, or `Signals`. The provenance records everything that
the file did not state and the reader had to infer. Each format is one module; `register` adds more.
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
