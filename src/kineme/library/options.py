"""How the recordings of a library are read and segmented, as its head and its analyses tell."""

from __future__ import annotations

import json
from collections.abc import Mapping
from contextlib import suppress
from hashlib import sha256
from pathlib import Path
from typing import Any

from kineme._util.json import options_from_json, options_to_json
from kineme._version import __version__
from kineme.errors import ParameterError, ReadError
from kineme.formats import ReadOptions
from kineme.library.storage.layout import HEAD
from kineme.methods.segmenter import SegmentOptions

ANALYSIS = "kineme.library.piece/4"
"""Schema of an analysis: a change of what is kept of a recording gets the next number."""


def options_in(folder: Path, head: Mapping[str, Any]) -> tuple[ReadOptions, SegmentOptions]:
    """Return the options in the head of a library; ReadError where they are none."""
    try:
        read_options = options_from_json(ReadOptions, head["read_options"])
        segment_options = options_from_json(SegmentOptions, head["segment_options"])
        segment_options.resolved()
    except ParameterError as error:
        reason = f"is damaged, build the library anew: {error}"
        raise ReadError(folder / HEAD, reason) from error
    return read_options, segment_options


def digest_options(read_options: ReadOptions, segment_options: SegmentOptions) -> str:
    """Return a digest of the version and of everything that decides what is found.

    ParameterError for options that a library cannot keep.
    """
    segment_options.resolved()
    presets = []
    for signals in (False, True):
        with suppress(ParameterError):  # constants of one that the other does not have
            chosen = segment_options.resolved(signals=signals)
            presets.append([chosen.name, dict(chosen.parameters())])
    options = [options_to_json(each) for each in (read_options, segment_options)]
    content = [ANALYSIS, __version__, presets, options]
    return sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def analysis_key(options_digest: str, digest: str) -> str:
    """Return the name of the analysis of a recording whose files have this digest."""
    return sha256(f"{options_digest} {digest}".encode()).hexdigest()[:32]
