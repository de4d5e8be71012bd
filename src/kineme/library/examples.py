"""Examples of a search as features: read from a file, or taken from the library."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from os import PathLike

import numpy as np
from numpy.typing import NDArray

from kineme.errors import ParameterError, ReadError
from kineme.formats.files import warn
from kineme.library.descriptions import Description, describe
from kineme.library.opened import OpenTables
from kineme.library.searching import Example, Hit, Named
from kineme.library.sources import read_at
from kineme.library.storage.layout import PIECES
from kineme.library.storage.pieces import read_features
from kineme.library.storage.places import place
from kineme.recordings import Motion, Signals

AnyPath = str | PathLike[str]
Float32s = NDArray[np.float32]

BEYOND = 0.1
"""Seconds: an example that stops so much after the end of its recording is rounded."""


def as_examples(
    like: AnyPath | Motion | Signals | Example | Hit | Sequence[Example | Hit] | None,
    start_s: float,
    stop_s: float | None,
) -> list[Example]:
    """What is searched for as examples; a hit is one of the library, whatever files there are."""
    if like is None:
        return []
    if isinstance(like, str | PathLike | Motion | Signals):
        return [Example(like, start_s, stop_s)]
    given = list(like) if isinstance(like, Iterable) and not isinstance(like, Hit) else [like]
    examples = []
    for example in given:
        if isinstance(example, Hit):
            examples.append(Example(Named(example.recording), example.start_s, example.stop_s))
        elif isinstance(example, Example):
            examples.append(example)
        else:
            raise ParameterError(
                f"an example is a file, a name, a recording, a Hit or an Example, not "
                f"{example!r:.60}"
            )
    return examples


def features_of(
    tables: OpenTables, examples: Sequence[Example], *, mirror: bool = False
) -> list[tuple[str, Float32s]]:
    """Vocabulary and features of each example, and of its mirror image.

    Parameters
    ----------
    tables : OpenTables
    examples : sequence of Example
    mirror : bool
        The mirror images, too.

    Raises
    ------
    ParameterError
        An example starts where its recording has ended.
    ReadError
        It cannot be read, or has no body.
    """
    found = []
    for example in examples:
        for mirrored in (False, True)[: 1 + mirror]:
            described = _description(tables, example.recording, mirrored=mirrored)
            lasts = len(described.features) / described.fps
            stop_s = lasts if example.stop_s is None else min(example.stop_s, lasts)
            if not mirrored and example.stop_s is not None and example.stop_s > lasts + BEYOND:
                warn(
                    f"the example stops at {example.stop_s:g} s, its recording lasts "
                    f"{lasts:.2f} s: taken to its end"
                )
            if example.start_s >= stop_s:
                raise ParameterError(
                    f"the example starts at {example.start_s:g} s, its recording lasts "
                    f"{lasts:.2f} s"
                )
            found.append((described.vocabulary, described.between(example.start_s, stop_s)))
    return found


def one_vocabulary(wanted: Sequence[tuple[str, Float32s]]) -> str:
    """What all examples are of; ParameterError where they do not compare."""
    kinds = sorted({kind for kind, _ in wanted})
    if len(kinds) > 1:
        raise ParameterError(f"the examples do not compare with each other: {'; '.join(kinds)}")
    return kinds[0]


def _description(
    tables: OpenTables, recording: AnyPath | Motion | Signals, *, mirrored: bool
) -> Description:
    """The features of a recording, from the library where it is one of it."""
    told, settings = tables.recordings, tables.settings
    if isinstance(recording, str) and (
        isinstance(recording, Named) or not place(recording).exists()
    ):
        if recording not in told["recording"]:
            raise ReadError(recording, "there is no such file, and no recording of that name")
        if not mirrored:
            row = told["recording"].index(recording)
            features = read_features(tables.folder / PIECES, told["piece"][row])
            known = Description(told["vocabulary"][row], features, told["features_fps"][row])
            return _comparable(known, recording)
        recording = tables.path_of(recording)
    seen = recording
    if not isinstance(seen, Motion | Signals):
        seen = read_at(place(seen), settings.reading)
    emg = settings.options().emg
    described = describe(seen, effectors=settings.effectors, emg=emg, mirrored=mirrored)
    return _comparable(described, seen.provenance.path or "the example")


def _comparable(described: Description, name: str) -> Description:
    """The description, where there are features."""
    if not described.vocabulary:
        reason = described.reason or "it has no body that could be told"
        raise ReadError(name, f"cannot be searched for: {reason}")
    return described
