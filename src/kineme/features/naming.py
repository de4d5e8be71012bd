"""Joint names, as the usual programs write them, taken apart.

``mixamorig:LeftHand``, ``Bip01 L Hand``, ``hand_l``, ``hand.L``, ``lhand`` and ``WristLeft`` all
say a side and a part; what comes before them is a prefix. A joint is matched when its name, without
side, numbers and prefix, ends in one of the words asked for. The shortest prefix wins (``foot_l``
before ``ik_foot_l``), then the joint nearer to the root.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import lru_cache

_SIDES = {"l": "left", "left": "left", "r": "right", "right": "right"}
_NOT_THE_JOINT = frozenset({"ik", "pole", "target", "twist", "roll", "ctrl", "prop", "goal"})
_WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+")
_SIDE_PREFIX = re.compile(r"(left|right|l|r)([a-z]+)")


def find_by_name(names: Sequence[str], words: Sequence[str], side: str | None) -> int | None:
    """Index of the joint that is called by one of ``words``, or None.

    Parameters
    ----------
    names : sequence of str
        Of the joints, parents before children.
    words : sequence of str
        Wanted parts, lower case, the preferred one first.
    side : str or None
        "left", "right", or None for a joint on the body's midline.
    """
    for word in words:
        found = [
            (before, joint)
            for joint, name in enumerate(names)
            if (before := _words_before(name, word, side)) is not None
        ]
        if found:
            # The fewest words before; of equals the first joint, which is nearer to the root.
            return min(found)[1]
    return None


@lru_cache(maxsize=4096)
def words_of(name: str) -> tuple[str, ...]:
    """Return the words of a name in lower case, without namespace, separators and numbers."""
    # Namespaces end with a colon (`mixamorig:`) or a bar.
    local = re.split(r"[:|]", name)[-1]
    return tuple(word.lower() for word in _WORD.findall(local) if not word.isdigit())


def part_and_side(name: str) -> tuple[str, str]:
    """``("knee", "left")`` for ``LKnee``, ``knee_l`` or ``L.Knee``; no side is ``""``."""
    words = list(words_of(name))
    for place, word in enumerate(words):
        if word in _SIDES:
            del words[place]
            return "".join(words), _SIDES[word]
    # A side without separator, as in `lhand`, is looked for in the last word only.
    side_prefix = _SIDE_PREFIX.fullmatch(words[-1]) if words else None
    return (side_prefix[2], _SIDES[side_prefix[1]]) if side_prefix else ("".join(words), "")


@lru_cache(maxsize=4096)
def _words_before(name: str, word: str, side: str | None) -> int | None:
    """Return how many words are before ``word``, or None if the name says something else."""
    words = list(words_of(name))
    found_side = None
    for place, candidate in enumerate(words):
        if candidate in _SIDES:
            found_side = _SIDES[candidate]
            del words[place]
            break
    # The same for a side without separator, if the rest is the word wanted.
    side_prefix = _SIDE_PREFIX.fullmatch(words[-1]) if found_side is None and words else None
    if side_prefix and side_prefix[2] == word:
        found_side, words[-1] = _SIDES[side_prefix[1]], word
    if not words or words[-1] != word or found_side != side:
        return None
    # Controls such as `ik_hand_l` are no joints of the body.
    prefix = words[:-1]
    return None if _NOT_THE_JOINT.intersection(prefix) else len(prefix)
