"""A library, asked, searched, edited and cut into clips."""

from __future__ import annotations

import csv
import json
import shutil
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from library_folders import write_channels
from matplotlib.image import imread
from pyarrow import parquet

import kineme
import naive
from kineme.errors import KinemeWarning, ParameterError, ReadError, WriteError
from kineme.library import Example, Library, build, finding
from kineme.library._kernels import find_smallest_distances
from kineme.library.storage import tables as storage
from kineme.library.windows import FINER, LENGTHS, describe_at_speeds, describe_windows
from kineme.segments.table import COLUMNS


def test_segments_are_those_of_each_recording_alone(library: Library) -> None:
    alone = kineme.segment(library.read("walk.bvh"))
    rows = library.query("from segments where recording = 'walk.bvh' order by segment").to_pydict()
    for name in COLUMNS:
        if name not in ("cluster", "action"):
            own = getattr(alone.table, name).tolist()
            assert [x for x in rows[name] if x == x] == [x for x in own if x == x]
    assert rows["own_cluster"] == alone.table.cluster.tolist()


def test_a_movement_in_two_recordings_is_one_cluster(library: Library) -> None:
    # Both hold the frames 1200 to 1500 of the bundled recording, in which somebody waves.
    both = [each for each in library.clusters() if each.recordings == 2]
    assert both
    assert {each.vocabulary for each in library.clusters()} == {
        "bodies", library.recordings["vocabulary"][2]
    }  # fmt: skip


def test_search_finds_the_example_and_its_like_wherever_it_is(library: Library) -> None:
    hits = library.search("walk.bvh", 0.5, 1.6)
    assert hits[0].recording == "walk.bvh"
    assert (hits[0].start_s, hits[0].stop_s) == pytest.approx((0.5, 1.6), abs=0.1)
    assert hits[0].distance < 0.01
    assert [hit.distance for hit in hits] == sorted(hit.distance for hit in hits)
    assert len(library.search("walk.bvh", 0.5, 1.6, top=3)) == 3
    one = library.search("walk.bvh", 0.5, 1.6, max_per_recording=1)
    assert len({hit.recording for hit in one}) == len(one)
    assert all(hit.distance <= 0.3 for hit in library.search("walk.bvh", 0.5, 1.6, threshold=0.3))


def test_a_recording_in_hand_or_a_file_is_searched_for_as_well(library: Library) -> None:
    motion = kineme.read(kineme.bundled_recording())
    known = library.search("walk.bvh", 0.5, 1.6, top=5)
    for example in (motion, kineme.bundled_recording()):
        found = library.search(example, 0.5, 1.6, top=5)
        assert [hit[:3] for hit in found] == [hit[:3] for hit in known]


