"""Libraries: recordings that are segmented once, stored, and searched by example.

A library is a folder. `build` creates it from recordings; `Library` opens it.

============================= ==================================================================
``library.json``              head: schema, version, options for reading and segmenting, sources,
                              failures, and the name of the current tables; written last
``tables/NAME/``              Parquet: ``recordings``, ``segments``, ``embeddings``, ``clusters``;
                              NAME is a digest of their content; large libraries add the index
``pieces/KEY.parquet``        segments and embeddings of one recording on its own
``pieces/KEY.npy``            its matching features, float32 (samples, dims)
``pieces/KEY.*.npy``          for bodies, windows of these: see `kineme.library.windows`; for
                              signals, means and deviations of channels, five times a second
``edits.json``                edits by people: names, merges and splits of clusters
``seen.json``                 size and time of every file when it was read; may be deleted
============================= ==================================================================

**One analysis per recording.** KEY is a digest of the files of a recording (including the skeleton
of an AMC), the version of kineme, and all constants and options. Existing analyses are reused, so
an interrupted build continues where it stopped. The result depends neither on the number of
processes nor on the order of their work.

**Shared clusters.** Clusters of single recordings are merged over all recordings, separately for
bodies and for each set of channels (`kineme.transfer.clusters`). A cluster that is found again
after recordings were added or removed keeps its number; numbers are never reused.

**Edits are separate.** Tables hold computed values. Names, merges and splits
(`kineme.library.edits`) have a file of their own and are applied when tables are read.

**Readers never see partial files.** Every file is written under a temporary name and renamed. A
build writes new tables, then replaces ``library.json``, which names them, and only then deletes
unused files. Only one build at a time may run; readers never wait.

Search compares matching features, not segments: it also finds short recordings and parts of
activities.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
