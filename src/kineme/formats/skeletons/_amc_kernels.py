"""Compiled parser of AMC text. ``tests/helpers/naive`` has a simple equivalent."""

from __future__ import annotations

import numpy as np
from numba import njit

from kineme._util.parallel import OPTIONS

TENS = 10.0 ** np.arange(23)  # powers of ten that are exact as float64

EXACT = 1 << 53  # integers up to this are exact as float64
SPACE, PLUS, MINUS, POINT, ZERO, NINE = 32, 43, 45, 46, 48, 57
NOT_HERE = -1


@njit("int64(uint8[::1], int64)", **OPTIONS)
def find_word(text, at):
    """Return the start of the next word or the end of the text; `NOT_HERE` if no space precedes."""
    before = at
    while at < len(text) and (text[at] == SPACE or 9 <= text[at] <= 13):
        at += 1
    return at if at > before else NOT_HERE


@njit("int64(uint8[::1], int64, uint8[::1])", **OPTIONS)
def skip_name(text, at, name):
    """Return the end of a name that starts here; `NOT_HERE` if another word does."""
    if at + len(name) > len(text):
        return NOT_HERE
    for i in range(len(name)):
        if text[at + i] != name[i]:
            return NOT_HERE
    return at + len(name)


@njit("int64(uint8[::1], int64, float64[::1])", **OPTIONS)
def parse_number(text, at, value):
    """Return the end of a number that starts here, and store its value.

    Return `NOT_HERE` if there is none, or if dividing an integer by a power of ten may round
    differently from ``float``.
    """
    negative = at < len(text) and text[at] == MINUS
    if negative or (at < len(text) and text[at] == PLUS):
        at += 1
    mantissa, digits, decimals, point = 0, 0, 0, False
    while at < len(text):
        sign = text[at]
        if ZERO <= sign <= NINE:
            mantissa = 10 * mantissa + (sign - ZERO)
            digits += 1
            decimals += point
            # For larger numbers the quotient may round differently from `float`.
            if mantissa >= EXACT or digits == len(TENS):
                return NOT_HERE
        elif sign == POINT and not point:
            point = True
        else:
            break
        at += 1
    value[0] = mantissa / TENS[decimals]
    if negative:
        value[0] = -value[0]
    return at if digits else NOT_HERE


@njit("int64(uint8[::1], uint8[::1], int64[::1], int64[::1], float64[:, ::1])", **OPTIONS)
def read_rows(text, names, ends, counts, rows):
    """Parse frames into rows: the number of the frame, then the values of each bone.

    A frame is its number and, for each bone, its name (``names`` up to its end) and its values. The
    text must start and end with a space, and ``rows`` be large enough. Return the number of frames,
    or `NOT_HERE` if the text has another layout.
    """
    at, row, value = 0, 0, np.zeros(1)
    while True:
        at = find_word(text, at)
        if at == len(text):
            return row
        if at != NOT_HERE:
            at = parse_number(text, at, value)
        if at == NOT_HERE:
            return NOT_HERE
        rows[row, 0] = value[0]
        column, first = 1, 0
        for bone in range(len(counts)):
            at = find_word(text, at)
            if at != NOT_HERE:
                at = skip_name(text, at, names[first : ends[bone]])
            first = ends[bone]
            for _ in range(counts[bone]):
                # After a mismatch, skip the rest of the bone.
                if at != NOT_HERE:
                    at = find_word(text, at)
                if at != NOT_HERE:
                    at = parse_number(text, at, value)
                rows[row, column] = value[0]
                column += 1
            if at == NOT_HERE:
                return NOT_HERE
        row += 1
