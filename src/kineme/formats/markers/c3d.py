"""Read C3D: markers of optical motion capture, with events and analog channels.

Unit, rate and up axis (``POINT:Y_SCREEN``) come from the file; if they are missing they are
inferred and noted. Model outputs stored as points (angles, forces, torques, powers: the groups
listed in ``POINT:TYPE_GROUPS`` and their parameters) and markers without a name are left out. The
provenance records events and the number of the first frame.

Times count from the file's first frame, not from the start of the capture. Analog channels are not
part of a motion. They are read as signals if requested: by name, those of muscles, or all.

The analog channels mix force plates, switches, accelerometers and electrodes. A channel is a
muscle's if its label or description contains ``EMG`` or the name of a muscle, or if its unit is
milli- or microvolts. For volts the abbreviation of a muscle is sufficient (``LTA``, ``R_GM``). A
channel is not a muscle's if ``FORCE_PLATFORM:CHANNEL`` lists it, or if its unit or label states
another quantity: the accelerometer of an electrode also carries the muscle's name.
"""

from __future__ import annotations

import re
from dataclasses import replace

from kineme._util.checks import join_names, make_unique
from kineme.formats.channels.reading import ChannelTable, select_columns, to_signals
from kineme.formats.files import FileContent
from kineme.formats.markers.c3d_file import C3D, parse_c3d
from kineme.formats.options import ReadOptions
from kineme.formats.points import Points, to_motion
from kineme.formats.registry import Format
from kineme.formats.units import AXES, parse_unit
from kineme.recordings import Motion, Signals
from kineme.recordings.joint_names import is_nameless

_MODELLED = ("ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS", "REACTIONS")
_EMG = re.compile(r"emg|electromyo\w*|myo", re.IGNORECASE)
_MUSCLE = re.compile(
    r"tibialis|gastroc\w*|soleus|peron\w*|fibularis|vast(us|i)|rectus|biceps|triceps|brachi\w*|"
    r"semitend\w*|semimemb\w*|hamstrings?|quadriceps|glut\w*|sartorius|gracilis|adductor|tensor|"
    r"iliopsoas|erector|multifid\w*|longissimus|obliqu\w*|trapez\w*|delt\w*|pector\w*|latissimus|"
    r"infraspin\w*|supraspin\w*|serratus|sternocleid\w*|(?:flexor|extensor)(?:\s+\w+)?",
    re.IGNORECASE,
)
_ABBREVIATION = re.compile(
    r"(?:[lr]|left|right)?[\s_.-]*(?:ta|gm|gl|mg|lg|gas|sol|rf|vm|vl|bf|st|sm|ham|es|"
    r"gmax|gmed|glmax|glmed|add|per|pl|tfl)[\s_.-]*(?:[lr]|left|right)?",
    re.IGNORECASE,
)
_OTHER = re.compile(
    r"f[xyz]\d*|m[xyz]\d*|force\w*|moments?|torques?|cop\w*|acc\w*|gyr\w*|mag\w*|imu|pitch|roll|yaw|"
    r"goni\w*|angles?|(?:foot)?switch\w*|sync\w*|trig\w*|clock|pedal|pressure|fsr",
    re.IGNORECASE,
)
_VOLTS = frozenset({"v", "volt", "volts"})
_SMALL_VOLTS = frozenset({"mv", "uv", "µv", "μv", "millivolt", "millivolts", "microvolts"})
_NO_UNIT = frozenset({"", "d.u.", "du", "bits", "bit", "counts", "n/a", "%"})


def read_c3d(content: FileContent, options: ReadOptions) -> Motion | Signals:
    """Return the motion of the markers in a C3D file, or its analog channels.

    Channels are returned if they are requested, or if there are no points.
    """
    file = parse_c3d(content)
    if options.channels or (file.analog.size and not file.labels):
        return _read_channels(content, file, options)
    fps = content.choose_rate(options.fps, file.rate, "the file has no frame rate")
    notes = []
    markers, n_points = _find_markers(file), len(file.labels)
    if not markers:
        raise content.error(f"none of its {n_points} points is a named marker")
    if left_out := n_points - len(markers):
        reason = "since they are modelled or have no name"
        notes.append(f"{left_out} of {n_points} points left out, {reason}")
    if file.first_frame > 1:
        notes.append(f"the first frame is frame {file.first_frame} of the capture")
    if file.analog.shape[1]:
        notes.append(f"{file.analog.shape[1]} analog channels at {file.analog_rate:g} Hz left out")
    stated_up = "".join(file.parameters.strings("POINT", "Y_SCREEN")).lower().lstrip("+")
    points = Points(
        [file.labels[i] for i in markers],
        file.points[:, markers] if left_out else file.points,
        fps,
        unit=options.unit,
        stated_unit=parse_unit(next(iter(file.parameters.strings("POINT", "UNITS")), "")),
        up=options.up,
        usual_up=stated_up if stated_up in AXES else "z",
        is_up_stated=stated_up in AXES,
        person=options.person,
    )
    motion = to_motion(points, content.provenance("C3D", notes))
    read = motion.provenance
    # Events without a subject belong to everybody.
    others = {*read.people} - {read.person}
    pairs = zip(file.events, file.event_subjects, strict=True)
    events = [event for event, subject in pairs if subject not in others]
    if events:
        texts = [f"{name} at {at:.2f} s" for at, name in events]
        read = read.noted(f"events: {join_names(texts, 10)}")
    return replace(motion, provenance=read.marked(events))


