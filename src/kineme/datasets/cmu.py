"""Download recordings of the CMU Graphics Lab Motion Capture Database from its site.

Files are stored as published: the subject's skeleton (ASF) and one AMC per trial, 120 Hz. For
subject 86, which segmentation papers use as a benchmark, the human annotations of trials 1 to 14
are downloaded from their authors' repository.

Source: mocap.cs.cmu.edu, "free for all uses", funded by NSF EIA-0196217;
annotations by Zhou, De la Torre and Hodgins, github.com/zhfe99/aca.

`read_actions` reads these annotations of three people: the actions of each trial and their ends,
from ``annotations.json`` or from the authors' text, ``mocap.txt``. The text has a line with the
name of each trial, then ``label earliest mean latest`` for each action. Marks are frames at 120 Hz,
counted from 1. Known errors are corrected: a mean outside its span widens the span, and trial 86_04
gets the authors' correction.
"""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import count
from os import PathLike, environ
from pathlib import Path
from typing import Annotated, NamedTuple

from msgspec import Meta, Struct

from kineme._util.checks import require_extra
from kineme._util.json import decode_json
from kineme.datasets.download import TIMEOUT_S, Progress, fetch
from kineme.errors import (
    FileError,
    KinemeWarning,
    ParameterError,
    ReadError,
)

SITE = "http://mocap.cs.cmu.edu"
ANNOTATIONS = "https://raw.githubusercontent.com/zhfe99/aca/master/data/moc/mocap.txt"

# Lengths in frames of the annotated trials, 86_01 to 86_14, at which the annotations end.
FRAMES = {
    f"86_{trial:02d}": frames
    for trial, frames in enumerate(
        (4579, 10617, 8401, 10078, 8340, 9939, 8702, 9206, 4794, 7583, 5674, 8856, 6221, 6055), 1
    )
}
TRIAL_FPS = 120.0
"""Frames per second of the annotated trials."""
# In the first publication, trial 86_04, row 5 ends before it begins; the authors corrected it.
CORRECTIONS = {("86_04", 5, (4060, 5050, 5090)): (5052, 5052, 5092)}
Mark = Annotated[int, Meta(ge=0, lt=10**9)]


@dataclass(frozen=True)
class Fetched:
    """A checked file in the cache; ``frames`` is None if it is not a motion."""

    path: Path
    frames: int | None
    size: int
    new: bool


def find_cache_folder() -> Path:
    """Return the folder for recordings: ``KINEME_CACHE``, else the system's cache folder."""
    setting = environ.get("KINEME_CACHE")
    if setting:
        return Path(setting)
    with require_extra("pooch", "data"):
        import pooch
    return Path(pooch.os_cache("kineme"))


def fetch_subject(
    subject: int,
    trials: Sequence[int] | None = None,
    *,
    folder: str | PathLike[str] | None = None,
    progress: Progress | None = None,
    site: str = SITE,
    annotations: str = ANNOTATIONS,
    timeout_s: float = TIMEOUT_S,
) -> Iterator[Fetched]:
    """Download and yield skeleton, trials and, for subject 86, annotations.

    Existing files are checked instead of downloaded; invalid ones are downloaded again. By default
    the trials are those from 1 up to the first that the site does not have, and the folder is
    ``cmuNN`` in `find_cache_folder`. ``progress`` is called with name, bytes so far, and total
    bytes or None. A connection without data for ``timeout_s`` is retried. ``site`` and
    ``annotations`` are addresses, for mirrors.

    Raise ParameterError for numbers below 1, ReadError if a subject or trial does not exist or
    cannot be downloaded completely, and WriteError if the folder cannot be written to.
    """
    for number in (subject, *(trials or ())):
        if number < 1:
            raise ParameterError(f"subjects and trials are numbered from 1, not {number}")
    home = Path(folder) if folder is not None else find_cache_folder() / f"cmu{subject:02d}"
    base = f"{site.rstrip('/')}/subjects/{subject:02d}/{subject:02d}"

    def get(url: str) -> Fetched | None:
        return _check_content(url, home, progress, timeout_s)

    skeleton = get(f"{base}.asf")
    if skeleton is None:
        raise ReadError(f"{base}.asf", f"the database has no subject {subject}")
    yield skeleton
    for trial in count(1) if trials is None else trials:
        found = get(f"{base}_{trial:02d}.amc")
        if found is not None:
            yield found
        elif trials is not None or trial == 1:
            raise ReadError(f"{base}_{trial:02d}.amc", f"subject {subject} has no trial {trial}")
        else:
            break
    if subject == 86:
        text = get(annotations)
        if text is None:
            raise ReadError(annotations, "the annotations were removed meanwhile: fetch them again")
        yield text


