"""Estimate the poses of a video, write them as they come, and continue after an interruption.

During the run, poses are appended to a file beside the table, with the suffix ``.part``: one line
of JSON, then rows of `kineme.formats.keypoints.poses.make_row_type`. If the run is interrupted, the
next one continues after the last complete frame. At the end the table is written and the other file
is removed.

By default the table of ``squats.mp4`` is ``squats.mp4.poses.parquet`` beside it, or in the user's
cache if that folder cannot be written. It holds the digest of the video: if the video changes, its
poses are estimated again. `kineme.read` does all this when it reads a video for the first time.
"""

from __future__ import annotations

import json
import os
import shutil
import time
from collections.abc import Callable, Sequence
from functools import lru_cache
from pathlib import Path
from typing import BinaryIO

import numpy as np

from kineme._util.arrays import Floats
from kineme._util.checks import check_path, is_number
from kineme._util.files import (
    POSES,
    VIDEOS,
    AnyPath,
    atomic_write,
    is_locked,
    lock_shared,
    refuse_link,
)
from kineme._util.parallel import announce, check_cancelled
from kineme.errors import KinemeError, ParameterError, ReadError, WriteError
from kineme.formats.channels.parquet import open_parquet
from kineme.formats.files import FileContent, load, load_head
from kineme.formats.keypoints.poses import (
    NOBODY,
    Head,
    Rows,
    find_poses,
    make_row_type,
    parse_head,
    poses_to_motion,
    read_poses,
    write_poses,
)
from kineme.formats.options import ReadOptions
from kineme.formats.registry import Format
from kineme.pose.camera import CameraWatch
from kineme.pose.decoding import Frame, OpenVideo, open_video
from kineme.pose.estimators import Estimate, Picture, Pose, PoseEstimator, choose_estimator
from kineme.recordings import Motion

ProgressCallback = Callable[[float | None, float], None]
"""Receives the share of the video that is done (None if unknown) and the frames per second."""

DEFAULT_RATE = 12.5
"""Poses per second at least: 15 of 30 or 60 frames per second, 12.5 of 25 or 50."""
MIN_MEAN_CONFIDENCE = 0.3
"""Mean confidence of the keypoints below which a pose is dropped: nobody is there."""
PROGRESS_INTERVAL_S = 0.5
"""Seconds between two reports of progress."""

_BOXES = (b"ftyp", b"moov", b"mdat", b"wide", b"free")
_EBML = b"\x1a\x45\xdf\xa3"  # Matroska and WebM


def estimate_poses(
    video: AnyPath,
    target: AnyPath | None = None,
    *,
    estimator: str | None = None,
    model: AnyPath | None = None,
    rate: float | None = None,
) -> Path:
    """Estimate the poses of the people in a video and return the path of their table.

    An existing table of the same video is reused.

    Parameters
    ----------
    video : str or PathLike
        Any video that FFmpeg decodes.
    target : str or PathLike, optional
        The Parquet file to write; by default one beside the video.
    estimator : str, optional
        One of `estimator_names`; by default the first that is installed, or the one that estimated
        the poses beside the video.
    model : str or PathLike, optional
        A model file that replaces the estimator's own model.
    rate : float, optional
        Poses per second: every n-th frame is used, with the largest n that leaves at least so many.
        By default 12.5, or the rate of the poses beside the video.

    Returns
    -------
    Path
        The table of poses, which `kineme.read` reads.

    Raises
    ------
    ReadError
        The file is no video, is damaged, or is a still picture.
    WriteError
        The table cannot be written.
    MissingDependencyError
        No estimator is installed.
    ParameterError
        The estimator is unknown, or the rate is not positive.

    Examples
    --------
    >>> from pathlib import Path
    >>> estimate_poses(Path("squats.mp4"))  # doctest: +SKIP
    PosixPath('squats.mp4.poses.parquet')
    """
    check_path(video, "estimate_poses")
    if rate is not None and not (is_number(rate) and rate > 0):
        raise ParameterError(f"rate must be a positive number of poses per second, not {rate!r}")
    return keep_poses(load_head(Path(video)), target, estimator=estimator, model=model, rate=rate)


