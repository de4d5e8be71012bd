"""Where the frames of a C3D file stand: header, counts, and the data section as stored.

Counts stand in several places, of which any may be wrong or saturated: the module `c3d_file`
says which are taken. Nothing is allocated that the file does not hold.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kineme.formats.files import FileContent
from kineme.formats.markers.c3d_parameters import BLOCK, Parameters, as_float32, number_type

Stored = NDArray[Any]
"""Float32 or int16."""


@dataclass(frozen=True)
class Header:
    """The first block, as far as it is used."""

    points: int
    analog_per_frame: int
    first_frame: int
    last_frame: int
    scale: float
    data_block: int
    samples_per_frame: int
    rate: float


def read_header(content: FileContent, parameters: Parameters) -> Header:
    """The header, in the numbers of the processor that the parameters name."""
    kind = parameters.processor
    words = np.frombuffer(content.data, number_type(kind, real=False), 12)
    words = words.view(words.dtype.str.replace("i", "u"))
    reals = np.frombuffer(content.data, number_type(kind, real=True), 6)
    scale, rate = as_float32(reals, kind)[[3, 5]].tolist()
    _, points, analog, first, last, _, _, _, block, per_frame, _, _ = words.tolist()
    return Header(points, analog, first, last, scale, block, per_frame, rate)


@dataclass(frozen=True)
class Layout:
    """Where frames stand in a file, and how many; see `kineme.formats.markers.c3d_file`."""

    content: FileContent
    parameters: Parameters
    header: Header

    @cached_property
    def n_points(self) -> int:
        return self.counts[0]

    @cached_property
    def counts(self) -> tuple[int, int]:
        """Points and analog samples of a frame.

        The header and the parameters count both. Where they differ, the counts hold with
        which the declared frames fill the file, whose last block may be padded.
        """
        header = (self.header.points, self.header.analog_per_frame)
        used = int(self.parameters.number("POINT", "USED", header[0]))
        per_frame = max(self.header.samples_per_frame, 1)
        channels = int(self.parameters.number("ANALOG", "USED", -1))
        samples = channels * per_frame if channels >= 0 else header[1]
        if used == header[0] and samples == header[1]:
            return header
        pairs = dict.fromkeys((n, m) for n in (used, header[0]) for m in (header[1], samples))
        fitting = [pair for pair in pairs if any(pair) and self._fills(*pair)]
        said = (
            f"the header counts {header[0]} points and {header[1]} analog samples in a frame, "
            f"the parameters {used} and {samples}"
        )
        widths = {4 * n + m for n, m in fitting}
        if len(fitting) == 1 or (fitting and used == header[0] and len(widths) == 1):
            n, m = fitting[0]
            self.content.warn(f"{said}: {n} and {m} are taken, which fit the length of the file")
            return fitting[0]
        if used == header[0] and not fitting:  # as header and length of a cut file would
            self.content.warn(f"{said}: those of the header are taken")
            return header
        which = "either fits" if fitting else "neither fits"
        raise self.content.error(f"{said}, and {which} the length of the file: it is damaged")

    def _fills(self, n_points: int, per_frame: int) -> bool:
        """Whether a declared number of frames, so wide, ends in the last block of the file."""
        width = (4 * n_points + per_frame) * self._kind.itemsize
        size = len(self.content.data) - self._start
        ends = (frames * width for frames in self._declared_frames())
        return any(end <= size < (end // BLOCK + 2) * BLOCK for end in ends if end)

    @cached_property
    def _kind(self) -> np.dtype[Any]:
        return number_type(self.parameters.processor, real=self.scale < 0)

    @cached_property
    def _start(self) -> int:
        """Where the data begin, in bytes."""
        block = self.header.data_block or int(self.parameters.number("POINT", "DATA_START", 0))
        if block < 2:
            raise self.content.error("the header names no place for the data, or no points in it")
        return (block - 1) * BLOCK

    @cached_property
    def scale(self) -> float:
        return self.parameters.number("POINT", "SCALE", self.header.scale) or self.header.scale

    @cached_property
    def rate(self) -> float:
        rate = self.parameters.number("POINT", "RATE", self.header.rate) or self.header.rate
        return rate if np.isfinite(rate) and rate > 0 else 0.0

    @cached_property
    def first_frame(self) -> int:
        return self._long("ACTUAL_START_FIELD") or self.header.first_frame

    def frames(self) -> Stored:
        """(frames, numbers): the data section as stored."""
        start, kind = self._start, self._kind
        width = 4 * self.n_points + self.counts[1]
        if width == 0:
            raise self.content.error("the header names no place for the data, or no points in it")
        room = max(len(self.content.data) - start, 0) // (width * kind.itemsize)
        declared = self._declared_frames()
        n = max((frames for frames in declared if 0 < frames <= room), default=room)
        if n == 0:
            raise self.content.error(
                f"less than one frame of {self.n_points} points: the file is truncated"
            )
        if n not in declared:
            self.content.warn(f"{max(declared)} frames declared, {n} found and kept")
        raw = np.frombuffer(self.content.data, kind, n * width, start).reshape(n, width)
        return as_float32(raw, self.parameters.processor) if self.scale < 0 else raw

    def _declared_frames(self) -> set[int]:
        start, stop = self._long("ACTUAL_START_FIELD"), self._long("ACTUAL_END_FIELD")
        counts = {
            self.header.last_frame - self.header.first_frame + 1,
            int(self.parameters.number("POINT", "FRAMES", 0)),
            int(self.parameters.number("POINT", "LONG_FRAMES", 0)),
            stop - start + 1 if start and stop else 0,
        }
        return {frames for frames in counts if frames > 0} or {0}

    def _long(self, name: str) -> int:
        """A count in two words, the low one first; 0 if there is none."""
        low, *high = self.parameters.numbers("TRIAL", name)[:2] or [0.0]
        return int(low) + (int(high[0]) << 16 if high else 0)
