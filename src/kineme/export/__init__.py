"""Segment tables as files: one module per format, chosen by suffix.

===========  =================================================================
``.csv``     the table alone, as pandas and spreadsheets read it; everything
             else goes into ``NAME.provenance.json`` beside it
``.json``    everything in one file, schema ``kineme.segments/1``
``.parquet`` the table; everything else as metadata under ``kineme.segments``
===========  =================================================================

Reading what was written gives an equal segmentation. A table whose
provenance file is lost can still be read: the frame rate then follows from
frames and seconds, and a note says so.
"""

from kineme.export.segments import read_segments, write_segments

__all__ = ["read_segments", "write_segments"]
