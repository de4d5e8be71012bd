"""How clips and their files are called: ``RECORDING_NUMBER_TEXT``.

``NUMBER`` has four digits or more, and no two segments of a run have the same: the first segment
of a recording has as many before it as were given of the recordings before. What is left out, by
``best``, keeps its number to itself, so that a segment is called the same with and without it.

A word of the text that would look like a number, of four digits or more, has an ``n`` before it.
So the last ``_NUMBER_`` of a name is its number, and no two names of a run are the same,
whatever the case of their letters.

A template such as ``{take}_{label}_{n:02}`` says otherwise; then names that clash are an error.

The name of a clip survives import in Blender, Unreal, Unity, Godot and three.js: ASCII letters,
digits and ``_``, the first a letter, 63 characters at most. That of a file keeps other letters.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Container, Mapping
from itertools import chain, count
from string import Formatter

from kineme.errors import ParameterError

LONGEST = 63
"""Characters of a name: what Blender keeps."""
LONGEST_TEXT = 24
"""Of these, for the label."""
LONGEST_IN_FILE = 80
"""Bytes of a recording's name or of a label in that of a file."""
FIELDS = ("name", "take", "label", "n", "cluster", "level", "direction", "loop")
"""What stands in braces in a template; ``n`` and ``cluster`` are numbers, the others texts."""


def make_clip_name(stem: str, number: int, text: str) -> str:
    """Return the name of a clip: its recording, its number and its label, in letters that survive.

    Examples
    --------
    >>> make_clip_name("Take 1.final", 3, "Äpfel pflücken")
    'Take_1_final_0003_Apfel_pflucken'
    >>> make_clip_name("86_01", 12, "walk 2024")
    'clip_86_01_0012_walk_n2024'
    """
    middle = f"_{number:04d}_"
    # A label without letters that survive leaves nothing.
    label = _protect_numbers(_to_ascii(text))[:LONGEST_TEXT].strip("_") or "clip"
    first = _to_ascii(stem)
    if not first[:1].isalpha():
        first = f"clip_{first}".rstrip("_")
    # The recording's name is cut, since number and label tell clips apart.
    first = first[: LONGEST - len(middle) - len(label)].rstrip("_")
    return f"{first}{middle}{label}"


def make_file_name(stem: str, number: int, text: str) -> str:
    """Return the same for a file, without its suffix; letters of all scripts stay.

    Examples
    --------
    >>> make_file_name("Take 1", 3, "Äpfel/Birnen")
    'Take_1_0003_Äpfel_Birnen'
    """
    return f"{clean_name(stem)}_{number:04d}_{clean_name(_protect_numbers(_replace_special(text)))}"


def make_unique_name(stem: str, first: int, others: Container[str]) -> str:
    """Return the name of a file of all clips of a recording, the first of which has that number.

    A number follows where it would be one of the ``others``, which are in small letters.

    Examples
    --------
    >>> make_unique_name("Take 1", 12, {"take_1"})
    'Take_1_0012'
    """
    names = chain(
        [clean_name(stem)], (f"{clean_name(stem)}_{number:04d}" for number in count(first))
    )
    # File systems may ignore case, so names are compared without it.
    return next(name for name in names if name.casefold() not in others)


def check_template(template: str) -> None:
    """ParameterError where a template has other fields than `FIELDS`, or cannot be filled in."""
    try:
        fields = [field for _, field, _, _ in Formatter().parse(template) if field is not None]
        unknown = [field for field in fields if field not in FIELDS]
        if not unknown:
            fill_template(template, dict.fromkeys(FIELDS, "") | {"n": 0, "cluster": 0})
    except (ValueError, AttributeError, TypeError) as error:
        raise ParameterError(
            f"name is {template!r:.60}, which cannot be filled in: {error}"
        ) from error
    if unknown or not fields:
        names = ", ".join(f"{{{field}}}" for field in FIELDS)
        raise ParameterError(f"name is {template!r:.60}: give a text with some of {names} in it")


def fill_template(template: str, fields: Mapping[str, object]) -> tuple[str, str]:
    """Return the name of a clip and that of its file, without suffix, as a template has them.

    Examples
    --------
    >>> fill_template("{take}@{label}_{n:02}", {"take": "Äpfel", "label": "walk", "n": 3})
    ('Apfel_walk_03', 'Äpfel@walk_03')
    """
    filled = template.format_map(fields)
    # A field that is empty leaves no gap, such as that of loops.
    file = re.sub(r"_{2,}", "_", _replace_special(filled, "@")).strip("_")
    name = _to_ascii(filled)
    if not name[:1].isalpha():
        name = f"clip_{name}".rstrip("_")
    return name[:LONGEST].rstrip("_"), clean_name(file, "@") or "clip"


def clean_name(text: str, more: str = "") -> str:
    """Letters, digits, ``_``, ``-`` and ``more``; short enough for any file system."""
    # Cut to bytes; half a letter at the end is dropped when decoding.
    kept = _replace_special(text, more).encode(errors="replace")[:LONGEST_IN_FILE]
    return kept.decode(errors="ignore")


def _replace_special(text: str, more: str = "") -> str:
    kept = f"-_{more}"
    return "".join(letter if letter.isalnum() or letter in kept else "_" for letter in text)


def _protect_numbers(text: str) -> str:
    """Words between ``_`` that have four digits or more and nothing else get a letter."""
    return re.sub(r"(?<![^_])([0-9]{4,})(?![^_])", r"n\1", text)


def _to_ascii(text: str) -> str:
    """ASCII letters and digits, accents taken off, and single ``_`` for all else."""
    # Decomposed letters: accents become marks of their own, which are left out. ß has no such form.
    parted = unicodedata.normalize("NFKD", text.replace("ß", "ss"))
    bare = "".join(letter for letter in parted if not unicodedata.combining(letter))
    kept = "".join(each if each.isascii() and each.isalnum() else " " for each in bare)
    return "_".join(kept.split())
