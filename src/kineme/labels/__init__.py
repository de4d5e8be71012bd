"""Segments as files, in a format chosen by its name, the file's content or suffix.

The package's own hold everything:

=========== ============  ====================================================
``csv``     ``.csv``      the table alone, as pandas and spreadsheets read it;
                          all else goes into ``NAME.provenance.json`` beside it
``json``    ``.json``     everything in one file, ``kineme.segments/2``
``parquet`` ``.parquet``  the table; all else as metadata, ``kineme.segments``
=========== ============  ====================================================

Reading what was written gives an equal segmentation. A table whose provenance file is lost
can still be read: the frame rate then follows from frames and seconds, and a note says so.
Tables of intervals (``start_s``, ``stop_s``, ``label``; comma or tab) are read as ``csv``.

Those of other programs hold labels, see `kineme.labels.spans`:

============ ============= ===================================================
``audacity`` ``.txt``      one level
``elan``     ``.eaf``      both levels, frame rate; milliseconds
``textgrid`` ``.TextGrid`` both levels
``bids``     ``.tsv``      both levels, frame rate, clusters, confidences
``boris``    ``.csv``      both levels, frame rate
``babel``    ``.json``     one level; labels may overlap
``ms-tcn``   ``.txt``      one level, as one label per frame
``clips``    ``.csv``      one level, frame rate
``c3d``      ``.c3d``      events, read only
============ ============= ===================================================

Where several have a suffix, the content tells them apart on reading, and the first listed is
written unless ``format=`` names another. A format of your own is a `LabelFormat`, made known
by `register` or by the entry point group ``kineme.label_formats``.
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
