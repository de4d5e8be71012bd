"""Pictures of the clusters of a library: the most typical segment of each as a strip."""

from __future__ import annotations

import re
from pathlib import Path

from kineme._colors import cluster_color
from kineme._counts import counted
from kineme._files import atomic_write
from kineme.errors import KinemeError, WriteError
from kineme.library.clusters import Cluster, clusters_of
from kineme.library.opened import OpenTables
from kineme.recordings import Motion, Signals

WIDE, TALL = 7.0, 1.4
"""Inches of a strip."""
AT_ONCE = 12
"""Strips in the picture of all clusters."""
ALL = "clusters.png"


def write_pictures(tables: OpenTables, folder: Path) -> list[Path]:
    """A picture of each cluster, and one of those of most seconds below each other.

    Parameters
    ----------
    tables : OpenTables
        Of the library.
    folder : Path
        Where to write them; made where there is none.

    Returns
    -------
    list of Path
        That of all clusters first. Clusters whose recording is gone have none.

    Raises
    ------
    WriteError
        The folder cannot be written.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise WriteError(folder, f"cannot be made: {error.strerror or error}") from error
    drawn: list[tuple[Cluster, Motion | Signals]] = []
    written = []
    for cluster in clusters_of(tables):
        try:
            seen = tables.read(cluster.example)
        except KinemeError:  # its file is gone; the library still knows the rest
            continue
        recording = seen.seconds(cluster.start_s, cluster.stop_s)
        drawn.append((cluster, recording))
        path = folder / f"{_called(cluster)}.png"
        _write([(cluster, recording)], path)
        written.append(path)
    if drawn:
        _write(drawn[:AT_ONCE], folder / ALL)
        written.insert(0, folder / ALL)
    return written


def _write(strips: list[tuple[Cluster, Motion | Signals]], path: Path) -> None:
    """Strips below each other, each under what it is."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    from kineme.plot import plot_strip

    figure = Figure(figsize=(WIDE, TALL * len(strips)), layout="constrained")
    FigureCanvasAgg(figure)
    rows = figure.subplots(len(strips), squeeze=False)[:, 0]
    for axes, (cluster, recording) in zip(rows, strips, strict=True):
        plot_strip(recording, color=cluster_color(cluster.cluster), ax=axes)
        axes.set_title(_told(cluster), loc="left", fontsize=8)
    with atomic_write(path) as draft:
        figure.savefig(draft, dpi=120)


def _told(cluster: Cluster) -> str:
    """A cluster in a line."""
    named = f"{cluster.cluster} {cluster.label}".strip()
    times = cluster.repetitions or cluster.activities
    n = cluster.recordings
    return (
        f"{named}   {times} × {cluster.typical_s:.2f} s in {counted(n, 'recording')}; "
        f"here {cluster.example}"
    )


def _called(cluster: Cluster) -> str:
    """A name for the file of a cluster, of letters that every system takes."""
    label = re.sub(r"[^\w-]+", "-", cluster.label).strip("-")[:40]
    return "-".join(filter(None, [f"cluster-{cluster.cluster}", label]))