def _find_markers(file: C3D) -> list[int]:
    parameters = file.parameters
    # Each group lists its labels in a parameter of the same name.
    groups = {*_MODELLED, *parameters.strings("POINT", "TYPE_GROUPS")} - {"MARKERS"}
    modelled = {label for group in groups for label in parameters.strings("POINT", group)}
    return [
        i for i, label in enumerate(file.labels) if label not in modelled and not is_nameless(label)
    ]


def _read_channels(content: FileContent, file: C3D, options: ReadOptions) -> Signals:
    """Return the channels ``options.columns``, or muscles with ``options.emg``, or all."""
    columns, notes = options.columns or None, []
    if options.emg and columns is None:
        columns, note = find_muscles(content, file)
        notes.append(note)
    if not file.analog.size:
        raise content.error("holds no analog channels")
    names = make_unique(file.analog_labels)
    chosen = select_columns(content, names, columns, names) or names
    values = file.analog[:, [names.index(name) for name in chosen]]
    table = ChannelTable(chosen, values, {}, file.analog_rate or None, tuple(notes))
    return to_signals(content, "C3D", table, options.fps)


def find_muscles(content: FileContent, file: C3D) -> tuple[list[str], str]:
    """Return the names of the muscles' channels, and a note."""
    names = make_unique(file.analog_labels)
    plates = {int(number) for number in file.parameters.numbers("FORCE_PLATFORM", "CHANNEL")}
    # Descriptions may be missing or fewer than the channels.
    descriptions = [*file.parameters.strings("ANALOG", "DESCRIPTIONS"), *[""] * len(names)]
    channels = zip(names, file.analog_labels, descriptions, file.analog_units, strict=False)
    # Force plates refer to channels by numbers from 1.
    muscles = [
        name
        for number, (name, *evidence) in enumerate(channels, 1)
        if number not in plates and is_muscle(*evidence)
    ]
    if not muscles:
        raise content.error(
            "it does not state which analog channels are muscles: name them with --columns "
            f"(columns=), from {', '.join(names)}"
        )
    others = [name for name in names if name not in muscles]
    suffix = f"; left out: {', '.join(others)}" if others else ""
    return muscles, f"channels read as muscles: {', '.join(muscles)}{suffix}"


def is_muscle(label: str, description: str = "", unit: str = "") -> bool:
    """Return whether an analog channel is a muscle's, judging by label, description and unit.

    Examples
    --------
    >>> is_muscle("L Tibialis", unit="V"), is_muscle("L Tibialis: ACC X", unit="g")
    (True, False)
    """
    # Units of other quantities (g, N) or words such as `acc` rule out a muscle.
    unit = unit.strip().lower()
    words = _split_words(f"{label} {description}")
    if unit not in _VOLTS | _SMALL_VOLTS | _NO_UNIT or any(map(_OTHER.fullmatch, words)):
        return False
    if unit in _SMALL_VOLTS or any(_EMG.match(w) or _MUSCLE.fullmatch(w) for w in words):
        return True
    return unit in _VOLTS and _ABBREVIATION.fullmatch(label.strip()) is not None


def _split_words(text: str) -> list[str]:
    """Return the words of a name: ``RTibialisAnt.EMG1`` has four."""
    # Split at changes of case (`RTib` -> `R Tib`) and at other characters.
    spaced = re.sub(r"([A-Z])(?=[A-Z][a-z])", r"\1 ", text)
    return re.findall(r"[A-Z]?[a-z]+|[A-Z]+\d*(?![a-z])", spaced)


FORMAT = Format(
    "C3D",
    (".c3d",),
    lambda head: head[1:2] == b"\x50" and 0 < head[0] < 128,
    read_c3d,
    channels=True,
    analog=True,
)
