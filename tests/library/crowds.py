"""Words of a vocabulary whose kinds are known, loaded here or in other processes."""

from __future__ import annotations

import os
import signal
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from kineme.library.executors import InProcess
from kineme.library.settings import VOCABULARY
from kineme.library.vocabulary.joining import Crowd, Joined, Word, clusters_in

KINDS, RECORDINGS = 6, 30
RARE = 3
"""Recordings in which the last kind of movement is."""


def crowd() -> tuple[Crowd, np.ndarray]:
    """Words of some kinds of movement, one of each in a recording, and their kinds.

    Each kind is an arc in a plane of its own: nothing in one is like anything in another.
    """
    rng = np.random.default_rng(1)
    angle = np.linspace(0, np.pi, 24)
    shapes = np.zeros((KINDS, 24, 2 * KINDS))
    for kind in range(KINDS):
        shapes[kind, :, 2 * kind : 2 * kind + 2] = np.column_stack([np.cos(angle), np.sin(angle)])
    kinds, words, recordings = [], [], []
    for recording in range(RECORDINGS):
        for kind in range(KINDS - (recording >= RARE)):
            values = shapes[kind] + 0.1 * rng.normal(size=shapes[kind].shape)
            values /= np.linalg.norm(values, axis=1, keepdims=True)
            example = values.astype(np.float32)
            words.append(Word(example[4:20], example))
            kinds.append(kind)
            recordings.append(recording)
    embeddings = np.array([word.example.mean(axis=0) for word in words])
    seconds, drawn = 1.0 + np.array(kinds), rng.permutation(len(words)).astype(np.uint64)
    return Crowd(at_hand, words, np.array(recordings), seconds, embeddings, drawn), np.array(kinds)


def at_hand(word: Word) -> Word:
    """Loads a word that is its own place."""
    return word


def once_deadly(flag: Path, word: Word) -> Word:
    """The same, and ends the process for the first that loads one."""
    try:
        flag.unlink()
    except FileNotFoundError:
        return word
    os.kill(os.getpid(), signal.SIGKILL)
    raise AssertionError


def joined(words: Crowd, executor: Any = None, progress: Any = None, **constants: Any) -> Joined:
    """The clusters of words, by other constants."""
    told = progress or (lambda _: None)
    return clusters_in(words, replace(VOCABULARY, **constants), executor or InProcess(), told)


def bytes_of(found: Joined) -> tuple[bytes, ...]:
    return tuple(column.tobytes() for column in found)
