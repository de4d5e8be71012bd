"""What clips are called: letters that survive import, and no two names of a run the same."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import jsonschema
import pytest
from hypothesis import given
from hypothesis import strategies as st

import kineme
from kineme.clips.options import make_clip_name, make_file_name, make_unique_name
from kineme.clips.split import write_clips
from kineme.recordings import Motion
from kineme.segments.table import Segment
from manifests import SCHEMA, read_manifest

NAME = SCHEMA["properties"]["clips"]["items"]["properties"]["name"]

words = st.sampled_from(["x", "X", "_", " ", "-", "1", "0000", "0001", "0002", "n0001", "é"])
texts = st.lists(words, max_size=5).map("".join) | st.text(max_size=40)
runs = st.lists(st.tuples(texts, st.lists(texts, max_size=4)), max_size=4)


@given(st.text(max_size=40), st.integers(0, 99999), st.text(max_size=40))
def test_names_survive_import_and_tell_the_number(stem: str, number: int, label: str) -> None:
    name = make_clip_name(stem, number, label)
    jsonschema.validate(name, NAME)
    assert f"_{number:04d}_" in name


@given(runs)
def test_no_two_names_of_a_run_are_the_same_whatever_the_case(run) -> None:
    names, clips, together = list[str](), list[str](), list[str]()
    for stem, labels in run:
        together.append(make_unique_name(stem, len(names), set(together)).casefold())
        for label in labels:
            clips.append(make_file_name(stem, len(names), label).casefold())
            names.append(make_clip_name(stem, len(names), label).lower())
    for each in (names, clips, together):
        assert len(set(each)) == len(each)


@pytest.mark.parametrize("suffix", ["trc", "glb"])
def test_clips_whose_names_read_the_same_are_files_of_their_own(
    tmp_path: Path, motion: Motion, truth: kineme.Segmentation, suffix: str
) -> None:
    def recording(name: str, *labels: str) -> tuple[Motion, list[Segment]]:
        provenance = replace(motion.provenance, path=f"{name}.bvh")
        rows = [replace(truth.activities[0], stop_frame=10, label=label) for label in labels]
        return replace(motion[:20], provenance=provenance), rows

    run = [
        recording("x_0001", "0002 y"),
        recording("x", "0002 y"),
        recording("x_0001", "y"),
        recording("X", "y", "y"),
    ]
    paths = write_clips(run, tmp_path / "clips", format=suffix)
    told = read_manifest(tmp_path / "clips")
    assert len({clip["name"].lower() for clip in told}) == len(told) == 5
    assert len({path.name.lower() for path in paths}) == (5 if suffix == "trc" else 4)
    for path, clip in zip(paths, told, strict=True):
        assert kineme.read(path, take=clip["take"]).n_frames == 10
