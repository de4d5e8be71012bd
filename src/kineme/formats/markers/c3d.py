"""C3D: markers of an optical motion capture, with events and analog channels.

Unit, rate and up axis (``POINT:Y_SCREEN``) are the file's own; where it has
none they are inferred and said. Results of a model that are stored as if they
were markers (angles, forces, moments, powers: the groups that
``POINT:TYPE_GROUPS`` and their own parameters name) and markers without a name
are left out. Events and the number of the first frame go into the provenance.

Times count from the file's first frame, not from the start of the capture.
Analog channels are no part of a motion: they are read as signals where they are
asked for, see `kineme.formats.markers.c3d_analog`.
"""

from __future__ import annotations

from kineme.errors import ReadError
from kineme.formats.files import FileContent
from kineme.formats.marker_sets import is_nameless
from kineme.formats.markers.c3d_analog import read_analog
from kineme.formats.markers.c3d_file import C3D, parse_c3d
from kineme.formats.options import ReadOptions
from kineme.formats.points import Points, to_motion
from kineme.formats.registry import Format
from kineme.formats.units import AXES, unit_named
from kineme.recordings import Motion, Signals

_MODELLED = ("ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS", "REACTIONS")


def read_c3d(content: FileContent, options: ReadOptions) -> Motion | Signals:
    """The motion of the markers in a C3D file, or its analog channels if they are asked for."""
    if options.channels:
        return read_analog(content, options)
    file = parse_c3d(content)
    fps = options.fps or file.rate
    if not fps:
        raise content.error("the file has no frame rate: give fps= (--fps)")
    notes = []
    markers, left_out = _markers(file)
    if not markers:
        raise ReadError(content.path, f"none of its {len(file.labels)} points is a named marker")
    if left_out:
        notes.append(
            f"{left_out} of {len(file.labels)} points left out: modelled or without a name"
        )
    if file.first_frame > 1:
        notes.append(f"the first frame is number {file.first_frame} of the capture")
    if file.analog.shape[1]:
        notes.append(
            f"{file.analog.shape[1]} analog channels at {file.analog_rate:g} Hz are not part of it"
        )
    if file.events:
        notes.append("events: " + ", ".join(f"{name} at {at:.2f} s" for at, name in file.events))
    points = Points(
        [file.labels[i] for i in markers],
        file.points[:, markers] if left_out else file.points,
        fps,
        unit=options.unit or _unit(file),
        up=options.up or _up(file),
        usual_up="z",
        person=options.person,
    )
    return to_motion(points, content.provenance("C3D", notes).marked(file.events))


def _markers(file: C3D) -> tuple[list[int], int]:
    """Indices of the points that are markers, and how many are not."""
    parameters = file.parameters
    groups = {*_MODELLED, *parameters.strings("POINT", "TYPE_GROUPS")} - {"MARKERS"}
    modelled = {label for group in groups for label in parameters.strings("POINT", group)}
    kept = [
        i for i, label in enumerate(file.labels) if label not in modelled and not is_nameless(label)
    ]
    return kept, len(file.labels) - len(kept)


def _unit(file: C3D) -> str | None:
    return unit_named(next(iter(file.parameters.strings("POINT", "UNITS")), ""))


def _up(file: C3D) -> str | None:
    axis = "".join(file.parameters.strings("POINT", "Y_SCREEN")).lower().lstrip("+")
    return axis if axis in AXES else None


FORMAT = Format(
    "C3D",
    (".c3d",),
    lambda head: head[1:2] == b"\x50" and 0 < head[0] < 128,
    read_c3d,
    channels=True,
    analog=True,
)
