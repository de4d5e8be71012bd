"""The values of an AMC file: for each frame a line with its number and a line per bone.

Where all frames are laid out as the first, the text is taken in pieces of whole frames, so
that no more than its numbers is held.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from kineme.errors import ReadError
from kineme.formats.files import FileContent, numbers
from kineme.formats.skeletons.asf import Figure

Floats = NDArray[np.float64]

PIECE = 1 << 20
"""Bytes of text that are split into words at a time."""

_COMMENT = re.compile(rb"^[ \t]*#.*$", re.MULTILINE)
_FRAME = re.compile(rb"^[ \t]*\d+[ \t]*\r?$", re.MULTILINE)


def read_frames(content: FileContent, start: int, figure: Figure) -> dict[str, Floats]:
    """Each bone's values, (frames, dofs), from the bytes after ``start``, its first frame."""
    return _quickly(content, start, figure) or _line_by_line(content, start, figure)


class _Layout(NamedTuple):
    """Words of a frame, and which of them is each bone's name."""

    n_words: int
    names: dict[str, int]


def _quickly(content: FileContent, start: int, figure: Figure) -> dict[str, Floats] | None:
    """The values if every frame is laid out as the first, else None."""
    found: dict[str, list[Floats]] = {name: [] for name in figure.bones}
    layout: _Layout | None = None
    following: int | None = None
    for piece in _pieces(content.data, start):
        words = (_COMMENT.sub(b"", piece) if b"#" in piece else piece).split()
        layout = layout or _layout(words, figure)
        if layout is None or len(words) % layout.n_words:
            return None
        try:
            labels = list(map(int, words[:: layout.n_words]))
            first = labels[0] if following is None else following
            following = first + len(labels)
            if labels != list(range(first, following)):
                return None
            for name, bone in figure.bones.items():
                found[name].append(_values(words, layout, name, len(bone.dof)))
        except ValueError:
            return None
    return {name: np.concatenate(blocks) for name, blocks in found.items()}


def _pieces(data: bytes, start: int) -> Iterator[bytes]:
    """The text from ``start`` on, in pieces of whole frames."""
    while start < len(data):
        after = _FRAME.search(data, start + PIECE)
        stop = after.start() if after else len(data)
        yield data[start:stop]
        start = stop


def _layout(words: Sequence[bytes], figure: Figure) -> _Layout | None:
    """That of the first frame; None where a bone is unknown, named twice, or missing."""
    names: dict[str, int] = {}
    at = 1
    while at < len(words) and not words[at].isdigit():
        name = words[at].decode("utf-8", "replace")
        if name not in figure.bones or name in names:
            return None
        names[name] = at
        at += 1 + len(figure.bones[name].dof)
    whole = all(name in names or not bone.dof for name, bone in figure.bones.items())
    return _Layout(at, names) if whole else None


def _values(words: Sequence[bytes], layout: _Layout, name: str, n_values: int) -> Floats:
    """(frames, values) of a bone; ValueError if it is not where it is in the first frame."""
    n_frames = len(words) // layout.n_words
    values = np.zeros((n_frames, n_values))
    if name not in layout.names:
        return values
    at = layout.names[name]
    if words[at :: layout.n_words].count(words[at]) != n_frames:
        raise ValueError(f"{name} is not in every frame")
    for i in range(n_values):
        values[:, i] = list(map(float, words[at + 1 + i :: layout.n_words]))
    if not np.isfinite(values).all():
        raise ValueError(f"{name} has values that are not finite")
    return values


def _line_by_line(content: FileContent, start: int, figure: Figure) -> dict[str, Floats]:
    """As `_quickly`, for any layout, and with an error that names the line.

    A fault in the very last line, or bones missing from the last frame, is
    what a truncated file looks like: that frame is left out with a warning.
    Anything else that cannot be understood is an error.
    """
    frames: list[dict[str, list[float]]] = []
    first = content.line_at(start)
    lines = content.data[start:].rstrip().splitlines()
    last = first + len(lines) - 1
    began, label = first, 0
    fault: ReadError | None = None
    for number, line in enumerate(lines, first):
        words = line.split()
        if not words or words[0].startswith(b"#"):
            continue
        if len(words) == 1 and words[0].isdigit():
            if frames:
                _check_complete(content, frames, began)
            before, label = label, _frame_number(content, words[0], number)
            if frames and label != before + 1:
                content.warn(f"frame {label} follows {before}", number)
            began = number
            frames.append({})
            continue
        try:
            _add_bone(frames[-1], words, figure)
        except ValueError as error:
            fault = content.error(str(error), number)
            if number < last:
                raise fault from None
    try:
        _check_complete(content, frames, began)
    except ReadError as error:
        fault = fault or error
    if fault is not None:
        if len(frames) == 1:
            raise fault
        frames.pop()
        content.warn(f"{fault.reason}: the last frame is truncated and left out", fault.line)
    absent = [n for n, bone in figure.bones.items() if bone.dof and n not in frames[0]]
    if absent:
        content.warn(f"no values for {', '.join(absent)}: taken to be 0")
    return {
        name: np.array([frame.get(name, [0.0] * len(bone.dof)) for frame in frames])
        for name, bone in figure.bones.items()
    }


def _frame_number(content: FileContent, word: bytes, line: int) -> int:
    if len(word) > 18:
        raise content.error(f"{word[:18].decode()}... is the number of no frame", line)
    return int(word)


def _add_bone(frame: dict[str, list[float]], words: list[bytes], figure: Figure) -> None:
    name = words[0].decode("utf-8", "replace")
    if name not in figure.bones:
        raise ValueError(f"bone {name[:40]!r} is not in the skeleton: is it the wrong ASF?")
    if name in frame:
        raise ValueError(f"bone {name!r} stands twice in one frame")
    values = numbers(words[1:])
    dof = figure.bones[name].dof
    if len(values) != len(dof):
        raise ValueError(
            f"bone {name!r} has {len(values)} values, the skeleton asks for {len(dof)}"
        )
    frame[name] = values


def _check_complete(content: FileContent, frames: list[dict[str, list[float]]], line: int) -> None:
    """ReadError if the newest frame is empty or lacks a bone that the first one has."""
    missing = [name for name in frames[0] if name not in frames[-1]]
    if missing or not frames[-1]:
        raise content.error(f"a frame without {missing[0] if missing else 'any bone'}", line)
