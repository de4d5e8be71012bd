"""The estimators themselves: rtmlib with a stand-in for its models, MediaPipe with real videos."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import kineme
from kineme.errors import ReadError
from kineme.pose.mediapipe_estimator import start_mediapipe
from kineme.pose.rtmlib_estimator import ESTIMATOR as RTMLIB


def make_stand_in(*boxes: tuple[int, int, int, int]) -> SimpleNamespace:
    """rtmlib, as far as it is used: as many people as boxes, in a picture of blue, green, red."""

    def find(picture: np.ndarray, bboxes: list) -> tuple[np.ndarray, np.ndarray]:
        assert picture[0, 0].tolist() == [3, 2, 1]
        assert picture.flags.c_contiguous
        corners = np.array([box[:2] for box in bboxes], np.float32)
        return np.repeat(corners[:, None], 26, axis=1), np.full((len(bboxes), 26), 0.8, np.float32)

    model = SimpleNamespace(det_model=lambda picture: list(boxes), pose_model=find)
    return SimpleNamespace(BodyWithFeet=lambda pose: model)


def test_rtmlib_finds_several_people_or_nobody(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "rtmlib", make_stand_in((5, 6, 20, 40), (30, 6, 50, 40)))
    picture = np.full((48, 64, 3), (1, 2, 3), np.uint8)
    with RTMLIB.start(None) as estimate:
        poses = estimate(picture, 0.0)
    assert [pose.image[0].tolist() for pose in poses] == [[5, 6], [30, 6]]
    assert all(len(pose.image) == len(RTMLIB.keypoints) for pose in poses)
    assert poses[0].metres is None
    monkeypatch.setitem(sys.modules, "rtmlib", make_stand_in())
    with RTMLIB.start(None) as estimate:
        assert estimate(picture, 0.0) == []


def test_a_later_mediapipe_says_where_a_model_is(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "mediapipe", SimpleNamespace(__version__="1.2.3"))
    with (
        pytest.raises(ReadError, match=r"download https://\S+\.task and .* --pose-model"),
        start_mediapipe(None),
    ):
        pass


def test_what_is_no_model_is_refused(tmp_path: Path) -> None:
    pytest.importorskip("mediapipe", exc_type=ImportError)
    wrong = tmp_path / "wrong.task"
    wrong.write_bytes(b"no model")
    with (
        pytest.raises(ReadError, match="is not a model of the Pose Landmarker"),
        start_mediapipe(wrong),
    ):
        pass


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize(
    ("name", "squats"),
    [("squats_side_view.mp4", 3), ("squats_panning.mp4", 6)],
)
def test_squats_are_counted(data_dir: Path, tmp_path: Path, name: str, squats: int) -> None:
    mediapipe = pytest.importorskip("mediapipe")
    if not hasattr(mediapipe, "solutions"):
        pytest.skip("this MediaPipe brings no model")
    video = tmp_path / name
    shutil.copyfile(data_dir / "video" / name, video)
    motion = kineme.read(video)
    count = sum(row.kind == "primitive" for row in kineme.segment(motion).primitives)
    assert count == squats
    moves = [note for note in motion.provenance.notes if "camera moves" in note]
    assert len(moves) == (1 if "panning" in name else 0)
