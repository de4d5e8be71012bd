"""Estimating the poses in a video: decoded rightly, kept as they come, done once."""

from __future__ import annotations

import io
import wave
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import kineme
from kineme.cli.app import app
from kineme.errors import (
    KinemeWarning,
    MissingDependencyError,
    ParameterError,
    ReadError,
    SeveralPeopleError,
    WriteError,
)
from kineme.formats.keypoints.poses import read_poses
from kineme.pose import Pose, estimate_poses, register
from kineme.pose.decoding import open_video
from kineme.pose.estimators import ESTIMATORS
from squats import drawn_estimator, squat, write_video

av = pytest.importorskip("av")

AT_30_HZ = np.arange(180) / 30
USED = AT_30_HZ[::2]
"""Times of the frames whose poses are estimated by default."""


@pytest.fixture
def pictures(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[float]]:
    """Times of the pictures that an estimator of drawn squats has seen; there is no other."""
    seen: list[float] = []
    monkeypatch.setattr(ESTIMATORS, "_objects", {})
    monkeypatch.setattr(ESTIMATORS, "_loaded", True)
    register(drawn_estimator(seen.append))
    return seen


@pytest.fixture
def video(tmp_path: Path) -> Path:
    return write_video(tmp_path / "squats.mp4", AT_30_HZ)


def test_a_video_is_a_recording(video: Path, pictures: list[float]) -> None:
    motion = kineme.read(video)
    assert motion.n_frames == 90
    assert motion.fps == pytest.approx(15, abs=0.01)
    assert motion.provenance.path == str(video)
    np.testing.assert_allclose(pictures, USED, atol=1e-3)


def test_it_is_done_once(video: Path, pictures: list[float]) -> None:
    first = kineme.read(video)
    np.testing.assert_array_equal(kineme.read(video).positions, first.positions)
    assert len(pictures) == 90
    assert estimate_poses(video) == video.with_name("squats.mp4.poses.parquet")
    estimate_poses(video, video.with_name("copy.parquet"))
    assert len(pictures) == 90
    write_video(video, AT_30_HZ[:120])  # another video of this name
    assert kineme.read(video).n_frames == 60
    assert len(pictures) == 150


def test_what_was_interrupted_goes_on(video: Path, pictures: list[float]) -> None:
    def interrupt(time: float) -> None:
        pictures.append(time)
        if len(pictures) == 40:
            raise KeyboardInterrupt

    register(drawn_estimator(interrupt), replace=True)
    with pytest.raises(KeyboardInterrupt):
        estimate_poses(video)
    part = video.with_name("squats.mp4.poses.parquet.part")
    with part.open("ab") as file:
        file.write(b"torn")
    poses = read_poses(estimate_poses(video))
    assert not part.exists()
    assert len(pictures) == 40 + 90 - 38  # the last whole frame is done again
    np.testing.assert_allclose(poses.rows["time"], USED, atol=1e-3)
    assert poses.head["frames"] == 90


def test_rows_of_another_estimator_are_not_gone_on_with(video: Path, pictures: list[float]) -> None:
    part = video.with_name("squats.mp4.poses.parquet.part")
    part.write_bytes(b'{"estimator": "other"}\n' + bytes(5000))
    assert read_poses(estimate_poses(video)).head["frames"] == 90


def test_a_file_of_somebody_else_stays(video: Path, pictures: list[float]) -> None:
    mine = video.with_name("mine.parquet")
    mine.write_text("mine")
    with pytest.raises(WriteError, match="has no poses"):
        estimate_poses(video, mine)
    assert mine.read_text() == "mine"


