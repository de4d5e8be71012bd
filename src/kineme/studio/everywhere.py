"""A name that holds in all recordings of a folder.

Clusters are of their recordings there; what they have in common is what they are called. So what
one is called otherwise now, others of its former name are called, too. In a library clusters are
common: `kineme.studio.library`.
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
    """Call what is called ``before`` in other recordings otherwise, in each as one step of undo.

    ParameterError where it had no name before, by which it would be known elsewhere.
    """
    if not sent.before:
        raise ParameterError("the cluster had no name before, by which others would be known")
    changed, left = 0, []
    for name, listed in recordings.folder.recordings().items():
        at = find_table_path(listed)
        table = read_brief(at) if at and name != sent.recording else None
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
    """Names for the clusters that are called so, and for segments that are called so alone."""
    clusters = [cluster for cluster, name in cluster_names(table).items() if name == before]
    alone = [row for row in table if row.label == before and row.cluster not in clusters]
    return [
        *(NameCluster(cluster=cluster, label=label) for cluster in clusters),
        *(NameSegment(level=row.level, frame=row.start_frame, label=label) for row in alone),
    ]
