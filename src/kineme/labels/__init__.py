"""Segments as files: one module per format, chosen by its name or the file's suffix.

The package's own hold everything:

=========== ============  ====================================================
``csv``     ``.csv``      the table alone, as pandas and spreadsheets read it;
                          all else goes into ``NAME.provenance.json`` beside it
``json``    ``.json``     everything in one file, ``kineme.segments/1``
``parquet`` ``.parquet``  the table; all else as metadata, ``kineme.segments``
=========== ============  ====================================================

Reading what was written gives an equal segmentation. A table whose
provenance file is lost can still be read: the frame rate then follows from
frames and seconds, and a note says so.

Those of other programs hold labels, see :mod:`kineme.labels.spans`:

============ ============= ===================================================
``audacity`` ``.txt``      one level
``elan``     ``.eaf``      both levels, frame rate; milliseconds
``textgrid`` ``.TextGrid`` both levels
``bids``     ``.tsv``      both levels, frame rate, clusters, scores
``boris``    by name       both levels, frame rate
``babel``    by name       one level; labels may overlap
``ms-tcn``   by name       one level, as one label per frame
``clips``    by name       one level, frame rate
``c3d``      ``.c3d``      events, read only
============ ============= ===================================================
"""

from kineme.labels.registry import (
    FORMATS,
    SUFFIXES,
    LabelFormat,
    read_segments,
    write_segments,
)

__all__ = ["FORMATS", "SUFFIXES", "LabelFormat", "read_segments", "write_segments"]
