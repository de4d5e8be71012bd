"""Make the bundled recording anew: ``python tests/helpers/make_bundled.py``."""

from __future__ import annotations

from pathlib import Path

from kineme.datasets.bundled import bundled_recording, bundled_truth
from kineme.datasets.synthetic import Action, synthesize
from kineme.formats import write
from kineme.labels import write_segments

_SEED = 86
_DECIMALS = 2  # of centimetres and degrees: a small file, and finer than any camera


def make_bundled(folder: Path) -> None:
    """Write the bundled recording and its true segments to a folder."""
    actions = (  # name, number of repetitions
        Action("walk", 5),
        Action("squat", 4),
        Action("walk", 4),
        Action("arm circles", 5),
        Action("jump", 4),
        Action("run", 6),
        Action("kick", 4),
    )
    recording = synthesize(actions, fps=60.0, seed=_SEED)
    bvh = folder / bundled_recording().name
    write(recording.motion, bvh)
    bvh.write_text(
        _shorten_decimals(bvh.read_text(encoding="utf-8")), encoding="utf-8", newline="\n"
    )
    write_segments(recording.truth, folder / bundled_truth().name)


def _shorten_decimals(text: str) -> str:
    """Return the same BVH with fewer decimals in its frames."""
    head, timing, frames = text.partition("Frame Time:")
    step, *lines = frames.splitlines()
    return "\n".join([head + timing + step, *map(_shortened_line, lines), ""])


def _shortened_line(line: str) -> str:
    numbers = (round(float(word), _DECIMALS) + 0.0 for word in line.split())
    return " ".join(f"{number:g}" if number % 1 == 0 else str(number) for number in numbers)


if __name__ == "__main__":
    make_bundled(bundled_recording().parent)
