"""Which analog channels of a C3D are muscles.

A laboratory's amplifier takes everything: force plates, switches, accelerometers and
electrodes stand side by side. A channel is a muscle's if its label or description says
so, by ``EMG`` or the name of a muscle, or if it is in milli- or microvolts; in volts,
the abbreviation of a muscle will do (``LTA``, ``R_GM``). None is if
``FORCE_PLATFORM:CHANNEL`` names it, if its unit is that of something else, or if its
label says what it is: the accelerometer of an electrode carries the muscle's name, too.
"""

from __future__ import annotations

import re

from kineme.formats.files import FileContent, unique
from kineme.formats.markers.c3d_file import C3D

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


def muscles_of(content: FileContent, file: C3D) -> tuple[list[str], str]:
    """The names of the channels that are muscles', and a sentence on what was taken.

    Raises
    ------
    ReadError
        Nothing tells that a channel is one.
    """
    names = unique(file.analog_labels)
    plates = {int(number) for number in file.parameters.numbers("FORCE_PLATFORM", "CHANNEL")}
    described = file.parameters.strings("ANALOG", "DESCRIPTIONS")
    described = [*described, *[""] * len(names)]
    muscles = [
        name
        for number, (name, label, text, unit) in enumerate(
            zip(names, file.analog_labels, described, file.analog_units, strict=False), 1
        )
        if number not in plates and is_muscle(label, text, unit)
    ]
    if not muscles:
        raise content.error(
            "nothing tells which of its analog channels are muscles: name them with "
            f"--columns (columns=), of {', '.join(names)}"
        )
    others = [name for name in names if name not in muscles]
    left = f"; left out: {', '.join(others)}" if others else ""
    return muscles, f"channels taken for muscles: {', '.join(muscles)}{left}"


def is_muscle(label: str, description: str = "", unit: str = "") -> bool:
    """Whether an analog channel is a muscle's, as far as its own words tell.

    Examples
    --------
    >>> is_muscle("L Tibialis", unit="V"), is_muscle("L Tibialis: ACC X", unit="g")
    (True, False)
    """
    unit = unit.strip().lower()
    words = _words(f"{label} {description}")
    if unit not in _VOLTS | _SMALL_VOLTS | _NO_UNIT or any(map(_OTHER.fullmatch, words)):
        return False
    if unit in _SMALL_VOLTS or any(_EMG.match(w) or _MUSCLE.fullmatch(w) for w in words):
        return True
    return unit in _VOLTS and _ABBREVIATION.fullmatch(label.strip()) is not None


def _words(text: str) -> list[str]:
    """The words of a name: ``RTibialisAnt.EMG1`` has four."""
    return re.findall(
        r"[A-Z]?[a-z]+|[A-Z]+\d*(?![a-z])", re.sub(r"([A-Z])(?=[A-Z][a-z])", r"\1 ", text)
    )