def test_a_hit_is_of_the_library_whatever_files_are_called_so(
    library: Library, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    hit = library.search("walk.bvh", 2.0, 3.2, top=1)[0]
    (tmp_path / "walk.bvh").write_text("something else")
    monkeypatch.chdir(tmp_path)
    assert library.search(hit, top=1)[0][:2] == library.search([hit], top=1)[0][:2] == hit[:2]
    assert library.search(cluster=hit.cluster, top=1)
    with pytest.raises(ReadError):
        library.search("walk.bvh", 2.0, 3.2)


def test_channels_are_searched_in_their_own_features(library: Library) -> None:
    hits = library.search("wrist.csv", 2.0, 6.0)
    assert {hit.recording for hit in hits} == {"wrist.csv"}
    assert all(hit.stop_s < 22 for hit in hits[:3])
    with pytest.raises(ParameterError, match="cannot be compared"):
        library.search([Example("wrist.csv", 2.0, 6.0), Example("walk.bvh", 0.5, 1.6)])
    with pytest.raises(ParameterError, match="the library has"):
        library.search(kineme.Signals([[0.0, 1.0, 2.0]] * 300, 30.0))


def test_several_examples_find_what_each_finds(library: Library) -> None:
    one, other = Example("walk.bvh", 0.5, 1.6), Example("jacks.bvh", 20.0, 21.5)
    both = library.search([one, other], top=None)
    for example in (one, other):
        best = library.search(example, top=1)[0]
        assert best in both
    for hit, after in pairwise(both):
        assert hit.distance <= after.distance
    spans = sorted((hit.recording, hit.start_s, hit.stop_s) for hit in both)
    assert all(a[0] != b[0] or a[2] <= b[1] + 1e-9 for a, b in pairwise(spans))


def test_counterexamples_take_away_what_is_more_like_them(library: Library) -> None:
    example = Example("walk.bvh", 0.5, 1.6)
    hits = library.search(example, threshold=1.2, top=None)
    worst = hits[-1]
    refused = Example(worst.recording, worst.start_s, worst.stop_s)
    kept = library.search(example, unlike=[refused], threshold=1.2, top=None)
    assert kept[0] == hits[0]
    assert worst not in kept
    assert set(kept) <= set(hits)


def test_a_cluster_is_searched_for_by_number_and_name(library: Library) -> None:
    largest = library.clusters()[0]
    library.name(largest.cluster, np.str_("most of it"))
    hits = library.search(cluster="most of it", top=5)
    assert hits == library.search(cluster=largest.cluster, top=5)
    assert hits[0].label == "most of it"
    with pytest.raises(ParameterError, match="no cluster is called swim"):
        library.search(cluster="swim")
    with pytest.raises(ParameterError, match="nothing to search for"):
        library.search()


def test_the_mirror_image_is_found_unless_left_out(library: Library, tmp_path: Path) -> None:
    mirrored = kineme.mirror(kineme.read(kineme.bundled_recording())[0:300])
    plain = library.search(mirrored, 0.5, 1.6, top=1, mirror=False)[0]
    found = library.search(mirrored, 0.5, 1.6, top=1)[0]
    assert found.distance < 0.15 < plain.distance


@pytest.mark.parametrize(
    ("example", "error"),
    [
        (("nowhere.bvh", 0.0, 1.0), ReadError),
        (("walk.bvh", 500.0, None), ParameterError),
        (("walk.bvh", 2.0, 1.0), ParameterError),
        (("walk.bvh", float("nan"), 1.0), ParameterError),
        ((3,), ParameterError),
    ],
)
def test_an_example_that_is_none_is_refused(
    library: Library, example: tuple[object, ...], error: type[Exception]
) -> None:
    with pytest.raises(error):
        library.search(*example)


def test_names_merges_and_splits_outlast_a_build(folder: Path, takes: Path, tmp_path: Path) -> None:
    library = Library(folder)
    bodies = [each for each in library.clusters() if each.vocabulary == "bodies"]
    first, second = bodies[0].cluster, bodies[1].cluster
    library.name(first, "walk").merge("walk", second)
    shared = next(each for each in bodies if each.recordings == 2)
    part = library.split(shared.cluster, ["walk.bvh"])
    before = {each.cluster: each for each in library.clusters()}
    shutil.copy(takes / "walk.bvh", tmp_path / "again.bvh")
    build(tmp_path / "again.bvh", folder)
    after = {each.cluster: each for each in Library(folder).clusters()}
    assert after.keys() == before.keys()
    assert second not in after
    assert after[part].recordings == 1
    assert after[Library(folder).numbers("walk")[0]].label == "walk"
    labels = Library(folder).query("select distinct label, action_label from segments").to_pylist()
    assert {"label": "walk", "action_label": "walk"} in labels


def test_a_number_is_never_given_twice(folder: Path, takes: Path, tmp_path: Path) -> None:
    used = {each.cluster for each in Library(folder).clusters()}
    build((), folder, remove=[takes])
    assert len(Library(folder)) == 0
    assert Library(folder).table().num_rows == len(Library(folder).clusters()) == 0
    write_channels(tmp_path / "other.csv", seed=3)
    build(tmp_path / "other.csv", folder)
    assert not used & {each.cluster for each in Library(folder).clusters()}


def test_splits_that_make_no_sense_are_refused(library: Library) -> None:
    number = library.clusters()[0].cluster
    for recordings in ([], ["wrist.csv", "walk.bvh", "jacks.bvh"]):
        with pytest.raises(ParameterError, match="can only be split by naming some"):
            library.split(number, recordings)
    with pytest.raises(ParameterError, match=r"no recording 'nobody\.bvh' in the library"):
        library.split(number, ["nobody.bvh"])
    with pytest.raises(ParameterError, match="one line of plain text"):
        library.name(number, "two\nlines")
    with pytest.raises(ParameterError, match="a name must be a text, not 5"):
        library.name(number, 5)  # type: ignore[arg-type]
    with pytest.raises(ParameterError, match=r"must be a list of texts, not 'walk\.bvh'"):
        library.split(number, "walk.bvh")


def test_merges_keep_the_only_name_and_the_kind_of_recording(library: Library) -> None:
    bodies, channels = (
        [each.cluster for each in library.clusters() if (each.vocabulary == "bodies") == is_body]
        for is_body in (True, False)
    )
    library.name(bodies[1], "walk").merge(bodies[0], "walk")
    assert library.numbers("walk") == [bodies[0]]
    with pytest.raises(ParameterError, match="and of bodies cannot be merged"):
        library.merge("walk", channels[0])
    assert library.numbers("walk") == [bodies[0]]


def test_an_open_library_sees_what_others_change(folder: Path, takes: Path, tmp_path: Path) -> None:
    library = Library(folder)
    number = library.clusters()[0].cluster
    Library(folder).name(number, "walk")
    assert library.numbers("walk") == [number]
    shutil.copy(takes / "walk.bvh", tmp_path / "again.bvh")
    build(tmp_path / "again.bvh", folder)
    counted = library.query("select count(distinct recording) n from embeddings").to_pylist()
    assert counted == [{"n": len(library)}] == [{"n": 4}]


def test_questions_in_sql(library: Library) -> None:
    answer = library.query(
        "select recording, sum(stop_s - start_s) s from segments where level = 'activity' "
        "group by recording order by recording"
    ).to_pydict()
    assert answer["recording"] == library.recordings["recording"]
    assert answer["s"] == pytest.approx(library.recordings["duration_s"])
    near = library.query("select count(*) n from embeddings").to_pylist()[0]["n"]
    assert near == library.query(
        "select count(*) n from segments where kind != 'transition' and recording != 'none'"
    ).to_pylist()[0]["n"]  # fmt: skip
    for wrong in ("select", "from nowhere", "select * from '/etc/passwd'"):
        with pytest.raises(ParameterError):
            library.query(wrong)


def test_tables_are_taken_along(library: Library, tmp_path: Path) -> None:
    library.name(library.clusters()[0].cluster, "most of it")
    library.export(tmp_path / "table.parquet")
    library.export(tmp_path / "table.csv")
    rows = parquet.read_table(tmp_path / "table.parquet").to_pylist()
    with (tmp_path / "table.csv").open(newline="") as file:
        texts = list(csv.DictReader(file))
    assert [row["recording"] for row in rows] == [row["recording"] for row in texts]
    assert {"most of it", ""} == {row["label"] for row in texts}
    assert library.table().to_pandas().recording.nunique() == 3
    with pytest.raises(WriteError, match="suffix"):
        library.export(tmp_path / "table.xlsx")


def test_hits_become_clips(library: Library, tmp_path: Path) -> None:
    hits = library.search("walk.bvh", 0.5, 1.6, top=3)
    clips = library.clips(hits, tmp_path / "clips")
    assert len(clips) == 3
    assert kineme.read(clips[0]).duration == pytest.approx(
        hits[0].stop_s - hits[0].start_s, abs=0.1
    )
    assert (tmp_path / "clips" / "manifest.csv").is_file()


def test_readers_of_another_schema_are_told_to_build_anew(folder: Path) -> None:
    head = json.loads((folder / "library.json").read_text())
    (folder / "library.json").write_text(json.dumps({**head, "schema": "kineme.library/9"}))
    with pytest.raises(ReadError, match="kineme.library/9"):
        Library(folder)


def test_columns_of_the_docs_are_those_of_the_tables() -> None:
    text = (Path(__file__).parents[2] / "docs" / "library.md").read_text(encoding="utf-8")
    types = {str: "text", int: "whole number", float: "number"}
    for name, columns in storage.DESCRIBED.items():
        for column, known in columns.items():
            if (name, column) != ("embeddings", "embedding") and column not in COLUMNS:
                assert f"| `{column}` | {types[known.type]} | {known.meaning} |" in text


def test_each_cluster_has_a_picture(library: Library, tmp_path: Path) -> None:
    library.name(0, "walk / run")
    written = library.pictures(tmp_path / "pictures")
    numbers = sorted(each.cluster for each in library.clusters())
    names = {path.name for path in written}
    assert names == {"clusters.png", "cluster-0-walk-run.png"} | {
        f"cluster-{number}.png" for number in numbers[1:]
    }
    assert imread(written[0]).shape[0] > imread(written[1]).shape[0]


def test_an_example_that_stops_beyond_its_end_is_said_to_be_cut(library: Library) -> None:
    with pytest.warns(KinemeWarning, match=r"stops at 900 s, its recording lasts .* to its end"):
        beyond = library.search("walk.bvh", 0.5, 900.0)
    assert beyond == library.search("walk.bvh", 0.5)


OTHERS = ("throwBasketball", "squat1Reps", "rotateArmsBothBackward1Reps")


@pytest.fixture(scope="module")
def exercises(data_dir: Path, tmp_path_factory: pytest.TempPathFactory) -> Library:
    """Walks of two people of CMU and of subject 86, and a few exercises of three of HDM05."""
    takes = [data_dir / "cmu_formats" / "02_01.amc", data_dir / "cmu_formats" / "49_02.amc"]
    for actor in ("bd", "bk", "dg"):
        for kind in (*OTHERS, "sneak2StepsLStart"):
            takes += sorted((data_dir / "hdm05" / "amc").glob(f"HDM_{actor}_{kind}_*.amc"))[:1]
    folder = tmp_path_factory.mktemp("people") / "library"
    built = build(takes, folder)
    assert not built.failed
    return Library(folder)


def test_a_walk_is_found_whoever_walks_and_nothing_else(exercises: Library, data_dir: Path) -> None:
    # A double step of subject 86, who is not in the library.
    hits = exercises.search(data_dir / "cmu86" / "86_01.amc", 2.0, 3.1, top=None)
    found = {hit.recording for hit in hits}
    assert "02_01.amc" in found
    assert not [name for name in found if any(kind in name for kind in OTHERS)]


def test_an_exercise_is_found_in_those_of_other_people(exercises: Library) -> None:
    names = exercises.recordings["recording"]
    example = next(name for name in names if "bd_rotate" in name)
    hits = exercises.search(example, max_per_recording=1, top=None)
    others = {hit.recording for hit in hits if "_bd_" not in hit.recording}
    assert others == {name for name in names if "rotate" in name and "_bd_" not in name}


def test_what_is_searched_first_holds_what_an_exact_search_finds(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    exact = Library(folder)
    monkeypatch.setattr(storage, "FROM_HOURS", 0.0)
    monkeypatch.setattr(finding, "SHARE", 0.2)
    monkeypatch.setattr(finding, "MORE", 1)
    storage.write_index(folder, exact.head["tables"], exact.recordings)
    indexed = Library(folder)
    for example in (Example("walk.bvh", 2.0, 3.2), Example("jacks.bvh", 4.0, 7.5)):
        few, all_ = (
            {(hit.recording, hit.start_s): hit.distance for hit in library.search(example, top=5)}
            for library in (indexed, exact)
        )
        assert len(few.keys() & all_.keys()) >= 0.8 * len(all_)
        assert min(few.values()) < 0.01
    clean = indexed.search("wrist.csv", 2.0, 4.0, top=3)  # channels have no index
    assert clean == exact.search("wrist.csv", 2.0, 4.0, top=3)


def test_the_window_that_is_the_example_is_the_nearest() -> None:
    features = np.random.default_rng(1).normal(size=(300, 40)).astype(np.float32)
    step = LENGTHS[1] // 2
    example = features[4 * step : 4 * step + LENGTHS[1]]
    windows, parts = describe_windows(features, LENGTHS[1]), describe_at_speeds(example)
    least = np.empty(len(windows), np.int32)
    find_smallest_distances(windows, parts, np.int32(FINER), least)
    assert least.tolist() == naive.find_smallest_distances(windows.tolist(), parts.tolist(), FINER)
    assert least.argmin() == 4
    windows[:], parts[:] = -127, 127 * FINER  # the farthest there is
    find_smallest_distances(windows, parts, np.int32(FINER), least)
    assert least.tolist() == naive.find_smallest_distances(windows.tolist(), parts.tolist(), FINER)


@pytest.fixture(scope="module")
def twice(tmp_path_factory: pytest.TempPathFactory) -> Library:
    """A library of the same recording under two names, one of them cut a bit shorter."""
    home = tmp_path_factory.mktemp("twice")
    (home / "takes").mkdir()
    shutil.copy(kineme.bundled_recording(), home / "takes" / "a.bvh")
    kineme.write(kineme.read(kineme.bundled_recording())[:2890], home / "takes" / "b.bvh")
    build(home / "takes", home / "library", jobs=1)
    return Library(home / "library")


def test_duplicates_are_left_out_and_ranks_go_over_all(twice: Library, tmp_path: Path) -> None:
    paths = twice.loops(tmp_path / "clips", best=2)
    clips = json.loads((tmp_path / "clips" / "manifest.json").read_text())["clips"]
    assert len(clips) == len(paths)
    spans = [(clip["start_frame"], clip["stop_frame"]) for clip in clips]
    assert len(spans) == len(set(spans))  # each of them is in both recordings
    for cluster in {clip["cluster"] for clip in clips}:
        ranks = [clip["rank"] for clip in clips if clip["cluster"] == cluster]
        assert ranks in ([1], [1, 2])
    with pytest.raises(ParameterError, match="choose from cluster, direction, recording"):
        twice.loops(tmp_path / "more", per="take")  # type: ignore[arg-type]


def test_each_recording_can_have_its_own(twice: Library, tmp_path: Path) -> None:
    twice.loops(tmp_path / "clips", best=1, per="recording", target="unreal")
    clips = json.loads((tmp_path / "clips" / "manifest.json").read_text())["clips"]
    assert len({Path(clip["source"]).name for clip in clips}) == 2
    assert all(clip["file"].startswith("AS_") for clip in clips)


def test_coverage_tells_directions_speeds_and_turns(twice: Library) -> None:
    covered = twice.coverage()
    fast = max(covered, key=lambda each: each.fastest_m_s)
    assert fast.direction == "forwards"
    assert 2.2 < fast.fastest_m_s < 3.2
    assert max(each.left_deg for each in covered) > 90
    assert {"forwards", "in place"} == {each.direction for each in covered}


def test_a_search_finds_those_with_a_tag(twice: Library) -> None:
    hits = twice.search("a.bvh", 0.5, 1.6, top=4, tag="turn left")
    every = twice.search("a.bvh", 0.5, 1.6, top=None)
    assert 0 < len(hits) <= 4
    assert {*hits} < {*every}
    with pytest.raises(ParameterError, match="choose from forwards, backwards"):
        twice.search("a.bvh", 0.5, 1.6, tag="north")  # type: ignore[arg-type]
