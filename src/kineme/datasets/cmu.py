"""Download recordings of the CMU Graphics Lab Motion Capture Database from its site.

Files are stored as published: the subject's skeleton (ASF) and one AMC per trial, 120 Hz. For
subject 86, which segmentation papers use as a benchmark, the human annotations of trials 1 to 14
are downloaded from their authors' repository.

Source: mocap.cs.cmu.edu, "free for all uses", funded by NSF EIA-0196217;
annotations by Zhou, De la Torre and Hodgins, github.com/zhfe99/aca.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import count
from os import PathLike, environ
from pathlib import Path

from kineme._util.checks import require_extra
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

    Existing files are checked instead of downloaded; invalid ones are downloaded again.

    Parameters
    ----------
    subject : int
        Its number in the database.
    trials : sequence of int, optional
        Numbers of the trials; by default from 1 up to the first that the site does not have.
    folder : str or PathLike, optional
        Folder for the files; ``cmuNN`` in `find_cache_folder` by default.
    progress : callable, optional
        Called during downloads with name, bytes so far, and total bytes or None.
    site, annotations : str, optional
        Addresses, for mirrors.
    timeout_s : float, optional
        Seconds without data after which a connection is retried.

    Raises
    ------
    ParameterError
        Numbers below 1.
    ReadError
        No such subject or trial, or a file that cannot be downloaded completely.
    WriteError
        The folder cannot be written to.
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
        from kineme.datasets.annotated_trials import read_actions

        with warnings.catch_warnings():
            warnings.simplefilter("ignore", KinemeWarning)
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
