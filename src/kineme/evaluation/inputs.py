"""Any result against any annotation: what the two files may be, and how they meet.

A result is a segment table (CSV, JSON, Parquet), a table of intervals with
``start_s``, ``stop_s`` and ``label`` (CSV, TSV), or a text file with one label
per frame. An annotation is a table of intervals (CSV, TSV), a text file with
one label per frame, a segment table as JSON or Parquet, or the benchmark's own
(``annotations.json``, ``mocap.txt``), of which one trial is taken. Both are
compared at 30 Hz, as published, or at the result's rate if that is lower.
"""

from __future__ import annotations

import csv
import json
import re
import warnings
from math import floor
from pathlib import Path
from typing import Any

from kineme.errors import KinemeWarning, ParameterError, ReadError
from kineme.evaluation.annotations import read_frame_labels, read_intervals, read_trials
from kineme.evaluation.labelling import Annotation, Labelling
from kineme.evaluation.scores import evaluate, evaluate_segmentation, labelling_of
from kineme.evaluation.trials import FPS
from kineme.labels import read_segments
from kineme.recordings import Motion
from kineme.recordings.operations import resample
from kineme.segments.segmentation import Segmentation

Found = Segmentation | Labelling


def read_result(path: Path, *, fps: float | None = None) -> Found:
    """What a method found: segments, intervals, or one label per frame in a text file.

    Parameters
    ----------
    fps : frames per second of a text file; of intervals 30 by default

    Raises
    ------
    ReadError : cannot be read or understood
    ParameterError : a text file without ``fps``
    """
    if path.suffix.lower() in (".csv", ".tsv") and "level" not in _first_line(path):
        return _intervals(path, fps or FPS)
    if path.suffix.lower() != ".txt":
        return read_segments(path)
    if fps is None:
        raise ParameterError(f"{path}: one label per frame needs the frame rate, --fps")
    lines = _text(path).splitlines()
    for number, line in enumerate(lines, 1):
        if not line.strip():
            raise ReadError(path, "no label on this line", line=number)
    return Labelling.from_frames([line.strip() for line in lines], fps=fps)


def read_truth(
    path: Path, found: Found, *, fps: float | None = None, trial: str | None = None
) -> Annotation:
    """What people say about the recording of this result, at the rate of comparison.

    Parameters
    ----------
    fps : frames per second of a file with one label per frame, if not the result's
    trial : which trial of the benchmark's annotations; by default the one whose
        name the result's recording has

    Raises
    ------
    ReadError : cannot be read or understood, or of another length than the result
    """
    frames, rate = comparison(found)
    suffix = path.suffix.lower()
    if _is_benchmark(path):
        truth = _trial(path, trial or _recording(found).stem, rate)
    elif suffix in (".csv", ".tsv"):
        truth = read_intervals(path, frames=frames, fps=rate)
    elif suffix in (".json", ".parquet"):
        rows = read_segments(path)
        labels = labelling_of(rows.activities, fps=rows.fps)
        names = [
            row.label or label for row, label in zip(rows.activities, labels.labels, strict=True)
        ]
        labels = Labelling(labels.borders, tuple(names), rows.fps)
        truth = _annotation(path, labels, frames, rate)
    else:
        truth = read_frame_labels(path, frames=frames, fps=rate, labels_fps=fps or found.fps)
    if truth.frames != frames:
        raise ReadError(
            path,
            f"speaks of {truth.frames / rate:.2f} s, the result of {frames / rate:.2f} s",
        )
    return truth


def comparison(found: Found) -> tuple[int, float]:
    """Frames and rate at which a result is compared: 30 Hz, or its own if lower."""
    frames = found.n_frames if isinstance(found, Segmentation) else found.frames
    rate = min(FPS, found.fps)
    return floor((frames - 1) * rate / found.fps + 1e-9) + 1, rate


def score(truth: Annotation, found: Found, motion: Motion | None = None) -> dict[str, float]:
    """Every score; with the recording also the variances within clusters.

    Raises
    ------
    ParameterError : the recording is of another length than the result
    """
    data: dict[str, Any] = {}
    if motion is not None:
        from kineme.methods.region_growing.preset import VOEGELE2014
        from kineme.segmentation.bodies import motion_features

        preset = VOEGELE2014.replace(working_fps=truth.fps)
        data["positions"] = resample(motion, truth.fps).positions
        data["features"] = motion_features(motion, preset)
        if len(data["positions"]) != truth.frames:
            raise ParameterError(
                f"the recording has {len(data['positions'])} frames at {truth.fps:g} Hz, "
                f"the result {truth.frames}"
            )
    if isinstance(found, Segmentation):
        return evaluate_segmentation(truth, found, **data)
    return evaluate(truth, found, **data)


def recording_of(found: Found) -> Path | None:
    """The file a segmentation was made from, if it is still there and unchanged."""
    from kineme.formats.files import load

    path = _recording(found)
    if not path.is_file() or not isinstance(found, Segmentation):
        return None
    same = load(path).digest == found.provenance["input"].get("sha256")
    return path if same else None


def _intervals(path: Path, fps: float) -> Labelling:
    """A table of intervals as a result that lasts to its last stop."""
    lines = _text(path).splitlines()
    separator = "\t" if "\t" in lines[0] else ","
    try:
        stops = [float(row["stop_s"]) for row in csv.DictReader(lines, delimiter=separator)]
        frames = max(1, round(max(stops) * fps))
    except (KeyError, ValueError, TypeError, OverflowError):
        frames = 1  # the reader says what is wrong
    return read_intervals(path, frames=frames, fps=fps).labelling()


def _first_line(path: Path) -> str:
    return _text(path).partition("\n")[0]


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise ReadError(path, f"cannot be read: {error.strerror or error}") from error
    except UnicodeDecodeError as error:
        raise ReadError(path, f"is not UTF-8 text (byte {error.start})") from error


def _recording(found: Found) -> Path:
    source = found.provenance.get("input", {}) if isinstance(found, Segmentation) else {}
    return Path(source.get("path") or "")


def _is_benchmark(path: Path) -> bool:
    """Whether this is ``annotations.json`` or ``mocap.txt``, by what it holds."""
    if path.suffix.lower() == ".txt":
        return re.match(r"\s*\S*\b\d+_\d+\b", _text(path)) is not None
    if path.suffix.lower() != ".json":
        return False
    try:
        content = json.loads(_text(path))
    except ValueError:
        return False
    return isinstance(content, dict) and "trials" in content


def _trial(path: Path, name: str, rate: float) -> Annotation:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", KinemeWarning)
        trials = read_trials(path, fps=rate)
    if name not in trials:
        raise ReadError(
            path, f"holds no trial {name!r}: name one of {', '.join(trials)} with --trial"
        )
    return trials[name]


def _annotation(path: Path, labels: Labelling, frames: int, rate: float) -> Annotation:
    try:
        return Annotation.from_labelling(labels.at(frames=frames, fps=rate))
    except ParameterError as error:
        raise ReadError(path, str(error)) from error
