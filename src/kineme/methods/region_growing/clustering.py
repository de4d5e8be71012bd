"""Cluster segments that match each other, anywhere in the recording.

A segment g is linked to a segment h if a warping path through the rows of g
covers enough of both. Clusters are the connected components of these links, so
their number is a result and not a parameter.

Sources: Vögele, Krüger and Klein 2014, section 4; coverage and strong
components as in the authors' program and Krüger et al. 2017.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from kineme._util.parallel import map_threads
from kineme.methods.region_growing import _kernels
from kineme.methods.region_growing.neighbors import NeighborGraph
from kineme.methods.region_growing.warping import Step, warping_paths
from kineme.methods.segments import number_by_appearance


@dataclass(frozen=True, eq=False)
class Clustering:
    """Cluster and score of each segment.

    ``labels[g]`` is the cluster of segment g, numbered from 0 by appearance.
    ``scores[g]`` is the largest share of g and another segment of its cluster
    that a path covers; 0 if g is alone.
    """

    labels: NDArray[np.int64]
    scores: NDArray[np.float64]


def cluster_segments(
    graph: NeighborGraph,
    borders: NDArray[np.int64],
    *,
    steps: Sequence[Step],
    skip_penalty: float,
    zero_cost: float,
    min_nodes: int,
    separation: int | None,
    max_slope: float,
    coverage: float,
    interpolate: bool,
    connection: Literal["weak", "strong"],
) -> Clustering:
    """Group the segments that are linked by warping paths.

    Parameters
    ----------
    graph : NeighborGraph
        With the main diagonal.
    borders : ndarray of shape (segments + 1,)
        Ascending frames; segment g is ``borders[g]..borders[g + 1]``, both inclusive.
    steps, skip_penalty, zero_cost, min_nodes, separation, max_slope
        As in `kineme.methods.region_growing.warping.warping_paths`.
    coverage : float
        Share of both segments that a path must cover.
    interpolate : bool
        Count the rows of a path between the borders of h (2017), or all of them (2014).
    connection : {"weak", "strong"}
        Links in one direction suffice (weak), or links in both directions are needed (strong).
    """
    n = len(borders) - 1

    # Rows are those of segment g, columns those of the whole recording.
    def find_links(g: int) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        paths = warping_paths(
            graph,
            (int(borders[g]), int(borders[g + 1]) + 1),
            (0, graph.n_columns),
            steps=steps,
            skip_penalty=skip_penalty,
            zero_cost=zero_cost,
            min_nodes=min_nodes,
            separation=separation,
            max_slope=max_slope,
        )
        linked: tuple[NDArray[np.int64], NDArray[np.float64]] = _kernels.find_linked_segments(
            paths.ptr, paths.rows, paths.columns, borders, g, coverage, interpolate
        )
        return linked

    targets, shares = zip(*map_threads(find_links, range(n)), strict=True)
    links = _make_link_matrix(targets, shares)
    _, components = connected_components(links, directed=True, connection=connection)
    return Clustering(number_by_appearance(components), _find_best_shares(links, components))


def _make_link_matrix(
    targets: Sequence[NDArray[np.int64]], shares: Sequence[NDArray[np.float64]]
) -> csr_array:
    """Return a sparse matrix of the largest share of each ordered pair of different segments."""
    n = len(targets)
    # Row of each link: the segment whose paths were searched.
    g = np.repeat(np.arange(n), [len(linked) for linked in targets])
    h, share = np.concatenate(targets), np.concatenate(shares)
    # Sort by pair, the largest share first.
    order = np.lexsort((-share, h, g))
    g, h, share = g[order], h[order], share[order]
    keep = g != h
    # Keep the first of each pair, which is the largest.
    keep[1:] &= (np.diff(g) != 0) | (np.diff(h) != 0)
    return csr_array((share[keep], (g[keep], h[keep])), shape=(n, n))


def _find_best_shares(links: csr_array, components: NDArray[np.int32]) -> NDArray[np.float64]:
    coo = links.tocoo()
    same = components[coo.row] == components[coo.col]
    # Both segments of a link within a cluster get its share.
    scores = np.zeros(len(components))
    np.maximum.at(scores, coo.row[same], coo.data[same])
    np.maximum.at(scores, coo.col[same], coo.data[same])
    return scores
