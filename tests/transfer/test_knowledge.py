"""KnowledgeBase: build, merge, write and read; damaged files give one clear error."""

from __future__ import annotations

import io
import json
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from kineme.datasets import Action, synthesize
from kineme.errors import KinemeError, ParameterError, ReadError, WriteError
from kineme.recordings import Motion
from kineme.transfer import KnowledgeBase
from segmentations import make_activities

MADE = synthesize([Action("walk", 3), Action("kick", 2), Action("walk", 2)], fps=60, seed=1)
BASE = KnowledgeBase.from_recording(MADE.motion, MADE.truth)


def make_base(digest: str, motion: Motion = MADE.motion) -> KnowledgeBase:
    provenance = replace(motion.provenance, path=f"{digest}.bvh", sha256=digest)
    return KnowledgeBase.from_recording(replace(motion, provenance=provenance), MADE.truth)


def are_same(a: KnowledgeBase, b: KnowledgeBase) -> bool:
    pairs = zip(a.columns().values(), b.columns().values(), strict=True)
    return np.array_equal(a.features, b.features) and all(np.array_equal(x, y) for x, y in pairs)


def test_every_labelled_primitive_is_in_it_once() -> None:
    assert BASE.counts() == {"kick": 2, "walk": 5}
    lasts = BASE.stop_s - BASE.start_s
    np.testing.assert_allclose(BASE.lengths / 15, lasts, atol=0.068)
    assert len(np.unique(BASE.primitives().runs)) == 3


def test_labels_of_activities_are_inherited_and_suffice() -> None:
    table = MADE.truth.table
    bare = np.where(table.level == "primitive", "", table.label)
    inherited = replace(MADE.truth, table=replace(table, label=bare))
    assert are_same(KnowledgeBase.from_recording(MADE.motion, inherited), BASE)
    only = replace(MADE.truth, table=table.select(table.level == "activity"))
    assert KnowledgeBase.from_recording(MADE.motion, only).counts() == {"kick": 1, "walk": 2}


def test_merging_keeps_all_and_replaces_a_recording_by_its_later_labels() -> None:
    one, two = make_base("a"), make_base("b")
    assert len(one + two) == 2 * len(BASE)
    renamed = replace(one, labels=np.full(len(one), "march"))
    assert (one + two + renamed).counts() == {"kick": 2, "march": len(BASE), "walk": 5}
    assert len(BASE + BASE) == 2 * len(BASE)  # of no file: nothing says they are the same


def test_what_is_written_is_read_back(tmp_path: Path) -> None:
    base = BASE + make_base("é")
    base.save(tmp_path / "base.npz")
    assert are_same(KnowledgeBase.load(tmp_path / "base.npz"), base)
    with np.load(tmp_path / "base.npz", allow_pickle=False) as file:
        assert json.loads(str(file["head"]))["schema"] == "kineme.knowledge/2"


def test_another_suffix_or_a_missing_folder_leaves_nothing(tmp_path: Path) -> None:
    for name in ("base.pkl", "nowhere/base.npz"):
        with pytest.raises(WriteError):
            BASE.save(tmp_path / name)
    assert not list(tmp_path.iterdir())


def store(head: object, **changed: object) -> bytes:
    arrays = {"features": BASE.features, **BASE.columns(), **changed}
    file = io.BytesIO()
    np.savez(file, head=np.array(json.dumps(head)), **arrays)
    return file.getvalue()


HEAD = {
    "schema": "kineme.knowledge/2",
    "fps": 15.0,
    "offsets_s": [-0.2, -0.1, 0.0, 0.1, 0.2],
    "unit": "directions",
}


@pytest.mark.parametrize(("content", "reason"), [
    (b"", "not a knowledge base, or is damaged"),
    (b"level,kind\n", "not a knowledge base, or is damaged"),
    (store({**HEAD, "schema": "kineme.knowledge/9"}), "has schema 'kineme.knowledge/9'"),
    (store({**HEAD, "schema": "kineme.knowledge/1"}), "build it again"),
    (store({**HEAD, "fps": 30.0}), "has fps 30.0, not 15.0"),
    (store([1]), "has schema"),
    (store(HEAD, lengths=BASE.lengths + 1), "lengths add up to"),
    (store(HEAD, labels=BASE.labels[1:]), "same length"),
    (store(HEAD, labels=np.arange(len(BASE))), "labels holds int"),
    (store(HEAD, features=BASE.features * np.nan), "must be finite"),
    (store(HEAD, sources=np.array([{}] * len(BASE))), "not a knowledge base, or is damaged"),
])  # fmt: skip
def test_a_bad_file_is_one_clear_error(tmp_path: Path, content: bytes, reason: str) -> None:
    path = tmp_path / "bad.npz"
    path.write_bytes(content)
    with pytest.raises(ReadError, match=reason):
        KnowledgeBase.load(path)


def test_a_missing_file_says_so(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match="no such file"):
        KnowledgeBase.load(tmp_path / "gone.npz")


@settings(max_examples=60)
@given(st.data())
def test_any_damage_is_an_error_of_ours_or_harmless(tmp_path_factory, data: st.DataObject) -> None:
    content = bytearray(store(HEAD))
    for _ in range(data.draw(st.integers(1, 4))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
    path = tmp_path_factory.mktemp("fuzz") / "base.npz"
    path.write_bytes(content[: data.draw(st.integers(0, len(content)))])
    try:
        KnowledgeBase.load(path)
    except KinemeError:
        return
    assert zipfile.is_zipfile(path)


def test_segments_without_labels_or_of_another_recording_teach_nothing() -> None:
    table = MADE.truth.table
    blank = replace(MADE.truth, table=replace(table, label=np.full(len(table), "")))
    with pytest.raises(ParameterError, match="nothing to learn"):
        KnowledgeBase.from_recording(MADE.motion, blank)
    with pytest.raises(ParameterError, match="have 9 frames"):
        KnowledgeBase.from_recording(MADE.motion, make_activities(9))
