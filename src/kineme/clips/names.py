"""Name clips and their files: ``RECORDING_NUMBER_TEXT``.

``NUMBER`` has at least four digits and is unique within a run; it continues over the recordings.
Segments left out by ``best`` keep their numbers, so that names do not depend on this option.

Words of the text that look like such a number get the prefix ``n``. So the last ``_NUMBER_`` of a
name is its number, and names are unique even if case is ignored.

A template such as ``{take}_{label}_{n:02}`` overrides this; then duplicate names are an error.

Names of clips survive import in Blender, Unreal, Unity, Godot and three.js: ASCII letters, digits
and ``_``, starting with a letter, at most 63 characters. File names keep other letters.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Container, Mapping
from itertools import chain, count
from string import Formatter

from kineme.errors import ParameterError

LONGEST = 63
"""Longest name in characters, the limit of Blender."""
LONGEST_TEXT = 24
"""Longest label in a name, in characters."""
LONGEST_IN_FILE = 80
"""Longest recording name or label in a file name, in bytes."""
FIELDS = ("name", "take", "label", "n", "cluster", "level", "direction", "loop")
"""Fields of templates; ``n`` and ``cluster`` are numbers, the others texts."""


def make_clip_name(stem: str, number: int, text: str) -> str:
    """Return the name of a clip from recording, number and label, in portable characters.

    Examples
    --------
    >>> make_clip_name("Take 1.final", 3, "Äpfel pflücken")
    'Take_1_final_0003_Apfel_pflucken'
    >>> make_clip_name("86_01", 12, "walk 2024")
    'clip_86_01_0012_walk_n2024'
    """
    middle = f"_{number:04d}_"
    # A label may have no portable characters.
    label = _protect_numbers(_to_ascii(text))[:LONGEST_TEXT].strip("_") or "clip"
    first = _to_ascii(stem)
    if not first[:1].isalpha():
        first = f"clip_{first}".rstrip("_")
    # Shorten the recording's name, since number and label identify the clip.
    first = first[: LONGEST - len(middle) - len(label)].rstrip("_")
    return f"{first}{middle}{label}"


def make_file_name(stem: str, number: int, text: str) -> str:
    """Return the file name of a clip without suffix, with letters of all scripts.

    Examples
    --------
    >>> make_file_name("Take 1", 3, "Äpfel/Birnen")
    'Take_1_0003_Äpfel_Birnen'
    """
    return f"{clean_name(stem)}_{number:04d}_{clean_name(_protect_numbers(_replace_special(text)))}"


def make_unique_name(stem: str, first: int, others: Container[str]) -> str:
    """Return a unique name for the file with all clips of a recording.

    If the recording's name is among ``others`` (lower case), append a number from ``first`` on.

    Examples
    --------
    >>> make_unique_name("Take 1", 12, {"take_1"})
    'Take_1_0012'
    """
    names = chain(
        [clean_name(stem)], (f"{clean_name(stem)}_{number:04d}" for number in count(first))
    )
    # Compare without case, since file systems may ignore it.
    return next(name for name in names if name.casefold() not in others)


def check_template(template: str) -> None:
    """Raise ParameterError if a template has unknown fields or cannot be filled in."""
    try:
        fields = [field for _, field, _, _ in Formatter().parse(template) if field is not None]
        unknown = [field for field in fields if field not in FIELDS]
        if not unknown:
            fill_template(template, dict.fromkeys(FIELDS, "") | {"n": 0, "cluster": 0})
    except (ValueError, AttributeError, TypeError) as error:
        raise ParameterError(f"name is {template!r:.60}, which is not valid: {error}") from error
    if unknown or not fields:
        names = ", ".join(f"{{{field}}}" for field in FIELDS)
        raise ParameterError(f"name is {template!r:.60}: give a text with some of {names} in it")


def fill_template(template: str, fields: Mapping[str, object]) -> tuple[str, str]:
    """Return the names of a clip and of its file, without suffix, from a template.

    Examples
    --------
    >>> fill_template("{take}@{label}_{n:02}", {"take": "Äpfel", "label": "walk", "n": 3})
    ('Apfel_walk_03', 'Äpfel@walk_03')
    """
    filled = template.format_map(fields)
    # Empty fields must not leave double underscores.
    file = re.sub(r"_{2,}", "_", _replace_special(filled, "@")).strip("_")
    name = _to_ascii(filled)
    if not name[:1].isalpha():
        name = f"clip_{name}".rstrip("_")
    return name[:LONGEST].rstrip("_"), clean_name(file, "@") or "clip"


def clean_name(text: str, more: str = "") -> str:
    """Replace all but letters, digits, ``_``, ``-`` and ``more`` by ``_``; limit the length."""
    # Cut in bytes; decoding drops a partial letter at the end.
    cleaned = _replace_special(text, more).encode(errors="replace")[:LONGEST_IN_FILE]
    return cleaned.decode(errors="ignore")


def _replace_special(text: str, more: str = "") -> str:
    allowed = f"-_{more}"
    return "".join(letter if letter.isalnum() or letter in allowed else "_" for letter in text)


def _protect_numbers(text: str) -> str:
    """Prefix words of four or more digits with ``n``."""
    return re.sub(r"(?<![^_])([0-9]{4,})(?![^_])", r"n\1", text)


def _to_ascii(text: str) -> str:
    """Return ASCII letters and digits without accents, with single ``_`` for everything else."""
    # NFKD separates accents from letters, which are then dropped; ß is not decomposed.
    decomposed = unicodedata.normalize("NFKD", text.replace("ß", "ss"))
    unaccented = "".join(letter for letter in decomposed if not unicodedata.combining(letter))
    words = "".join(each if each.isascii() and each.isalnum() else " " for each in unaccented)
    return "_".join(words.split())
