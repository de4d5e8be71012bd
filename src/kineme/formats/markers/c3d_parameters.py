"""The parameter section of C3D files: groups of named values.

A record is the length of its name, the number of its group (negative: it is
the group), the name, the distance to the next record, and for a parameter its type,
dimensions and values. Values are looked at when they are asked for.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kineme.formats.files import FileContent

BLOCK = 512
INTEL, DEC, MIPS = 84, 85, 86


@dataclass(frozen=True)
class Parameters:
    """The values of a C3D file by group and name, both in upper case."""

    content: FileContent
    processor: int
    places: dict[tuple[str, str], int]

    def number(self, group: str, name: str, usual: float) -> float:
        """The first of the values as a finite number, ``usual`` if there is none."""
        values = self.numbers(group, name)
        return values[0] if values and np.isfinite(values[0]) else usual

    def numbers(self, group: str, name: str, *, signed: bool = False) -> list[float]:
        """The values as numbers, none if they are text; integers are counts unless signed."""
        kind, _, data = self._stored(group, name)
        if kind == 4:
            reals = np.frombuffer(data, number_type(self.processor, real=True))
            return list(map(float, as_float32(reals, self.processor)))
        if kind not in (1, 2):
            return []
        integers = np.frombuffer(
            data, "i1" if kind == 1 else number_type(self.processor, real=False)
        )
        if not signed:
            integers = integers.view(integers.dtype.str.replace("i", "u"))
        return list(map(float, integers))

    def strings(self, group: str, name: str) -> list[str]:
        """The values as text, none if they are numbers."""
        kind, shape, data = self._stored(group, name)
        width = shape[0] if shape else 1
        if kind != -1 or width == 0:
            return []
        return [string(data[at : at + width]) for at in range(0, len(data), width)]

    def _stored(self, group: str, name: str) -> tuple[int, list[int], bytes]:
        """Type, dimensions and bytes of a parameter; nothing where it is not whole."""
        at = self.places.get((group, name))
        data = self.content.data
        if at is None or at + 2 > len(data):
            return 0, [], b""
        kind = int.from_bytes(data[at : at + 1], signed=True)
        shape = list(data[at + 2 : at + 2 + data[at + 1]])
        start = at + 2 + data[at + 1]
        size = abs(kind) * prod(shape)
        if start + size > len(data):
            return 0, [], b""
        return kind, shape, data[start : start + size]


def read_parameters(content: FileContent) -> Parameters:
    """Where each parameter of the file is.

    Raises
    ------
    ReadError
        There is no parameter section, or its processor is unknown.
    """
    data = content.data
    start = (max(data[0], 1) - 1) * BLOCK if data else 0
    if len(data) < max(start + 4, BLOCK):
        raise content.error("the file ends before its parameters: it is truncated, or no C3D file")
    processor = data[start + 3]
    if processor not in (INTEL, DEC, MIPS):
        raise content.error(
            f"processor type {processor} is none of Intel ({INTEL}), DEC ({DEC}) and MIPS "
            f"({MIPS}): the file is damaged, or no C3D file"
        )
    order = "big" if processor == MIPS else "little"
    groups: dict[int, str] = {}
    found: list[tuple[int, str, int]] = []
    at = start + 4
    while at + 2 <= len(data):
        length = abs(int.from_bytes(data[at : at + 1], signed=True))
        group = int.from_bytes(data[at + 1 : at + 2], signed=True)
        after = at + 2 + length
        step = int.from_bytes(data[after : after + 2], order)  # type: ignore[arg-type]
        if length == 0 or group == 0:
            break
        name = string(data[at + 2 : after]).upper()
        if group < 0:
            groups[-group] = name
        else:
            found.append((group, name, after + 2))
        if step == 0:
            break
        at = after + step
    places = {(groups.get(group, ""), name): place for group, name, place in found}
    return Parameters(content, processor, places)


def number_type(processor: int, *, real: bool) -> np.dtype[Any]:
    """How a number is stored; DEC's floats need `as_float32` besides."""
    return np.dtype((">" if processor == MIPS else "<") + ("f4" if real else "i2"))


def as_float32(values: NDArray[Any], processor: int) -> NDArray[np.float32]:
    """The values, with DEC's floats (words exchanged, exponents larger by two) made IEEE's."""
    if processor != DEC:
        return values
    words = np.ascontiguousarray(values).view("<u2")
    exchanged = words.reshape(-1, 2)[:, ::-1].copy().view("<f4").reshape(values.shape)
    return np.asarray(exchanged / 4, np.float32)


def string(data: bytes) -> str:
    """Text padded with blanks or zeros; UTF-8, else Latin-1 as older programs write."""
    data = data.partition(b"\0")[0]
    try:
        return data.decode().strip()
    except UnicodeDecodeError:
        return data.decode("latin-1").strip()
