"""Read and write segments in many formats, selected by name, content or suffix.

The native formats store everything:

=========== ============  ====================================================
``csv``     ``.csv``      the table, readable by pandas and spreadsheets; the
                          rest is in ``NAME.provenance.json`` beside it
``json``    ``.json``     everything in one file, ``kineme.segments/2``
``parquet`` ``.parquet``  the table; the rest as metadata, ``kineme.segments``
=========== ============  ====================================================

Reading a written file returns an equal segmentation. A table without its provenance file can still
be read: the frame rate is computed from frames and seconds, with a note.
Tables of intervals (``start_s``, ``stop_s``, ``label``; comma or tab) are read as ``csv``.

Formats of other programs store labels, see `kineme.labels.spans`:

============ ============= ===================================================
``audacity`` ``.txt``      one level
``elan``     ``.eaf``      both levels, frame rate; milliseconds
``textgrid`` ``.TextGrid`` both levels
``bids``     ``.tsv``      both levels, frame rate, clusters, confidences
``boris``    ``.csv``      both levels, frame rate; also ``.tsv``
``babel``    ``.json``     one level; labels may overlap
``ms-tcn``   ``.txt``      one level, as one label per frame
``clips``    ``.csv``      one level, frame rate
``c3d``      ``.c3d``      events, read only
============ ============= ===================================================

If formats share a suffix, reading tells them apart by content, and writing uses the first one
listed unless ``format=`` names another. Add your own format as a `LabelFormat` with `register` or
by the entry point group ``kineme.label_formats``.
"""

from kineme.labels.registry import (
    LabelFormat,
    holds_labels,
    label_formats,
    list_written_suffixes,
    read_segments,
    register,
    write_segments,
)
from kineme.labels.spans import Labels, Span

__all__ = [
    "LabelFormat",
    "Labels",
    "Span",
    "holds_labels",
    "label_formats",
    "list_written_suffixes",
    "read_segments",
    "register",
    "write_segments",
]
