"""The picture: what it shows, what it costs, where it goes."""

from __future__ import annotations

import subprocess
import sys
import tracemalloc
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.image import imread

import kineme
from kineme.errors import ParameterError, WriteError
from kineme.plot import matrix, plot_matrix, plot_segmentation, plot_strip
from kineme.recordings import Motion, Signals, Skeleton
from kineme.recordings.operations import turn
from kineme.segments.display import NO_CLUSTER, PALETTE, TRANSITION
from kineme.segments.segmentation import Segmentation
from segmentations import from_rows, segmentations


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("pictures")


def make_turning(frames: int, fps: float = 30.0) -> Signals:
    """A point that goes round and round."""
    angle = np.linspace(0, 40, frames)
    return Signals(np.column_stack([np.cos(angle), np.sin(angle)]), fps)


def make_primitives(stops: list[int], clusters: list[int]) -> Segmentation:
    """One activity of primitives that stop at these frames."""
    spans = zip([0, *stops], stops, clusters, strict=False)
    rows = [("activity", "activity", 0, stops[-1], -1, "")]
    return from_rows(rows + [("primitive", "activity", *span, "") for span in spans])


def make_whole(n_frames: int) -> Segmentation:
    return make_primitives([n_frames], [0])


def test_an_hour_takes_little_memory(folder: Path) -> None:
    frames = 108_000
    result = make_primitives([*range(40, frames + 1, 40)], [i % 300 for i in range(frames // 40)])
    recording = make_turning(frames)
    tracemalloc.start()
    plot_segmentation(result, recording, folder / "hour.png")
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 200e6
    assert imread(folder / "hour.png").shape[0] < 4000


@pytest.mark.parametrize("suffix", [".png", ".pdf", ".svg"])
def test_pictures_by_suffix(folder: Path, suffix: str) -> None:
    path = folder / f"picture{suffix}"
    plot_segmentation(make_whole(90), make_turning(90), path)
    first = {".png": b"\x89PNG", ".pdf": b"%PDF", ".svg": b"<?xml"}[suffix]
    assert path.read_bytes().startswith(first)


def test_what_cannot_be_written_leaves_nothing(tmp_path: Path) -> None:
    with pytest.raises(WriteError, match=r"pictures are written as \.png"):
        plot_segmentation(make_whole(9), make_turning(9), tmp_path / "x.bmp")
    with pytest.raises(WriteError, match="does not exist"):
        plot_segmentation(make_whole(9), make_turning(9), tmp_path / "none" / "x.png")
    assert list(tmp_path.iterdir()) == []


def test_a_picture_needs_the_recording_of_the_segments(tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match="give the segments of this recording"):
        plot_segmentation(make_whole(9), make_turning(8), tmp_path / "x.png")
    with pytest.raises(ParameterError, match="Motion or Signals"):
        plot_segmentation(make_whole(9), np.zeros((9, 2)), tmp_path / "x.png")  # type: ignore[arg-type]


@settings(max_examples=30)
@given(segmentations())
def test_every_segmentation_can_be_drawn(result: Segmentation) -> None:
    axes = Figure().add_subplot()
    plot_matrix(result, make_turning(result.n_frames, result.fps), ax=axes)
    legend = [text.get_text() for text in axes.get_legend().get_texts()]
    for cluster, count in result.repetitions().items():
        assert f"{cluster}  ({count}×)" in legend


def test_a_cluster_without_repetitions_is_drawn() -> None:
    result = from_rows([
        ("activity", "activity", 0, 40, 0, ""),  # standing
        ("activity", "activity", 40, 100, 1, ""),
        ("primitive", "transition", 0, 40, -1, ""),
        ("primitive", "primitive", 40, 90, 1, ""),
        ("primitive", "transition", 90, 100, -1, ""),
    ])  # fmt: skip
    axes = Figure().add_subplot()
    plot_matrix(result, make_turning(100), ax=axes)
    legend = axes.get_legend()
    assert [text.get_text() for text in legend.get_texts()] == ["0", "1  (1×)", "none"]
    bars = axes.collections[-1].get_facecolors()
    shown = [to_hex(color, keep_alpha=False).upper() for color in bars]
    assert shown == [PALETTE[0].upper(), PALETTE[1].upper(), TRANSITION.upper()]


def test_a_legend_of_many_clusters_says_how_many_are_left_out() -> None:
    n = 50
    result = make_primitives([*range(1, n + 1)], [*range(n - 1), 17])
    axes = Figure().add_subplot()
    plot_matrix(result, make_turning(n), ax=axes)
    legend = [text.get_text() for text in axes.get_legend().get_texts()]
    assert "17  (2×)" in legend
    assert legend[-1] == f"and {n - 1 - matrix.MAX_LEGEND} more"


def test_no_global_plotting_state() -> None:
    code = "import sys, kineme.plot; print('matplotlib.pyplot' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"


# Linear RGB as seen without red, green or blue cones: Machado, Oliveira and Fernandes 2009.
BLINDNESS = {
    "protanopia": [[0.152, 1.053, -0.205], [0.115, 0.786, 0.099], [-0.004, -0.048, 1.052]],
    "deuteranopia": [[0.367, 0.861, -0.228], [0.280, 0.673, 0.047], [-0.012, 0.043, 0.969]],
    "tritanopia": [[1.256, -0.077, -0.179], [-0.078, 0.931, 0.148], [0.005, 0.691, 0.304]],
}


@pytest.mark.parametrize("kind", ["none", *BLINDNESS])
def test_colours_stay_apart_for_colour_blind_eyes(kind: str) -> None:
    matrix = np.array(BLINDNESS.get(kind, np.eye(3)))
    seen = [to_lab(matrix @ to_linear(color)) for color in (*PALETTE, NO_CLUSTER)]
    for one, other in combinations(seen, 2):
        assert np.linalg.norm(one - other) > 10


def to_linear(color: str) -> np.ndarray:
    channels = np.array([int(color[i : i + 2], 16) / 255 for i in (1, 3, 5)])
    return np.where(channels <= 0.04045, channels / 12.92, ((channels + 0.055) / 1.055) ** 2.4)


def to_lab(rgb: np.ndarray) -> np.ndarray:
    """CIE L*a*b* of linear sRGB."""
    to_xyz = [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]
    x, y, z = np.cbrt(np.array(to_xyz) @ np.clip(rgb, 0, 1) / [0.9505, 1.0, 1.089])
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


def test_poses_look_alike_wherever_somebody_faces() -> None:
    walk = kineme.read(kineme.bundled_recording()).seconds(0.5, 1.6)
    drawn = [
        np.array(plot_strip(each, ax=Figure().subplots()).collections[0].get_segments())
        for each in (walk, turn(walk, np.radians(70)))
    ]
    assert len(drawn[0]) == 7 * sum(parent >= 0 for parent in walk.skeleton.parents)
    np.testing.assert_allclose(*drawn, atol=1e-6)


def test_points_and_channels_are_drawn_without_bones() -> None:
    rng = np.random.default_rng(0)
    points = Motion(Skeleton(("a", "b"), (-1, -1), np.zeros((2, 3))), rng.normal(size=(9, 2, 3)), 9)
    dots = plot_strip(points, poses=3, ax=Figure().subplots()).collections[0]
    assert len(dots.get_offsets()) == 6
    channels = Signals(rng.normal(size=(90, 20)), 30, tuple(f"c{i}" for i in range(20)))
    assert len(plot_strip(channels, 1.0, 2.0, ax=Figure().subplots()).lines) == 12


@pytest.mark.parametrize("span", [(9.0, None), (2.0, 1.0), (-1.0, 2.0), (0.0, "end")])
def test_a_span_that_is_none_is_refused(span: tuple[float, float]) -> None:
    signals = Signals(np.zeros((90, 2)), 30, ("a", "b"))
    with pytest.raises(ParameterError, match="a span must be within the 3.00 s"):
        plot_strip(signals, *span, ax=Figure().subplots())
