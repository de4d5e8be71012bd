"""Clusters of more words than are compared each with each."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path

import pytest
from crowds import KINDS, bytes_of, crowd, joined, once_deadly

from kineme.library.executors import processes
from kineme.library.vocabulary import joining


def test_a_crowd_has_the_clusters_that_comparing_each_with_each_finds() -> None:
    words, kinds = crowd()
    told: list[str] = []
    whole = joined(words)
    in_turns = joined(words, progress=told.append, most=20)
    assert len({*zip(whole.labels.tolist(), kinds.tolist(), strict=True)}) == KINDS
    assert in_turns.labels.tolist() == whole.labels.tolist()
    common = kinds < KINDS - 1  # of what is rare, the next cluster may be of an earlier turn
    assert (in_turns.confidence[common] > 0.3).all()
    assert (in_turns.following != in_turns.labels).all()
    assert told[0].startswith("clusters in common: 20 of 153, ")
    assert told[0].endswith(" left")
    assert told[-1] == "clusters in common: 153 of 153"


def test_a_sample_never_joins_what_differs() -> None:
    words, _ = crowd()
    apart = joined(words, most=20, join=1e-3)
    assert len(set(apart.labels.tolist())) == len(apart.labels)


def test_processes_find_the_same_clusters_though_one_of_them_dies(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(joining, "PER_WORKER", 60)
    monkeypatch.setattr(joining, "BLOCK", 8)
    monkeypatch.setattr(joining, "AT_ONCE", 30)
    words, _ = crowd()
    here = joined(words, most=20)
    flag = tmp_path / "flag"
    flag.touch()
    with processes(2) as executor:
        there = joined(replace(words, load=partial(once_deadly, flag)), executor, most=20)
    assert not flag.exists()
    assert bytes_of(there) == bytes_of(here)