def _check_content(
    url: str, folder: Path, progress: Progress | None, timeout_s: float
) -> Fetched | None:
    """Return the file at a URL, downloaded if necessary, after checking its content."""
    frames: list[int | None] = []

    def check(path: Path) -> None:
        frames.append(_read_content(path, folder))

    path = folder / url.rsplit("/", 1)[-1]
    if path.is_file():
        try:
            check(path)
            return Fetched(path, frames[-1], path.stat().st_size, new=False)
        except FileError:
            path.unlink()
    if fetch(url, folder, check=check, progress=progress, timeout_s=timeout_s) is None:
        return None
    return Fetched(path, frames[-1], path.stat().st_size, new=True)


def _read_content(path: Path, folder: Path) -> int | None:
    """Read a file of the database to check it; return the frames of a motion, else None."""
    if path.suffix == ".amc":
        return _count_frames(path, folder)
    if path.suffix == ".asf":
        from kineme.formats.files import load
        from kineme.formats.skeletons.asf import read_asf

        read_asf(load(path))
    else:
        with warnings.catch_warnings(action="ignore", category=KinemeWarning):
            read_actions(path)
    return None


def _count_frames(path: Path, folder: Path) -> int:
    """Return the number of frames of a motion; raise ReadError if the file is truncated."""
    from kineme.formats import read

    (skeleton,) = folder.glob("*.asf")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", KinemeWarning)
        found = read(path, skeleton=skeleton).n_frames
    for warning in caught:
        if "truncated" in str(warning.message):
            raise ReadError(path, str(warning.message).removeprefix(f"{path}, "))
    # A shorter file of an annotated trial is not the published one.
    expected = FRAMES.get(path.stem, found)
    if found != expected:
        raise ReadError(path, f"{found} frames, while trial {path.stem} has {expected}")
    return found


class _Row(Struct):
    """An action in ``annotations.json``."""

    label: str
    end_earliest: Mark
    end_mean: Mark
    end_latest: Mark


class _File(Struct):
    """Content of ``annotations.json``."""

    trials: dict[str, Annotated[list[_Row], Meta(min_length=1)]]


class Action(NamedTuple):
    """One row as published: marks at 120 Hz, from 1."""

    label: str
    earliest: int
    mean: int
    latest: int


def read_actions(path: str | PathLike[str]) -> dict[str, list[Action]]:
    """Read the actions of each trial from ``annotations.json`` or the authors' text.

    Known errors are corrected, with a `KinemeWarning` for every row.
    """
    trials = (
        _read_json_trials(path) if Path(path).suffix.lower() == ".json" else _read_text_trials(path)
    )
    return {name: _correct_rows(name, rows) for name, rows in trials.items()}


def _read_json_trials(path: str | PathLike[str]) -> dict[str, list[Action]]:
    try:
        trials = decode_json(_read_text(path), path, _File).trials
    except ReadError as error:
        reason = f"no annotations.json of the benchmark: it {error.reason}"
        raise ReadError(path, reason, line=error.line) from error
    return {
        name: [Action(row.label, row.end_earliest, row.end_mean, row.end_latest) for row in rows]
        for name, rows in trials.items()
    }


def _read_text_trials(path: str | PathLike[str]) -> dict[str, list[Action]]:
    """Read the authors' text: lines with trial names, and rows of a label and three numbers."""
    trials: dict[str, list[Action]] = {}
    rows: list[Action] | None = None
    for number, line in enumerate(_read_text(path).splitlines(), 1):
        row = re.fullmatch(r"\s*(\S.*?)\s+(\d{1,9})\s+(\d{1,9})\s+(\d{1,9})\s*", line)
        head = re.search(r"\b\d+_\d+\b", line)
        if head:
            rows = trials.setdefault(head[0], [])
        elif row and rows is not None:
            rows.append(Action(row[1], *map(int, row.groups()[1:])))
        elif line.strip():
            reason = (
                "expected the name of a trial or 'label earliest mean latest', found: "
                f"{line.strip()!r}"
            )
            raise ReadError(path, reason, line=number)
    if not trials or not all(trials.values()):
        empty = next((name for name, actions in trials.items() if not actions), None)
        raise ReadError(path, f"trial {empty} has no rows" if empty else "contains no trial")
    return trials


def _correct_rows(trial: str, rows: list[Action]) -> list[Action]:
    """Return the rows with known errors corrected, and the marks of each in order."""
    corrected = []
    for number, row in enumerate(rows, 1):
        frames = CORRECTIONS.get((trial, number, row[1:]), row[1:])
        # A mean outside its span widens the span.
        fixed = Action(row.label, min(frames), frames[1], max(frames))
        if fixed != row:
            warnings.warn(
                f"trial {trial}, row {number} ({row.label}): marks {row[1:]} corrected to "
                f"{fixed[1:]}",
                KinemeWarning,
                stacklevel=4,
            )
        corrected.append(fixed)
    return corrected


def _read_text(path: str | PathLike[str]) -> str:
    try:
        return Path(path).read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise ReadError(path, f"cannot be read: {error}") from error
