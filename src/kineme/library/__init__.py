"""Libraries: folders of recordings, segmented once, kept, and searched by example.

A library is a folder. `build` fills it from recordings; `Library` opens it.

============================= ==================================================================
``library.json``              its head: schema, version, options of reading and segmenting, sources,
                              what failed, and the name of the tables that are valid; written last
``tables/NAME/``              Parquet: ``recordings``, ``segments``, ``embeddings``, ``clusters``;
                              NAME is a digest of what they hold; of large libraries the index
``pieces/KEY.parquet``        segments and embeddings of one recording, as it was found alone
``pieces/KEY.npy``            its matching features, float32 (samples, dims)
``pieces/KEY.*.npy``          of bodies, windows of these: see `kineme.library.windows`; of signals,
                              means and deviations of channels, five times a second
``edits.json``                what people said: names, merges and splits of clusters
``seen.json``                 size and time of every file when it was read; may be deleted
============================= ==================================================================

**One analysis a recording.** KEY is a digest of the files that a recording is read from (an AMC's
skeleton is one of them), of the version of kineme, and of every constant and option. An analysis
that is there is never made again, so a build that was ended goes on where it was, and
what a library holds depends neither on the number of processes nor on the order of their work.

**Clusters in common.** The clusters of single recordings are joined over all of them, bodies and
each set of channels for itself (`kineme.transfer.clusters`). A cluster that is found again after
recordings came or went keeps its number; a number is never given twice.

**Computed and said are apart.** Tables hold what was computed. Names, merges and splits
(`kineme.library.edits`) are kept in a file of their own, and applied whenever tables are read.

**Readers never see half.** Every file is written beside its place and moved there. A build writes
new tables, then moves ``library.json``, which names them, and only then removes what nothing
names any more. One build at a time holds the library; readers wait for nobody.

Search looks at matching features, not at segments: short recordings and parts of activities are
found as well.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