def test_a_folder_that_cannot_be_written(
    video: Path, pictures: list[float], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr("os.access", lambda *_: False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    assert estimate_poses(video).is_relative_to(tmp_path / "cache")
    assert not list(tmp_path.glob("*.parquet*"))


@pytest.mark.parametrize("rotation", [0, 90, 180, -90])
def test_pictures_stand_upright(tmp_path: Path, rotation: int) -> None:
    path = write_video(tmp_path / "a.mp4", AT_30_HZ, rotation=rotation)
    with open_video(path) as video:
        picture = next(iter(video.frames())).picture
    expected = np.zeros((48, 64))
    expected[:24, :32] = 1
    expected = np.rot90(expected, rotation // 90)
    assert picture.shape[:2] == expected.shape
    assert np.mean((picture[..., 0] > 120) == expected) > 0.95


def test_times_are_those_of_the_container(tmp_path: Path, pictures: list[float]) -> None:
    times = [*np.arange(60) / 30, *(2 + np.arange(15) / 15)]
    estimate_poses(write_video(tmp_path / "a.mp4", times), rate=12)
    # Of the frames that come slowly, none is left out.
    np.testing.assert_allclose(pictures, [*times[:60:2], *times[60:]], atol=2e-3)


@pytest.mark.parametrize(
    ("fps", "rate", "expected"), [(60, None, 15), (24, None, 24), (50, None, 12.5), (60, 30, 30)]
)
def test_every_nth_frame_is_used(
    tmp_path: Path, pictures: list[float], fps: float, rate: float | None, expected: float
) -> None:
    video = write_video(tmp_path / "a.mp4", np.arange(4 * fps) / fps)
    estimate_poses(video, rate=rate)
    assert kineme.read(video).fps == pytest.approx(expected, rel=0.01)
    assert len(pictures) == pytest.approx(4 * expected, abs=1)


def test_another_rate_estimates_again(video: Path, pictures: list[float]) -> None:
    kineme.read(video)
    estimate_poses(video, rate=30)
    assert len(pictures) == 90 + 180
    assert kineme.read(video).fps == pytest.approx(30, abs=0.01)
    assert len(pictures) == 90 + 180
    with pytest.raises(ParameterError, match="rate must be"):
        estimate_poses(video, rate=0)


def guess_faintly(time: float) -> Pose:
    """What an estimator guesses where nobody is."""
    return replace(squat(time), confidence=np.full(33, 0.1))


def test_nobody_is_never_a_table_of_somebody(video: Path, pictures: list[float]) -> None:
    register(drawn_estimator(people=lambda time: [guess_faintly(time)]), replace=True)
    with pytest.raises(ReadError, match="no person found"):
        kineme.read(video)
    result = CliRunner().invoke(app, ["pose", str(video)])
    assert result.exit_code == 1
    assert "no person found" in result.output


def test_while_nobody_is_seen_there_is_a_gap(video: Path, pictures: list[float]) -> None:
    estimator = drawn_estimator(people=lambda t: [guess_faintly(t) if 2 <= t < 3 else squat(t)])
    register(estimator, replace=True)
    with pytest.warns(KinemeWarning, match="the recording is split there"):
        assert kineme.read(video).gaps == ((30, 45),)


def test_two_people_who_cross(video: Path, pictures: list[float]) -> None:
    """One is hidden behind the other for a moment, and the estimator's order changes."""

    def cross(time: float) -> list[Pose]:
        ahead = 150 * (time - 3)
        two = [squat(time, 420 + ahead), squat(0, 420 - ahead)]
        return two[:1] if abs(time - 3) < 0.08 else two[:: 1 if time < 3 else -1]

    register(drawn_estimator(people=cross), replace=True)
    with pytest.raises(SeveralPeopleError, match="choose one with person="):
        kineme.read(video)
    moved = [
        np.ptp(kineme.read(video, person=who).positions[:, :, 1], axis=0).max() for who in "01"
    ]
    assert np.round(moved, 1).tolist() == [0.4, 0.0]


def test_hdr_is_decoded(tmp_path: Path, pictures: list[float]) -> None:
    path = write_video(tmp_path / "hdr.mkv", AT_30_HZ[:40], codec="libx264", pix_fmt="yuv420p10le")
    with open_video(path) as video:
        picture = next(video.frames()).picture
    assert picture.dtype == np.uint8
    assert picture[:20, :28, 0].min() > 200
    assert picture[30:, 40:].max() < 50
    assert kineme.read(path).n_frames == 20


def test_large_pictures_are_reduced(tmp_path: Path) -> None:
    path = write_video(tmp_path / "4k.mp4", AT_30_HZ[:2], size=(3840, 2160))
    with open_video(path) as video:
        frame = next(video.frames())
    assert (frame.picture.shape, frame.scale) == ((720, 1280, 3), 3)


def test_bad_videos_are_refused(video: Path, pictures: list[float], tmp_path: Path) -> None:
    sound = io.BytesIO()
    with wave.open(sound, "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(8000)
        file.writeframes(bytes(16000))
    whole = write_video(tmp_path / "whole.mp4", np.arange(300) / 30).read_bytes()
    matroska = write_video(tmp_path / "whole.mkv", np.arange(300) / 30).read_bytes()
    for name, data, reason in [
        ("text.mp4", b"not a video", "is not a video"),
        ("empty.mp4", b"", "empty"),
        ("sound.mkv", sound.getvalue(), "sound"),
        ("none.mp4", write_video(tmp_path / "none.mp4", []).read_bytes(), "no pictures"),
        ("head.mp4", video.read_bytes()[:500], "is not a video"),
        ("tenth.mp4", whole[: len(whole) // 10], "part of"),
        ("half.mkv", matroska[: len(matroska) // 2], "ends after"),
        ("half.mp4", whole[: len(whole) // 2], "ends after|damaged"),
    ]:
        path = tmp_path / name
        path.write_bytes(data)
        with pytest.raises(ReadError, match=reason):
            kineme.read(path)
    with pytest.raises(ReadError, match="still picture"):
        kineme.read(write_video(tmp_path / "still.mp4", [0.0]))
    with pytest.raises(ReadError, match="still picture"):
        estimate_poses(
            write_video(tmp_path / "photo.jpg", [0.0], codec="mjpeg", pix_fmt="yuvj420p")
        )
    (tmp_path / "photo.jpg").unlink()
    left = {path.suffix for path in tmp_path.iterdir()}
    assert left <= {".mp4", ".mkv"}


def test_without_an_estimator_the_install_line_is_said(
    video: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("kineme.pose.estimators.find_spec", lambda name: None)
    with pytest.raises(MissingDependencyError, match=r"pip install 'kineme\[video\]'"):
        kineme.read(video)
    result = CliRunner().invoke(app, ["pose", str(video)])
    assert result.exit_code == 1
    assert "pip install 'kineme[video]'" in result.stderr


def test_the_command(video: Path, pictures: list[float], tmp_path: Path) -> None:
    table = tmp_path / "poses.parquet"
    result = CliRunner().invoke(app, ["pose", str(video), "-o", str(table)])
    assert result.exit_code == 0, result.output
    assert "1 person in 90 of 90 frames" in result.output
    assert kineme.read(table).n_frames == 90
    result = CliRunner().invoke(app, ["segment", str(tmp_path / "squats.mp4"), "--json"])
    assert result.exit_code == 0, result.output
