"""Videos in the studio: served with what is drawn over them, and given poses first."""

from __future__ import annotations

import time
import zlib
from collections.abc import Callable, Iterator
from hashlib import sha256
from pathlib import Path

import numpy as np
import pytest
from studio_clients import Studio

from kineme.pose import Pose, register
from kineme.pose.estimators import ESTIMATORS
from kineme.studio.storage.sidecars import make_file_id
from squats import drawn_estimator, squat, write_squats, write_video

AT_30_HZ = np.arange(90) / 30


@pytest.fixture
def watch(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[Callable[[float], None]]]:
    """Whom the only estimator, of drawn squats, tells the time of each picture."""
    told: list[Callable[[float], None]] = []
    monkeypatch.setattr(ESTIMATORS, "_objects", {})
    monkeypatch.setattr(ESTIMATORS, "_loaded", True)
    register(drawn_estimator(lambda time: [each(time) for each in told]))
    return told


@pytest.fixture
def video(folder: Path) -> Path:
    pytest.importorskip("av")
    return write_video(folder / "squats.mp4", AT_30_HZ)


def wait(studio: Studio, holds: Callable[[dict], bool]) -> dict:
    """How far the poses are, once it is so."""
    for _ in range(1000):
        progress = studio.get("/api/poses").json()
        if holds(progress):
            return progress
        time.sleep(0.01)
    raise TimeoutError(progress)


def is_idle(progress: dict) -> bool:
    return progress["recording"] == ""


def write_poses_of(video: Path, people: Callable[[float], list[Pose]]) -> Path:
    digest = sha256(video.read_bytes()).hexdigest()
    table = video.with_name(f"{video.name}.poses.parquet")
    told = {"sha256": digest, "width": 640, "height": 480, "begins": 0.0}
    return write_squats(table, AT_30_HZ + 0.5, people, **told)


def test_keypoints_lie_over_the_picture(make_studio, folder: Path) -> None:
    video = folder / "squats.mp4"
    video.write_bytes(b"\0\0\0\x18ftypmp42 and more")
    write_poses_of(video, lambda time: [squat(time)] if time < 3 else [])
    studio = make_studio().choose("squats.mp4")
    assert [*studio.ids()] == ["squats.mp4", "take.bvh"]  # the table is read with its video
    told = studio.recording()["video"]
    assert (told["name"], told["offset_s"]) == ("squats.mp4", 0.5)
    head = told["picture"]["keypoints"]
    packed = zlib.decompress(studio.get(f"{studio.one}/keypoints").content)
    columns = np.frombuffer(packed, "<i2").reshape(-1, head["n_samples"])
    knee = 3 * head["joints"].index("left_knee")
    places = np.cumsum(columns[knee : knee + 3], axis=1, dtype=np.int16)
    drawn = np.array(head["origin"])[:, None] + head["step"] * places
    expected = squat(0.5 + 60 / 30).image[head["joints"].index("left_knee")]
    assert drawn[:, 60] == pytest.approx([*expected, 90], abs=0.1)
    assert places[0, -1] == -32768  # nobody is there


def test_a_video_beside_keeps_its_offset_and_is_served_to_those_who_know_the_token(studio) -> None:
    address = f"{studio.one}/video"
    assert studio.recording()["video"] is None
    assert studio.get(address).status_code == 404
    (studio.folder / "take.mp4").write_bytes(b"0123456789")
    part = studio.get(address, headers={"range": "bytes=2-4"})
    assert (part.status_code, part.content) == (206, b"234")
    assert part.headers["content-type"] == "video/mp4"
    stranger = {"x-kineme-token": "another"}
    assert studio.get(address, headers=stranger).status_code == 403
    assert studio.get(f"{address}?token=another", headers=stranger).status_code == 403
    studio.post(address, {"offset_s": 1.5})
    assert studio.recording()["video"] == {"name": "take.mp4", "offset_s": 1.5}


def test_poses_are_estimated_when_they_are_asked_for(make_studio, video: Path, watch) -> None:
    studio = make_studio().choose(video.name)
    refused = studio.get(studio.one)
    assert refused.status_code == 400
    assert refused.json()["poses"]
    assert not refused.json()["reading"]
    assert studio.state()["install"] == ""
    studio.post("/api/poses", {"recordings": [studio.id]})
    done = wait(studio, is_idle)
    assert (done["done"], done["all"], done["failed"]) == (1, 1, [])
    assert studio.recording()["n_frames"] == 45
    assert not any(each["needs_poses"] for each in studio.state()["recordings"])


def test_what_is_cancelled_goes_on_later(make_studio, video: Path, watch) -> None:
    studio = make_studio().choose(video.name)
    sent = {"recordings": [studio.id]}
    seen: list[float] = []
    watch.append(lambda time_s: (seen.append(time_s), time.sleep(0.02)))
    studio.post("/api/poses", sent)
    wait(studio, lambda progress: len(seen) > 20)
    assert studio.client.post("/api/poses/cancel").status_code == 204
    wait(studio, is_idle)
    first, watch[0] = len(seen), seen.append
    assert first < 90
    studio.post("/api/poses", sent)
    wait(studio, is_idle)
    assert len(seen) - first < 90 - first + 3  # the last whole frame is done again


def test_a_video_that_fails_costs_itself_only(make_studio, video: Path, watch) -> None:
    bad = video.with_name("a.mp4")
    bad.write_bytes(video.read_bytes()[:300])
    studio = make_studio().choose(video.name)
    studio.post("/api/poses", {"recordings": [make_file_id(bad), studio.id]})
    done = wait(studio, is_idle)
    assert done["done"] == 2
    assert len(done["failed"]) == 1
    assert "a.mp4" in done["failed"][0]
    assert studio.get(studio.one).status_code == 200


def test_without_an_estimator_the_install_line_is_said(
    make_studio, video: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("kineme.pose.estimators.find_spec", lambda name: None)
    studio = make_studio().choose(video.name)
    assert "pip install 'kineme[video]'" in studio.state()["install"]
    refused = studio.post("/api/poses", {"recordings": [studio.id]})
    assert refused.status_code == 400
    assert "pip install" in refused.json()["error"]
