"""Run an estimator over a video: poses are kept as they come, so that nothing is done twice.

While it runs, poses go to a file of its own beside the table to be, called as that and ``.part``: a
line of JSON, then rows of the type `kineme.formats.keypoints.poses.make_row_type`, a frame at once.
Whatever ends the run, the next one goes on after the last whole frame. When all frames are done,
the table is written at once and the other file is removed.

Without another place, the table of ``squats.mp4`` is ``squats.mp4.poses.parquet`` beside it, or
in the user's cache where that folder cannot be written. It holds the digest of the video: where
that is another one, poses are estimated anew.
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
from kineme._util.checks import check_path
from kineme._util.files import POSES, AnyPath, atomic_write, is_locked, lock_shared, refuse_link
from kineme._util.parallel import announce, check_cancelled
from kineme.errors import KinemeError, ReadError, WriteError
from kineme.formats.channels.parquet import open_parquet
from kineme.formats.files import FileContent, load, load_head
from kineme.formats.keypoints.poses import (
    NOBODY,
    Head,
    Rows,
    find_poses,
    make_row_type,
    parse_head,
    write_poses,
)
from kineme.pose.decoding import Frame, OpenVideo, open_video
from kineme.pose.estimators import Estimate, Picture, Pose, PoseEstimator, choose_estimator

Watch = Callable[[float | None, float], None]
"""Told the share of a video that is done, None where nobody knows, and frames a second."""

PRESENT = 0.3
"""Mean confidence of the keypoints below which nobody is there."""
TOLD_S = 0.5
"""Seconds between two words on progress."""


def estimate_poses(
    video: AnyPath,
    target: AnyPath | None = None,
    *,
    estimator: str | None = None,
    model: AnyPath | None = None,
) -> Path:
    """Estimate the poses of the people in a video, unless that is done, and return their table.

    Parameters
    ----------
    video : str or PathLike
        Whatever FFmpeg decodes.
    target : str or PathLike, optional
        The Parquet file to write; by default one beside the video.
    estimator : str, optional
        One of `estimator_names`; by default the first that is installed, or whichever estimated the
        poses beside the video.
    model : str or PathLike, optional
        A file that the estimator takes in place of its own model.

    Returns
    -------
    Path
        `kineme.read` reads it.

    Raises
    ------
    ReadError
        The file is no video, is damaged, or is a single picture.
    WriteError
        The table cannot be written.
    MissingDependencyError
        No estimator is installed.

    Examples
    --------
    >>> from pathlib import Path
    >>> estimate_poses(Path("squats.mp4"))  # doctest: +SKIP
    PosixPath('squats.mp4.poses.parquet')
    """
    check_path(video, "estimate_poses")
    return keep_poses(load_head(Path(video)), target, estimator=estimator, model=model)


def has_poses(video: Path) -> bool:
    """Return whether the poses of a video are there, so that reading it takes no minutes."""
    beside = video.with_name(video.name + POSES)
    try:
        changed = video.stat()
        if beside.exists():
            if beside.stat().st_mtime >= changed.st_mtime:
                return True
        elif os.access(video.parent, os.W_OK):
            return False
        digest = _digest(video, changed.st_mtime_ns, changed.st_size)
        return _is_made(find_poses(video, digest), {"sha256": digest})
    except (KinemeError, OSError):  # reading the video will say what is wrong
        return False


@lru_cache(1000)
def _digest(video: Path, *_: int) -> str:
    """Return the digest of a video as it was at that time, of that size."""
    return load_head(video).digest


def keep_poses(
    content: FileContent,
    target: AnyPath | None = None,
    *,
    estimator: str | None = None,
    model: AnyPath | None = None,
    watch: Watch | None = None,
) -> Path:
    """Return the table of `estimate_poses` for a video of which the first bytes are loaded.

    ``watch`` is told how far it is, by default whoever listens to what is announced.
    """
    path, digest = content.path, content.digest
    beside = find_poses(path, digest)
    place = beside if target is None else Path(target)
    if target is None:
        place.parent.mkdir(parents=True, exist_ok=True)  # of the cache
    asked: dict[str, object] = {"sha256": digest}
    if estimator is not None or model is not None:
        asked |= _told_of(choose_estimator(estimator), model)
    for made in (place, beside):
        if _is_made(made, asked):
            if made != place:
                with atomic_write(place) as draft:
                    shutil.copyfile(made, draft)
            return place
    chosen = choose_estimator(estimator)
    part = place.with_name(f"{place.name}.part")
    given = None if model is None else Path(model)
    _run(path, part, chosen, given, digest, watch or _announce)
    head, rows, _ = _parse_part(part, len(chosen.keypoints))
    if len(np.unique(rows["time"])) < 2:
        part.unlink()
        raise ReadError(path, "is a still picture: a video has several frames")
    write_poses(place, head, rows)
    part.unlink()
    return place


def _told_of(estimator: PoseEstimator, model: AnyPath | None) -> dict[str, object]:
    """Return what a table tells of how it was made."""
    return {
        "estimator": estimator.name,
        "keypoints": list(estimator.keypoints),
        "model": None if model is None else load(model).digest,
    }


def _is_made(place: Path, asked: Head) -> bool:
    """Return whether a place holds the poses asked for; WriteError for a file of somebody else."""
    if not place.exists():
        return False
    try:
        content = load(place)
        head = parse_head(content, open_parquet(content))
    except ReadError as error:
        reason = "is there, and holds no poses: move it away or name another file"
        raise WriteError(place, reason) from error
    return all(head.get(name) == value for name, value in asked.items())


def _announce(share: float | None, pace: float) -> None:
    done = "" if share is None else f"{share:.0%}, "
    announce(f"estimating poses, {done}{pace:.1f} frames/s")


def _run(
    path: Path,
    part: Path,
    estimator: PoseEstimator,
    model: Path | None,
    digest: str,
    watch: Watch,
) -> None:
    """Append the poses of all frames that the file of an earlier run lacks."""
    refuse_link(part)
    if part.exists() and is_locked(part):
        raise WriteError(part, "is being written: wait for the other kineme to end")
    told = {**_told_of(estimator, model), "sha256": digest, "limit": estimator.limit}
    with open_video(path) as video:
        last = _resume(part, told, len(estimator.keypoints))
        try:
            with part.open("ab") as file, estimator.start(model) as estimate:
                lock_shared(file.fileno())
                _append(file, video, estimate, told, last, watch)
        except ReadError:  # of the video or the model: nothing to go on with
            part.unlink(missing_ok=True)
            raise
        except OSError as error:
            raise WriteError(part, f"cannot be written: {error.strerror or error}") from error


def _append(
    file: BinaryIO,
    video: OpenVideo,
    estimate: Estimate,
    told: Head,
    last: float | None,
    watch: Watch,
) -> None:
    begun = spoken = time.monotonic()
    former: Floats | None = None
    for n, frame in enumerate(video.frames(last)):
        check_cancelled()
        poses = _present(estimate(frame.picture, frame.time))
        if file.tell() == 0:
            height, width = (round(side * frame.scale) for side in frame.picture.shape[:2])
            head = {**told, "width": width, "height": height, "begins": video.begins}
            file.write(json.dumps(head).encode() + b"\n")
        # The rows of a frame go to the file in one call: it holds all of them or none.
        colors = _count_colors(frame.picture)
        change = 0.0 if former is None else 0.5 * float(np.abs(colors - former).sum())
        former = colors
        file.write(_rows_of(frame, poses, len(told["keypoints"]), change).tobytes())
        file.flush()
        now = time.monotonic()
        if now - spoken >= TOLD_S:
            spoken = now
            share = min(frame.time / video.duration, 1.0) if video.duration else None
            watch(share, (n + 1) / (now - begun))


def _present(poses: Sequence[Pose]) -> list[Pose]:
    return [pose for pose in poses if np.mean(pose.confidence) >= PRESENT]


def _count_colors(picture: Picture) -> Floats:
    """Return the shares of a picture, looked at coarsely, that have each of 64 colours."""
    few = picture[::8, ::8].reshape(-1, 3) >> 6  # the two highest bits of red, green and blue
    counts = np.bincount((few * (16, 4, 1)).sum(axis=1), minlength=64)
    return np.asarray(counts / len(few))


def _rows_of(frame: Frame, poses: Sequence[Pose], keypoints: int, change: float) -> Rows:
    """Return a row for each person in a frame; one of nobody where there is none."""
    rows = np.zeros(max(1, len(poses)), make_row_type(keypoints))
    rows["time"], rows["person"], rows["metres"] = frame.time, NOBODY, np.nan
    rows["change"] = change
    for i, pose in enumerate(poses):
        rows[i]["person"] = i
        rows[i]["image"] = pose.image * frame.scale
        rows[i]["confidence"] = pose.confidence
        if pose.metres is not None:
            rows[i]["metres"] = pose.metres
    return rows


def _resume(part: Path, told: Head, keypoints: int) -> float | None:
    """Return the time after which an earlier run is gone on with; None for a new one."""
    if not part.exists():
        return None
    head, rows, size = _parse_part(part, keypoints)
    # The last frame is done again: not all of its people may have been written.
    kept = rows[rows["time"] < rows["time"][-1]] if len(rows) else rows
    if not len(kept) or any(head.get(name) != value for name, value in told.items()):
        part.unlink()
        return None
    os.truncate(part, size + kept.nbytes)
    return float(kept["time"][-1])


def _parse_part(part: Path, keypoints: int) -> tuple[Head, Rows, int]:
    """Return head and whole rows of a file of poses that is not done, and the size of the head."""
    line, _, rest = part.read_bytes().partition(b"\n")
    try:
        head = json.loads(line)
    except ValueError:
        head = {}
    kind = make_row_type(keypoints)
    return head, np.frombuffer(rest, kind, len(rest) // kind.itemsize), len(line) + 1
