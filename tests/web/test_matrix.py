"""The tiles of the self-similarity matrix: what they show, and that they are pictures."""

from __future__ import annotations

import io
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

import kineme
from kineme.datasets import bundled_recording, bundled_truth
from kineme.features.similarity import (
    MAX_CELLS,
    SimilarityMatrix,
    compare_frames_of_motion,
    compare_frames_of_signal,
)
from kineme.recordings import Motion, Skeleton
from kineme.web.matrix import TILE, make_head, make_report_tiles, make_tile

RECORDING = kineme.read(bundled_recording())
MATRIX = compare_frames_of_motion(RECORDING)
LEG_JOINTS = [
    i for i, name in enumerate(RECORDING.skeleton.names) if name.endswith(("Leg", "Foot"))
]
LEGS = Motion(
    Skeleton([str(joint) for joint in LEG_JOINTS], [-1] * 6, np.zeros((6, 3))),
    RECORDING.positions[:, LEG_JOINTS],
    RECORDING.fps,
)


def shown(matrix: SimilarityMatrix, level: int = 0) -> np.ndarray:
    """A level put together from its tiles, 0 to 1."""
    count = -(-len(matrix.levels[level]) // TILE)
    rows = [[grey(make_tile(matrix, level, i, j)) for j in range(count)] for i in range(count)]
    return np.block(rows)


def grey(tile: bytes) -> np.ndarray:
    return np.asarray(Image.open(io.BytesIO(tile)).convert("L")) / 255


def test_tiles_make_up_a_symmetric_matrix_of_one_cell_per_tenth_of_a_second() -> None:
    picture = shown(MATRIX)
    assert picture.shape == (483, 483)  # 48.3 s
    np.testing.assert_array_equal(picture, picture.T)
    np.testing.assert_array_equal(picture.diagonal(), 1)


def test_cells_are_the_similarity_of_their_features() -> None:
    features = MATRIX.levels[0].astype(float)
    squared = ((features[:, None] - features) ** 2).sum(axis=2)
    np.testing.assert_allclose(shown(MATRIX), np.exp(-squared), atol=0.5 / 15 + 1e-3)


def test_coarser_levels_halve_until_one_tile_is_left() -> None:
    long = compare_frames_of_signal(np.random.default_rng(0).normal(size=(3001, 2)), 10.0)
    assert make_head(long).sizes == [3001, 1501, 751, 376, 188]
    assert shown(long, 4).shape == (188, 188)


@pytest.mark.parametrize(("motion", "times"), [(RECORDING, 3), (LEGS, 2)])
def test_from_afar_activities_are_plain_blocks(motion: Motion, times: float) -> None:
    """Frames of one activity are similar whatever their phase, those of different ones are not."""
    truth = kineme.read_segments(bundled_truth())
    matrix = compare_frames_of_motion(motion)
    assert make_head(matrix).sizes == [483, 242]
    cells = np.arange(242) / 5 + 0.1  # seconds
    rows = truth.activities
    owner = np.searchsorted(rows.start_s, cells, side="right") - 1
    same = (owner[:, None] == owner) & (rows.kind == "activity")[owner]
    picture = shown(matrix, 1)
    assert picture[same].mean() > times * picture[~same].mean()


@pytest.mark.parametrize("motion", [RECORDING, LEGS])
def test_a_gap_is_like_nothing(motion: Motion) -> None:
    holed = compare_frames_of_motion(replace(motion, gaps=((600, 900),)))
    for level, (start, stop) in enumerate(((100, 150), (51, 74))):
        picture = shown(holed, level)
        assert (picture[start:stop] == 0).all()
        assert picture[start - 10, start - 10] == 1


@pytest.mark.parametrize("channels", [1, 3, 40])
def test_signals_repeat_where_they_repeat(channels: int) -> None:
    times = np.arange(1200) / 60
    phases = np.random.default_rng(1).uniform(0, 6, (2, channels))
    signal = np.concatenate(
        [np.sin(2 * np.pi * times[:, None] + phases[0]), np.sin(3 * times[:, None] + phases[1])]
    )
    matrix = compare_frames_of_signal(1000 * signal + 7, 60.0)
    picture = shown(matrix)
    assert picture[50, 60] == 1  # a period of one second
    assert picture[50, 55] < 0.1
    np.testing.assert_array_equal(picture, shown(compare_frames_of_signal(signal, 60.0)))


def test_signals_that_are_still_or_missing_in_part() -> None:
    still = shown(compare_frames_of_signal(np.full((50, 2), 3.0), 10.0))
    np.testing.assert_array_equal(still, 1)
    values = np.random.default_rng(2).normal(size=(60, 2))
    values[20:30, 1] = np.nan
    holed = shown(compare_frames_of_signal(values, 10.0))
    assert (holed[20:30] == 0).all()
    assert holed[5, 5] == holed[45, 45] == 1
    np.testing.assert_array_equal(shown(compare_frames_of_signal(np.full(9, np.nan), 10.0)), 0)
    assert shown(compare_frames_of_signal(np.ones(1), 0.01)).shape == (1, 1)


def test_what_a_report_keeps_covers_the_recording_and_stays_within_its_bytes() -> None:
    tiles = make_report_tiles(MATRIX)
    assert sorted(tiles) == ["0/0/0", "0/1/0", "0/1/1", "1/0/0"]
    long = compare_frames_of_signal(np.random.default_rng(3).normal(size=(6200, 1)), 10.0)
    tiles = make_report_tiles(long)
    assert {"0/24/24", "0/24/23", "1/12/0"} <= tiles.keys()
    assert "0/24/22" not in tiles
    most = sum(map(len, tiles.values())) - 100_000
    fewer = make_report_tiles(long, most)
    assert {"0/24/24", "1/12/0"} <= fewer.keys() < tiles.keys()
    assert sum(map(len, fewer.values())) <= most


def test_more_than_an_hour_has_no_more_cells() -> None:
    matrix = compare_frames_of_signal(np.sin(np.arange(2 * 36_000)), 10.0)
    assert len(matrix.levels[0]) == MAX_CELLS
    assert matrix.fps == 5.0
