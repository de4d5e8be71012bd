"""Convert motions to and from xarray datasets in the layout of the package movement.

The layout has ``position`` (time, space, keypoints, individuals), ``confidence`` (time, keypoints,
individuals) and the attributes ``ds_type``, ``fps``, ``time_unit`` and ``source_software``. kineme
also writes that lengths are metres and y is up, and optionally the segments: ``activity``,
``primitive`` (row numbers within each level), ``cluster`` and ``label`` (time), so that
``ds.where(ds.cluster == 3)`` works.

The layout has no skeleton and no rotations; `kineme.formats.points` describes how points become a
motion.

Source: https://movement.neuroinformatics.dev, user guide, "movement datasets"; movement 0.15.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from kineme._util.checks import require_extra, warn
from kineme.errors import ParameterError, ReadError
from kineme.formats.files import FileContent
from kineme.formats.plausibility import split_at
from kineme.formats.points import LIMIT, Points, to_motion
from kineme.formats.sniffing import find_timing, place_points
from kineme.recordings import Motion, Provenance
from kineme.recordings.arrays import mark_spans
from kineme.recordings.regular import Timing
from kineme.segments.segmentation import check_same_length

if TYPE_CHECKING:
    import xarray as xr

    from kineme.segments.segmentation import Segmentation
    from kineme.segments.table import Level

DIMS = ("time", "space", "keypoints", "individuals")


def to_movement(
    motion: Motion, segmentation: Segmentation | None = None, *, individual: str = "id_0"
) -> xr.Dataset:
    """Return the motion as a poses dataset, with confidence 0 in gaps and 1 elsewhere.

    Parameters
    ----------
    motion : Motion
    segmentation : Segmentation, optional
        Segments of this motion to include.
    individual : str, optional
        Name of the person.

    Raises
    ------
    ParameterError
        The segmentation has another length.
    MissingDependencyError
        xarray is not installed.

    Examples
    --------
    >>> import kineme
    >>> from kineme.interop.movement_dataset import to_movement
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> dict(to_movement(motion).sizes)
    {'time': 2898, 'space': 3, 'keypoints': 26, 'individuals': 1}
    """
    with require_extra("xarray", "xarray"):
        import xarray as xr
    missing = mark_spans(motion.gaps, motion.n_frames)
    positions = np.where(missing[:, None, None], np.nan, motion.positions)
    # The same confidence for all keypoints of a frame: 0 in gaps, else 1.
    confidence = np.repeat(1.0 - missing[:, None], motion.skeleton.n_joints, axis=1)
    variables: dict[str, Any] = {
        # Frames, axes, keypoints, and one individual.
        "position": (DIMS, positions.transpose(0, 2, 1)[..., None]),
        "confidence": (("time", "keypoints", "individuals"), confidence[..., None]),
    }
    if segmentation is not None:
        rows = _make_frame_variables(motion, segmentation)
        variables |= {name: ("time", values) for name, values in rows.items()}
    return xr.Dataset(
        variables,
        coords={
            "time": motion.times,
            "space": list("xyz"),
            "keypoints": list(motion.skeleton.names),
            "individuals": [individual],
        },
        attrs={
            "ds_type": "poses",
            "fps": motion.fps,
            "time_unit": "seconds",
            "source_software": "kineme",
            "source_file": motion.provenance.path or "",
            "length_unit": "m",
            "up": "y",
        },
    )


def from_movement(
    dataset: xr.Dataset,
    *,
    individual: str | None = None,
    fps: float | None = None,
    unit: str | float | None = None,
    up: str | None = None,
    confidence: float = LIMIT,
) -> Motion:
    """Return the motion of one individual of a poses dataset, in metres with y up.

    Parameters
    ----------
    dataset : xr.Dataset
        Must have ``position``; ``confidence`` is optional.
    individual : str, optional
        Name of the individual; required if there are several.
    fps : float, optional
        Frame rate that overrides the dataset, as for `kineme.read`.
    unit : str or float, optional
        Unit of length that overrides the dataset.
    up : str, optional
        Vertical axis that overrides the dataset.
    confidence : float, optional
        Points with a lower confidence are missing.

    Raises
    ------
    ParameterError
        Another layout, unknown individual, or several and none named.
    ReadError
        Points that are not a motion, or an unknown frame rate.

    Examples
    --------
    >>> import kineme
    >>> from kineme.interop.movement_dataset import from_movement, to_movement
    >>> motion = kineme.read(kineme.bundled_recording())
    >>> from_movement(to_movement(motion)).n_frames == motion.n_frames
    True
    """
    person = _select_individual(dataset, individual)
    position = person["position"].transpose("time", "keypoints", "space")
    axes = [str(axis) for axis in position["space"].values]
    if sorted(axes) not in (["x", "y"], ["x", "y", "z"]):
        raise ParameterError(f"space must be x, y and optionally z, not {', '.join(axes)}")
    # A missing z axis stays 0.
    places = np.zeros((*position.shape[:2], 3))
    for axis in axes:
        places[..., "xyz".index(axis)] = position.sel(space=axis)
    notes = [] if "z" in axes else ["two-dimensional: z is 0, and image rows count downwards"]
    if "confidence" in person:
        likelihood = np.asarray(person["confidence"].transpose("time", "keypoints"), np.float64)
        # False for nan: points without a confidence are kept.
        places[likelihood < confidence] = np.nan
    attributes = dataset.attrs
    source = FileContent(Path(str(attributes.get("source_file") or "dataset")), b"")
    timing = _read_timing(source, dataset, fps)
    flat = "z" not in axes
    places, gaps = place_points(timing, places)
    points = Points(
        [str(name) for name in position["keypoints"].values],
        places,
        timing.fps,
        unit or attributes.get("length_unit") or ("pixel" if flat else None),
        up or attributes.get("up") or ("-y" if flat else None),
    )
    name = f"movement dataset ({attributes.get('source_software') or 'unknown software'})"
    provenance = Provenance(str(source.path), name).timed(timing.clock, timing.row_seconds)
    provenance = provenance.noted(*timing.notes, *notes)
    motion = split_at(to_motion(points, provenance), gaps)
    if remarks := motion.provenance.warnings:
        warn(f"{provenance.path or 'dataset'}: {'; '.join(remarks)}")
    return motion


def _select_individual(dataset: xr.Dataset, name: str | None) -> xr.Dataset:
    """Return the data of one individual."""
    if "position" not in dataset or not {"time", "space", "keypoints"} <= {
        *dataset["position"].dims
    }:
        raise ParameterError("the dataset has no position (time, space, keypoints, individuals)")
    if "individuals" not in dataset.dims:
        return dataset
    names = [str(one) for one in dataset["individuals"].values]
    if name is None and len(names) > 1:
        raise ParameterError(f"the dataset has several individuals: name one of {', '.join(names)}")
    if name is not None and name not in names:
        raise ParameterError(f"no individual {name!r}; there are {', '.join(names)}")
    return dataset.isel(individuals=0 if name is None else names.index(name))


def _read_timing(source: FileContent, dataset: xr.Dataset, fps: float | None) -> Timing:
    rate = fps or dataset.attrs.get("fps")
    if rate:
        return Timing(float(rate))
    if dataset.attrs.get("time_unit") == "seconds":
        return find_timing(source, np.asarray(dataset["time"], np.float64))
    raise ReadError(source.path, "the dataset has times in frames but no fps: give fps=")


def _make_frame_variables(motion: Motion, segmentation: Segmentation) -> dict[str, NDArray[Any]]:
    """Return number, cluster and label of the segment of each frame."""
    check_same_length(segmentation, motion.n_frames)
    level: Level = "primitive" if len(segmentation.primitives) else "activity"
    primitives = segmentation.level(level)
    lengths = primitives.stop_frame - primitives.start_frame
    return {
        "activity": segmentation.per_frame("activity", level="activity"),
        "primitive": np.repeat(np.arange(len(primitives)), lengths),
        "cluster": segmentation.per_frame("cluster", level=level),
        "label": segmentation.per_frame("label", level=level),
    }
