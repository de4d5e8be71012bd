"""``kineme pose``: estimate the poses of people in videos."""

from __future__ import annotations

from json import dumps
from pathlib import Path
from typing import Annotated, Any

import typer

from kineme._util.checks import format_count
from kineme.cli.files import Batch, Files, Recursive, check_suffix, make_parent_folder
from kineme.cli.help import METHOD, option, output_option
from kineme.cli.options import Json, Quiet
from kineme.cli.terminal import exit_on_error, print_error
from kineme.errors import ParameterError, ReadError


def pose(
    files: Files,
    output: Annotated[
        Path | None,
        output_option(
            "Write the poses to this .parquet file instead of next to the video; for "
            "several videos, a folder or a path with {name} in it."
        ),
    ] = None,
    estimator: Annotated[
        str | None,
        option(
            METHOD,
            "Pose estimator: mediapipe (one person, in metres), rtmlib (several people, in the "
            "picture) or one that was added; by default the first that is installed.",
            metavar="NAME",
        ),
    ] = None,
    pose_model: Annotated[
        Path | None, option(METHOD, "Model file of the estimator, instead of its own.")
    ] = None,
    pose_rate: Annotated[
        float | None,
        option(
            METHOD,
            "Least number of poses per second; kineme uses every n-th frame, so 12.5 (the "
            "default) gives 15 from 30 frames per second.",
            metavar="HZ",
            min=0.1,
        ),
    ] = None,
    recursive: Recursive = False,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Estimate the poses of people in videos.

    The poses of VIDEO are saved in VIDEO.poses.parquet beside it, where other commands find them:
    kineme segment VIDEO. An interrupted run is resumed. Everything happens on this machine.

    For example: kineme pose squats.mp4 --output poses.parquet
    """
    from kineme.formats.registry import is_video
    from kineme.pose.estimators import choose_estimator

    with exit_on_error():
        try:
            choose_estimator(estimator)
        except ParameterError as error:
            raise typer.BadParameter(str(error), param_hint="--estimator") from error
    batch = Batch(files, recursive=recursive, quiet=quiet)
    batch.paths = [path for path in batch.paths if is_video(path) or path in files]
    if not batch.paths:
        print_error(f"there is no video in {', '.join(map(str, files))}")
    tables = batch.targets("--output", output, ".parquet")
    for table in tables:
        check_suffix("--output", table, (".parquet",))
    for path, table in zip(batch.paths, tables, strict=True):
        with batch.catch_errors(path):
            if table is not None:
                make_parent_folder(table)
            with batch.progress(path):
                facts = _estimate(path, table, estimator, pose_model, pose_rate)
            if json:
                typer.echo(dumps(facts))
            elif not quiet:
                typer.echo(_describe_poses(facts))
    batch.exit()


def _estimate(
    path: Path, table: Path | None, estimator: str | None, model: Path | None, rate: float | None
) -> dict[str, Any]:
    """Estimate the poses of a video, write them, and return the facts to print."""
    from kineme.formats.keypoints.poses import read_poses
    from kineme.pose import estimate_poses

    written = estimate_poses(path, table, estimator=estimator, model=model, rate=rate)
    poses = read_poses(written)
    if not len(poses.rows):
        raise ReadError(path, "no person found in any frame")
    facts = {name: poses.head[name] for name in ("estimator", "frames", "fps", "duration")}
    people = len(set(poses.rows["person"].tolist()))
    return {"path": str(path), **facts, "seen": poses.seen, "people": people, "poses": str(written)}


def _describe_poses(facts: dict[str, Any]) -> str:
    return (
        f"{facts['path']}: {format_count(facts['people'], 'person')} in {facts['seen']} of "
        f"{format_count(facts['frames'], 'frame')} ({facts['duration']:.1f} s), by "
        f"{facts['estimator']}; poses written as {facts['poses']}"
    )
