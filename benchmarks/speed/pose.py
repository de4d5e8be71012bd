"""Measure the time of pose estimation, and the counts of fast movement at each rate of poses.

    python -m benchmarks pose [--rates 12.5 30] [--speeds 1 2 3] [--record]

Times are seconds per minute of video of 640 by 360 pixels: decoding, conversion to RGB, detection
of camera moves, MediaPipe, its start, and `kineme pose` as a whole; processor time and wall time.
Then the squats in two videos are counted at each rate, at one, two and three times their speed.

Target: 30 s per minute on two cores, judged by processor time.
Needs MediaPipe up to 0.10.21, which includes its model.
"""

from __future__ import annotations

import shutil
import tempfile
import warnings
from collections.abc import Callable, Iterator
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import kineme
from _figures import add_option, record
from _measure import Duration, judge, time_call
from _options import choose_size, find_data, make_parser, need_packages, skip
from kineme.pose.camera import CameraWatch
from kineme.pose.decoding import Frame, OpenVideo, open_video
from kineme.pose.estimating import DEFAULT_RATE, estimate_poses
from kineme.pose.mediapipe_estimator import start_mediapipe

VIDEOS = {"squats_side_view.mp4": 3, "squats_panning.mp4": 6}
"""Number of squats in each video."""
SIZE = (640, 360)
MAX_S = 30.0
"""Seconds of processor time per minute of video."""


def write_small(source: Path, target: Path) -> None:
    """Write a copy of a video with `SIZE`."""
    import av

    with av.open(str(source)) as old, av.open(str(target), "w") as new:
        stream = new.add_stream("libx264", rate=30)
        stream.width, stream.height = SIZE
        stream.codec_context.time_base = Fraction(1, 90_000)
        for frame in old.decode(video=0):
            small = frame.reformat(*SIZE)
            small.pts, small.time_base = round(frame.time * 90_000), Fraction(1, 90_000)
            new.mux(stream.encode(small))
        new.mux(stream.encode())


def show_parts(video: Path) -> None:
    """Print and record the time of each part of the work, per minute of video."""
    with open_video(video) as opened:
        minutes, step = opened.duration / 60, opened.find_step(DEFAULT_RATE)
        parts = {"decoding": time_call(lambda: list(opened.frames(3600.0)))}
    frames: list[Frame] = []
    with open_video(video) as opened:
        both = time_call(lambda: frames.extend(opened.frames(step)))
    parts["conversion to RGB"] = Duration(
        *(a - b for a, b in zip(both, parts["decoding"], strict=True))
    )
    camera = CameraWatch()
    parts["moves of the camera"] = time_call(
        lambda: [camera.measure(frame.picture, frame.time) for frame in frames]
    )
    context = start_mediapipe(None)
    start = time_call(context.__enter__)
    context.__exit__(None, None, None)
    with start_mediapipe(None) as estimate:
        parts["MediaPipe"] = time_call(
            lambda: [estimate(frame.picture, frame.time) for frame in frames]
        )
    parts["as a whole"] = time_call(lambda: estimate_poses(video))
    print(f"seconds a minute of {SIZE[0]} x {SIZE[1]} video, {len(frames) / minutes:.0f} poses:")
    for name, duration in parts.items():
        processor, wall = duration.processor / minutes, duration.clock / minutes
        print(f"  {name:22}{processor:6.1f} s of processor time, {wall:6.1f} s of wall time")
        record(f"pose.{name.replace(' ', '_')}.processor", round(processor, 1), unit="s")
    print(f"  start, once           {start.processor:6.1f} s, {start.clock:6.1f} s of wall time")
    whole = parts["as a whole"].processor / minutes
    print(f"  {judge(whole, MAX_S)}, by processor time")


def speed_up(
    speed: float, frames: Callable[..., Iterator[Frame]]
) -> Callable[..., Iterator[Frame]]:
    """Return `OpenVideo.frames` of a video played at a multiple of its speed."""

    def play(video: OpenVideo, step: float = 0.0, after: float | None = None) -> Iterator[Frame]:
        for frame in frames(video, step * speed, after):
            yield replace(frame, time=frame.time / speed)

    return play


def show_counts(video: Path, squats: int, rates: list[float], speeds: list[float]) -> None:
    """Print and record the number of squats counted at each rate and speed."""
    frames = OpenVideo.frames
    for rate in rates:
        counts = []
        for speed in speeds:
            table = video.with_name(f"{video.stem}_{rate:g}_{speed:g}.parquet")
            OpenVideo.frames = speed_up(speed, frames)  # type: ignore[method-assign]
            try:
                estimate_poses(video, table, rate=rate)
            finally:
                OpenVideo.frames = frames  # type: ignore[method-assign]
            found = kineme.segment(kineme.read(table))
            counts.append(sum(row.kind == "primitive" for row in found.primitives))
            record(f"pose.count.{video.stem}.{rate:g}_hz.{speed:g}", counts[-1])
        text = ", ".join(
            f"{n} at {s:g} times the speed" for n, s in zip(counts, speeds, strict=True)
        )
        print(f"{video.name}, {squats} squats, rate {rate:g}: {text}", flush=True)


def main() -> None:
    parser = make_parser(__doc__)
    parser.add_argument(
        "--rates", type=float, nargs="*", default=choose_size([DEFAULT_RATE, 30], [])
    )
    parser.add_argument("--speeds", type=float, nargs="*", default=[1, 2, 3])
    add_option(parser)
    options = parser.parse_args()
    folder = find_data("video")
    need_packages("av", "mediapipe")
    import mediapipe

    if not hasattr(mediapipe, "solutions"):
        skip("this MediaPipe includes no model: install 0.10.21")
    with tempfile.TemporaryDirectory() as home:
        small = Path(home) / "small.mp4"
        write_small(folder / choose_size("squats_panning.mp4", "squats_side_view.mp4"), small)
        show_parts(small)
        for name, squats in VIDEOS.items():
            copy = Path(home) / name
            shutil.copyfile(folder / name, copy)
            show_counts(copy, squats, options.rates, options.speeds)


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
