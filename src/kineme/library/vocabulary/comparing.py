"""How far words are apart, found out by tasks of an executor.

A word is looked at by an example, its typical segment, and by a context, the activity around it: in
a cyclic movement, the example of one recording may be cut at another phase than that of the next.
The distance of two words is the mean of what it costs to find the example of each in the context of
the other.

A task tells where its words lie, and whoever works on it reads their features there: what goes to
another machine and back is small. Tasks are the same wherever they are worked on, and so are sums.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations_with_replacement
from typing import Any

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from kineme._threads import map_threads
from kineme.errors import KinemeError
from kineme.library.executors import Executor, Outcome, Task

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Float32s = NDArray[np.float32]

APART = 1e3
"""In each feature of a sample between two contexts: no match reaches over it."""
BLOCK = 100
"""Words that a task compares with as many others."""


@dataclass(frozen=True, eq=False)
class Word:
    """A cluster of one recording, as it is compared.

    Attributes
    ----------
    example, context : (samples, dims) array
        Features of its typical segment, and of the activity that this lies in.
    """

    example: Float32s
    context: Float32s


@dataclass(frozen=True, eq=False)
class Crowd:
    """Words of one vocabulary, which are loaded where they are compared.

    Attributes
    ----------
    load : callable
        The word at a place; it can be pickled, and so can places.
    places : sequence
        Of each word.
    recording : (words,) array
        Number of the recording that each is of.
    seconds : (words,) array
        Of all its segments.
    embeddings : (words, 32) array
        Of its typical segment.
    drawn : (words,) array
        Those of the least numbers are drawn for a sample first.
    """

    load: Callable[[Any], Word]
    places: Sequence[Any]
    recording: Ints
    seconds: Floats
    embeddings: Float32s
    drawn: NDArray[np.unsignedinteger[Any]]

    def __len__(self) -> int:
        return len(self.places)

    def part(self, numbers: Ints) -> Crowd:
        """These of its words."""
        return Crowd(
            self.load,
            [self.places[number] for number in numbers.tolist()],
            self.recording[numbers],
            self.seconds[numbers],
            self.embeddings[numbers],
            self.drawn[numbers],
        )


@dataclass(frozen=True, eq=False)
class _Pairs:
    """Words of a crowd, rows and columns of a table, to be compared."""

    load: Callable[[Any], Word]
    rows: slice
    columns: slice
    ones: Sequence[Any]
    others: Sequence[Any]


def two_way_distances(crowd: Crowd, executor: Executor, workers: int) -> Floats:
    """``distances[a, b]``: the mean of a's example found in b's context, and b's in a's.

    Parameters
    ----------
    crowd : Crowd
    executor : Executor
        Where words are compared.
    workers : int
        How many processes are worth to be started for it.
    """
    n = len(crowd)
    blocks = [slice(first, min(first + BLOCK, n)) for first in range(0, n, BLOCK)]
    tasks = [
        _Pairs(crowd.load, rows, columns, crowd.places[rows], crowd.places[columns])
        for rows, columns in combinations_with_replacement(blocks, 2)
    ]
    distances = np.zeros((n, n))
    for task, found in results(executor, _compared, tasks, workers):
        distances[task.rows, task.columns] = found
        distances[task.columns, task.rows] = found.T
    np.fill_diagonal(distances, 0.0)
    return distances


def results(
    executor: Executor, work: Callable[[Task], Outcome], tasks: Sequence[Task], workers: int
) -> Iterator[tuple[Task, Outcome]]:
    """What comes of tasks that compare words, as they come.

    Raises
    ------
    KinemeError
        A process that worked on one of them died, and another one did, too.
    """
    for task, outcome in executor.completed(work, tasks, workers=workers):
        if outcome is None:
            raise KinemeError(
                "the processes that compared clusters died: they may need more memory than there "
                "is; what was read is kept, build again"
            )
        yield task, outcome


def _compared(task: _Pairs) -> Floats:
    """The distance of each word of the rows from each of the columns."""
    ones = [task.load(place) for place in task.ones]
    others = ones if task.columns == task.rows else [task.load(place) for place in task.others]
    there = _all_costs(ones, Contexts(others))
    back = there if others is ones else _all_costs(others, Contexts(ones))
    both: Floats = (there + back.T) / 2
    return both


def _all_costs(words: Sequence[Word], contexts: Contexts) -> Floats:
    with threadpool_limits(1):  # sums do not depend on threads
        return np.array(map_threads(contexts.costs_of, words), np.float64)


class Contexts:
    """The contexts of several words, to look for examples in.

    Parameters
    ----------
    words : sequence of Word
    """

    def __init__(self, words: Sequence[Word]):
        gap = np.full((1, words[0].example.shape[1]), APART, np.float32)
        self._laid = np.concatenate([part for word in words for part in (word.context, gap)])
        self._ends = np.cumsum([len(word.context) + 1 for word in words])

    def costs_of(self, word: Word) -> Float32s:
        """What it costs to find the example of a word in each of the contexts."""
        from kineme.matching.subsequences import warped  # half a second, for who compares only

        costs = warped(word.example, self._laid)[0]
        costs[self._ends - 1] = np.inf
        starts = np.concatenate([[0], self._ends[:-1]])
        least: Float32s = np.minimum.reduceat(costs, starts)
        return least
