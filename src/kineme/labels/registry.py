"""write_segments() and read_segments(): any format, by its name or the file's suffix."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from math import isclose
from os import PathLike
from pathlib import Path
from typing import Any, Literal

from kineme._checks import check_path, check_type, is_number, is_one_of
from kineme.errors import FileError, ParameterError, ReadError, WriteError
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import Level, Segment


@dataclass(frozen=True)
class LabelFormat:
    """One format: the module that reads and writes it, and the suffixes that mean it.

    ``holds``: the whole segmentation; the labels of both levels; or of one.
    A module of the first kind has ``write(segmentation, path)`` and
    ``read(path)`` to a `Segmentation` (or to `Labels`, from a list kept by
    hand); the others have ``write(rows, segmentation, path)`` and
    ``read(path)`` to `Labels`. ``writes``: false where there is only ``read``.
    """

    module: str
    suffixes: tuple[str, ...]
    holds: Literal["all", "levels", "level"]
    writes: bool = True


FORMATS = {
    "csv": LabelFormat("csv_table", (".csv",), "all"),
    "json": LabelFormat("json_table", (".json",), "all"),
    "parquet": LabelFormat("parquet_table", (".parquet",), "all"),
    "audacity": LabelFormat("audacity", (".txt",), "level"),
    "elan": LabelFormat("elan", (".eaf",), "levels"),
    "textgrid": LabelFormat("textgrid", (".textgrid",), "levels"),
    "bids": LabelFormat("bids", (".tsv",), "levels"),
    "boris": LabelFormat("boris", (), "levels"),
    "babel": LabelFormat("babel", (), "level"),
    "ms-tcn": LabelFormat("ms_tcn", (), "level"),
    "clips": LabelFormat("clip_list", (), "level"),
    "c3d": LabelFormat("c3d_events", (".c3d",), "level", writes=False),
}
SUFFIXES = tuple(s for known in FORMATS.values() if known.writes for s in known.suffixes)


def write_segments(
    segmentation: Segmentation,
    path: str | PathLike[str],
    *,
    format: str | None = None,  # noqa: A002 (what everybody calls it)
    level: Level | None = None,
) -> None:
    """Write a segmentation in a format; all of it, or nothing.

    Parameters
    ----------
    path : the file; its suffix tells the format where ``format`` does not
    format : a name in :data:`kineme.labels.FORMATS`
    level : of the segments to write; by default both in formats that hold
        both, else ``activity``. The package's own formats always hold both.

    Raises
    ------
    ParameterError : no such format or level
    WriteError : unknown suffix, something the format cannot hold, or the file
        cannot be written
    MissingDependencyError : Parquet without pyarrow
    """
    check_type(segmentation, Segmentation, "write_segments", "kineme.segment(motion) gives one")
    check_path(path, "write_segments")
    name = _format_of(path, format, WriteError)
    known, module = FORMATS[name], _module(name)
    if not known.writes:
        raise WriteError(path, f"{name} is only read: segments go into {', '.join(SUFFIXES)}")
    if known.holds == "all":
        if level is not None:
            raise ParameterError(f"{name} always holds both levels: leave out level={level!r}")
        module.write(segmentation, Path(path))
        return
    if level is None and known.holds == "level":
        level = "activity"
    rows: list[Segment] = list(segmentation if level is None else segmentation.level(level))
    if not rows:
        raise WriteError(path, f"there are no segments of level {level!r}")
    module.write(rows, segmentation, Path(path))


def read_segments(
    path: str | PathLike[str],
    *,
    format: str | None = None,  # noqa: A002
    fps: float | None = None,
    n_frames: int | None = None,
) -> Segmentation:
    """The segmentation in a file of any of the formats that :func:`write_segments` writes.

    Parameters
    ----------
    path : the file; its suffix tells the format where ``format`` does not
    format : a name in :data:`kineme.labels.FORMATS`
    fps : frame rate of the recording, for formats that hold seconds only
    n_frames : length of the recording, where the last label may end before it

    Raises
    ------
    ParameterError : no such format, or a frame rate or length that is not positive
    ReadError : missing, damaged, of another format, of a newer version; or at
        odds with ``fps`` or ``n_frames``
    MissingDependencyError : Parquet without pyarrow
    """
    check_path(path, "read_segments")
    name = _format_of(path, format, ReadError)
    if fps is not None and not (is_number(fps) and fps > 0):
        raise ParameterError(f"fps is {fps!r:.60}: give frames per second, above 0")
    if n_frames is not None and not (is_number(n_frames) and n_frames >= 1):
        raise ParameterError(f"n_frames is {n_frames!r:.60}: a recording has at least 1 frame")
    module = _module(name)
    try:
        content = module.read(Path(path))
        if isinstance(content, Segmentation):
            result = content
        else:
            from kineme.labels.spans import as_segmentation

            result = as_segmentation(content, Path(path), name, fps=fps, n_frames=n_frames)
        _check_agreement(result, content.fps, path, fps=fps, n_frames=n_frames)
    except OSError as error:
        raise ReadError(path, f"cannot be read: {error.strerror or error}") from error
    except UnicodeDecodeError as error:
        encoding = error.encoding.upper()
        raise ReadError(path, f"is not {encoding} text (byte {error.start})") from error
    except ParameterError as error:
        raise ReadError(path, str(error)) from error
    return result


def _check_agreement(
    result: Segmentation,
    told: float | None,
    path: str | PathLike[str],
    *,
    fps: float | None,
    n_frames: int | None,
) -> None:
    if fps is not None and told is not None and not isclose(told, fps, rel_tol=1e-6):
        raise ReadError(path, f"says {told:g} frames per second, but fps is {fps:g}")
    if n_frames is not None and result.n_frames != n_frames:
        raise ReadError(path, f"is of {result.n_frames} frames, but n_frames is {n_frames}")


def _module(name: str) -> Any:
    return import_module(f"kineme.labels.{FORMATS[name].module}")


def _format_of(path: str | PathLike[str], name: str | None, error: type[FileError]) -> str:
    if name is not None:
        if not is_one_of(name, FORMATS):
            raise ParameterError(f"format must be one of {', '.join(FORMATS)}, not {name!r}")
        return name
    suffix = Path(path).suffix.lower()
    for known, candidate in FORMATS.items():
        if suffix in candidate.suffixes:
            return known
    nameless = ", ".join(known for known, candidate in FORMATS.items() if not candidate.suffixes)
    raise error(
        path,
        f"segments are stored as {', '.join(SUFFIXES)}, not {suffix or 'that'!r}; "
        f"or name the format: {nameless}",
    )