def has_poses(video: Path) -> bool:
    """Return whether the poses of a video have been estimated, so that reading it is fast."""
    beside = video.with_name(video.name + POSES)
    try:
        changed = video.stat()
        if beside.exists():
            if beside.stat().st_mtime >= changed.st_mtime:
                return True
        elif os.access(video.parent, os.W_OK):
            return False
        digest = _digest(video, changed.st_mtime_ns, changed.st_size)
        return _holds_poses_of(find_poses(video, digest), {"sha256": digest})
    except (KinemeError, OSError):  # reading the video will raise it again
        return False


@lru_cache(1000)
def _digest(video: Path, *_: int) -> str:
    """Return the digest of a video; the other arguments (time, size) are the key of the cache."""
    return load_head(video).digest


def keep_poses(
    content: FileContent,
    target: AnyPath | None = None,
    *,
    estimator: str | None = None,
    model: AnyPath | None = None,
    rate: float | None = None,
    report: ProgressCallback | None = None,
) -> Path:
    """Estimate poses as `estimate_poses` does, for a video whose first bytes are loaded.

    ``report`` receives the progress; by default it is announced to the command or page.
    """
    path, digest = content.path, content.digest
    beside = find_poses(path, digest)
    table = beside if target is None else Path(target)
    if target is None:
        table.parent.mkdir(parents=True, exist_ok=True)  # of the cache
    wanted: dict[str, object] = {"sha256": digest}
    if estimator is not None or model is not None:
        wanted |= _describe_estimator(choose_estimator(estimator), model)
    if rate is not None:
        wanted["rate"] = rate
    for existing in (table, beside):
        if _holds_poses_of(existing, wanted):
            if existing != table:
                with atomic_write(table) as draft:
                    shutil.copyfile(existing, draft)
            return table
    chosen = choose_estimator(estimator)
    settings = {
        **_describe_estimator(chosen, model),
        "sha256": digest,
        "limit": chosen.limit,
        "rate": rate or DEFAULT_RATE,
    }
    part = table.with_name(f"{table.name}.part")
    _run(path, part, chosen, None if model is None else Path(model), settings, report or _announce)
    head, rows, _ = _parse_part(part, len(chosen.keypoints))
    if len(np.unique(rows["time"])) < 2:
        part.unlink()
        raise ReadError(path, "is a still picture: give a video")
    write_poses(table, head, rows)
    part.unlink()
    return table


def _describe_estimator(estimator: PoseEstimator, model: AnyPath | None) -> dict[str, object]:
    """Return the entries of a table's head that say which estimator made it."""
    return {
        "estimator": estimator.name,
        "keypoints": list(estimator.keypoints),
        "model": None if model is None else load(model).digest,
    }


def _holds_poses_of(table: Path, wanted: Head) -> bool:
    """Return whether a table has these entries; raise WriteError if it is another kind of file."""
    if not table.exists():
        return False
    try:
        content = load(table)
        head = parse_head(content, open_parquet(content))
    except ReadError as error:
        reason = "exists already and has no poses: move it away or name another file"
        raise WriteError(table, reason) from error
    return all(head.get(name) == value for name, value in wanted.items())


def _announce(share: float | None, pace: float) -> None:
    done = "" if share is None else f"{share:.0%}, "
    announce(f"estimating poses, {done}{pace:.1f} frames/s")


def _run(
    path: Path,
    part: Path,
    estimator: PoseEstimator,
    model: Path | None,
    settings: Head,
    report: ProgressCallback,
) -> None:
    """Append the poses of all frames that the file of an earlier run lacks."""
    refuse_link(part)
    if part.exists() and is_locked(part):
        raise WriteError(part, "is being written by another kineme: wait until it ends")
    with open_video(path) as video:
        last = _resume(part, settings, len(estimator.keypoints))
        try:
            with part.open("ab") as file, estimator.start(model) as estimate:
                lock_shared(file.fileno())
                _append_poses(file, video, estimate, settings, last, report)
        except ReadError:  # of the video or the model: there is nothing to continue
            part.unlink(missing_ok=True)
            raise
        except OSError as error:
            raise WriteError(part, f"cannot be written: {error.strerror or error}") from error


