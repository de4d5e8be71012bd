"""Clusters of more words than are compared each with each."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from kineme.library.constants import VOCABULARY
from kineme.library.vocabulary.crowds import Crowd, clusters_in
from kineme.library.vocabulary.joining import Word

KINDS, RECORDINGS = 6, 30
RARE = 3
"""Recordings in which the last kind of movement is."""


def crowd() -> tuple[Crowd, np.ndarray]:
    """Words of some kinds of movement, one of each in a recording, and their kinds."""
    rng = np.random.default_rng(0)
    shapes = rng.normal(size=(KINDS, 24, 8))
    kinds, words = [], []
    for recording in range(RECORDINGS):
        for kind in range(KINDS - (recording >= RARE)):
            values = shapes[kind] + 0.2 * rng.normal(size=shapes[kind].shape)
            values /= np.linalg.norm(values, axis=1, keepdims=True)
            example = values.astype(np.float32)
            words.append(Word(example[4:20], example, recording, 1.0 + kind))
            kinds.append(kind)
    embeddings = np.array([word.example.mean(axis=0) for word in words])
    return Crowd(
        words.__getitem__,
        np.array([word.recording for word in words]),
        np.array([word.seconds for word in words]),
        embeddings,
        rng.permutation(len(words)),
    ), np.array(kinds)


def test_a_crowd_has_the_clusters_that_comparing_each_with_each_finds() -> None:
    words, kinds = crowd()
    whole = clusters_in(words, VOCABULARY)
    in_turns = clusters_in(words, replace(VOCABULARY, most=20))
    assert len({*zip(whole.labels.tolist(), kinds.tolist(), strict=True)}) == KINDS
    assert in_turns.labels.tolist() == whole.labels.tolist()
    common = kinds < KINDS - 1  # of what is rare, the next cluster may be of an earlier turn
    assert (in_turns.confidence[common] > 0.3).all()
    assert (in_turns.following != in_turns.labels).all()


def test_a_sample_never_joins_what_differs() -> None:
    words, _ = crowd()
    apart = clusters_in(words, replace(VOCABULARY, most=20, join=1e-3))
    assert len(set(apart.labels.tolist())) == len(apart.labels)
