"""Damage bytes in one to four ways: bytes, lines, numbers, headers, structure."""

from __future__ import annotations

import random
import re

WORDS = [b"nan", b"inf", b"-inf", b"1e300", b"-1.7e308", b"1e-320", b"0", b"-1", b"9" * 5000,
         b"18446744073709551616", b"9223372036854775808", b"2147483648", b"", b"{}", b"[]", b"null",
         b"true", b'""', b"\xff\xfe", b"\xef\xbb\xbf", b"\0", b"\n", b",", b"\t", b"x" * 140_000,
         b"=1+1", b"\xed\xa0\x80", b"(", b"1/0", b"{" * 3000, b"[" * 3000]  # fmt: skip
NUMBER = re.compile(rb"-?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?")


def damage_bytes(data: bytes, seed: int) -> bytes:
    """Return the bytes with damage that depends on the seed."""
    chance = random.Random(seed)
    for _ in range(chance.randint(1, 4)):
        damage = chance.choice(
            (*[_damage_slice] * 2, _damage_line, *[_damage_number] * 2, _damage_header,
             _damage_structure)
        )  # fmt: skip
        data = damage(data, chance)
    return data


def _damage_slice(data: bytes, chance: random.Random) -> bytes:
    """Invert, double, remove or replace a few bytes."""
    if not data:
        return data
    start = chance.randrange(len(data))
    stop = min(len(data), start + chance.choice((1, 1, 2, 4, 8, 64, 512)))
    new = chance.choice((
        bytes(255 - byte for byte in data[start:stop]),
        chance.randbytes(stop - start),
        data[start:stop] * 2,
        b"",
        b"\xff" * (stop - start),
        bytes(stop - start),
        chance.choice(WORDS),
    ))  # fmt: skip
    return data[:start] + new + data[stop:]


def _damage_line(data: bytes, chance: random.Random) -> bytes:
    """Remove, double, move, cut or repeat a line."""
    lines = data.split(b"\n")
    at, to = chance.randrange(len(lines)), chance.randrange(len(lines))
    line = lines[at]
    new = chance.choice(([], [line] * 2, [line] * 500, [line[: len(line) // 2]], [lines[to]]))
    lines[at : at + 1] = new
    return b"\n".join(lines)


def _damage_number(data: bytes, chance: random.Random) -> bytes:
    """Replace a number in a text by an unusual one."""
    start = chance.randrange(max(1, len(data) - 2000)) if chance.random() < 0.5 else 0
    found = list(NUMBER.finditer(data, start, start + 2000))
    if not found:
        return _damage_slice(data, chance)
    where = chance.choice(found)
    return data[: where.start()] + chance.choice(WORDS) + data[where.end() :]


def _damage_header(data: bytes, chance: random.Random) -> bytes:
    """Change one of the first or last thousand bytes, where formats store counts."""
    if not data:
        return data
    at = chance.randrange(min(len(data), 1000))
    at = chance.choice((at, len(data) - 1 - at))
    return data[:at] + bytes([chance.choice((0, 1, 127, 128, 255))]) + data[at + 1 :]


def _damage_structure(data: bytes, chance: random.Random) -> bytes:
    """Cut off, repeat or insert a part, or exchange two parts."""
    a, b = sorted(chance.randrange(len(data) + 1) for _ in range(2))
    middle = (a + b) // 2
    return chance.choice((
        data[:a],
        data[a:],
        data + data[a:b],
        data[:a] + data[middle:b] + data[a:middle] + data[b:],
        data[:a] + chance.choice(WORDS) + data[a:],
    ))  # fmt: skip