def _append_poses(
    file: BinaryIO,
    video: OpenVideo,
    estimate: Estimate,
    settings: Head,
    last: float | None,
    report: ProgressCallback,
) -> None:
    """Write the rows of the frames after ``last``, and the head if the file is empty."""
    begun = reported = time.monotonic()
    camera = CameraWatch()
    former: Floats | None = None
    for n, frame in enumerate(video.frames(video.find_step(settings["rate"]), last)):
        check_cancelled()
        found = estimate(frame.picture, frame.time)
        poses = [pose for pose in found if np.mean(pose.confidence) >= MIN_MEAN_CONFIDENCE]
        if file.tell() == 0:
            height, width = (round(side * frame.scale) for side in frame.picture.shape[:2])
            head = {**settings, "width": width, "height": height, "begins": video.start_time}
            file.write(json.dumps(head).encode() + b"\n")
        colors = _count_colors(frame.picture)
        rows = _make_rows(frame, poses, len(settings["keypoints"]))
        # Half of the summed differences is the share of pixels that changed their colour.
        rows["change"] = 0.0 if former is None else 0.5 * np.abs(colors - former).sum()
        rows["moved"] = camera.measure(frame.picture, frame.time)
        former = colors
        # One call writes all rows of a frame, so an interruption loses a frame as a whole.
        file.write(rows.tobytes())
        file.flush()
        now = time.monotonic()
        if now - reported >= PROGRESS_INTERVAL_S:
            reported = now
            share = min(frame.time / video.duration, 1.0) if video.duration else None
            report(share, (n + 1) / (now - begun))


def _count_colors(picture: Picture) -> Floats:
    """Return the shares of 64 colours among every eighth pixel."""
    pixels = picture[::8, ::8].reshape(-1, 3) >> 6  # the two highest bits of red, green and blue
    counts = np.bincount((pixels * (16, 4, 1)).sum(axis=1), minlength=64)
    return np.asarray(counts / len(pixels))


def _make_rows(frame: Frame, poses: Sequence[Pose], keypoints: int) -> Rows:
    """Return a row for each person in a frame, or one row without a person."""
    rows = np.zeros(max(1, len(poses)), make_row_type(keypoints))
    rows["time"], rows["person"], rows["metres"] = frame.time, NOBODY, np.nan
    for i, pose in enumerate(poses):
        rows[i]["person"] = i
        rows[i]["image"] = pose.image * frame.scale
        rows[i]["confidence"] = pose.confidence
        if pose.metres is not None:
            rows[i]["metres"] = pose.metres
    return rows


def _resume(part: Path, settings: Head, keypoints: int) -> float | None:
    """Return the time of the last complete frame of an earlier run; None if there is none."""
    if not part.exists():
        return None
    head, rows, size = _parse_part(part, keypoints)
    # The last frame is done again: some of its people may be missing.
    kept = rows[rows["time"] < rows["time"][-1]] if len(rows) else rows
    if not len(kept) or any(head.get(name) != value for name, value in settings.items()):
        part.unlink()
        return None
    os.truncate(part, size + kept.nbytes)
    return float(kept["time"][-1])


def _parse_part(part: Path, keypoints: int) -> tuple[Head, Rows, int]:
    """Return the head, the complete rows and the size of the head of an unfinished file."""
    line, _, rest = part.read_bytes().partition(b"\n")
    try:
        head = json.loads(line)
    except ValueError:
        head = {}
    dtype = make_row_type(keypoints)
    return head, np.frombuffer(rest, dtype, len(rest) // dtype.itemsize), len(line) + 1


def read_video(content: FileContent, options: ReadOptions) -> Motion:
    """Return the motion of one person in a video; estimate its poses unless they are there."""
    poses = read_poses(keep_poses(content))
    return poses_to_motion(content, poses, options)


def begins_video(head: bytes) -> bool:
    """Return whether a file starts like MP4, QuickTime, Matroska, WebM or AVI."""
    is_avi = head.startswith(b"RIFF") and head[8:12] == b"AVI "
    return head[4:8] in _BOXES or head.startswith(_EBML) or is_avi


FORMAT = Format("video", VIDEOS, begins_video, read_video, is_video=True)
