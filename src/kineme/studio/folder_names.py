"""Rename a cluster in all recordings of a folder.

Clusters of different recordings are only related by their names: clusters and segments elsewhere
that have the old name get the new one. In a library clusters are shared: see
`kineme.studio.library`.
"""

from __future__ import annotations

from kineme.errors import KinemeError, ParameterError
from kineme.segments.editing import cluster_names
from kineme.segments.segmentation import Segmentation
from kineme.studio.open_recording import ConflictError
from kineme.studio.open_recordings import OpenRecordings, UnknownError
from kineme.studio.overview import read_brief
from kineme.studio.storage.tables import find_table_path
from kineme.web.library_messages import CallEverywhere, TablesChanged
from kineme.web.requests import ByHand, EditRequest, NameCluster, NameSegment, Together


def rename_everywhere(recordings: OpenRecordings, sent: CallEverywhere) -> TablesChanged:
    """Give the new name to everything called ``before`` in other recordings, one undo step in each.

    ParameterError if the cluster had no name before.
    """
    if not sent.before:
        raise ParameterError(
            "the cluster had no name before: only named clusters can be renamed in other recordings"
        )
    changed, left = 0, []
    for name, listed in recordings.folder.recordings().items():
        table_path = find_table_path(listed)
        table = read_brief(table_path) if table_path and name != sent.recording else None
        if table is None or sent.before not in table.label:
            continue
        try:
            opened = recordings.get(name)
            edits = _make_edits(opened.table, sent.before, sent.label)
            if edits:
                edit = EditRequest(revision=opened.revision, edit=Together(edits=edits))
                recordings.edit(name, edit)
                changed += 1
        except (KinemeError, UnknownError, ConflictError) as error:
            left.append(f"{listed.name}: {error}")
    return TablesChanged(tables=changed, others=0, left=left)


def _make_edits(table: Segmentation, before: str, label: str) -> list[ByHand]:
    """Return edits that rename the clusters with this name, and the single segments with it."""
    clusters = [cluster for cluster, name in cluster_names(table).items() if name == before]
    single_rows = [row for row in table if row.label == before and row.cluster not in clusters]
    return [
        *(NameCluster(cluster=cluster, label=label) for cluster in clusters),
        *(NameSegment(level=row.level, frame=row.start_frame, label=label) for row in single_rows),
    ]
